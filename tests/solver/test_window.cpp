// A domain that follows the front computes what a domain of the whole sample computes.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "poreshock/solver/window.hpp"
#include "support/same_bits.hpp"

namespace poreshock::test {
namespace {

constexpr double cell = 10e-6;  // m

/// Sample of 240 rows, with a few voids, in a window of 128, whose step is the beat: a common step
/// is a signal too.
const char* window_text = R"(
[domain]
size = [60e-6, 1.28e-3]
cell = 10e-6
periodic = true
[boundary]
low = "wall"
[sample]
kind = "random_voids"
height = 2.4e-3
porosity = 0.05
void_radius = 15e-6
[loading]
velocity = 1500
[output]
beat = 0.2e-9
[time]
end = 1e-6
)";

Scene window_scene(const std::vector<std::string>& more = {}) {
  std::vector<std::string> overrides = {"time.follow=front"};
  overrides.insert(overrides.end(), more.begin(), more.end());
  return scene_of(window_text + std::string(aluminium_text), overrides);
}

Scene whole_scene() {
  return scene_of(window_text + std::string(aluminium_text), {"domain.size=[60e-6, 2.56e-3]"});
}

TEST(Window, StripsAreWholePixels) {
  for (const int pixel : {1, 2, 4, 8, 16}) {
    const StripHeights strip = strip_heights(
        window_scene({"domain.size=[160e-6, 1.28e-3]", "morphology.every=1e-9",
                      "morphology.fields=['pressure']", "morphology.thresholds.pressure=[1e9]",
                      "morphology.pixel=" + std::to_string(pixel) + "e-5"}));
    EXPECT_EQ(strip.step, pixel);
    EXPECT_GE(strip.first, pixel);
    EXPECT_GE(strip.last, strip.first);
    EXPECT_EQ(strip.first % pixel, 0);
    EXPECT_EQ(strip.last % pixel, 0);
  }
}

/// All that a particle is, by its id.
template <int Dim>
std::map<std::int64_t, std::vector<double>> states(const Simulation<Dim>& sim) {
  std::map<std::int64_t, std::vector<double>> result;
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    std::vector<double>& state = result[sim.particles.id[p]];
    for_each_column(sim.particles, [&](std::string_view, int, const auto& column) {
      state.push_back(static_cast<double>(column[p]));
    });
  }
  return result;
}

/// Lowest height, m, above which all particles of a run are those of another to the bit; those that
/// it has alone would have no partner.
double same_from(const Simulation<2>& sim, const Simulation<2>& other) {
  const auto there = states(other);
  double height = 0.0;
  const auto here = states(sim);
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    const std::int64_t id = sim.particles.id[p];
    if (here.at(id) == there.at(id)) continue;
    height = std::max(height, sim.particles.position[1][p]);
  }
  return height;
}

TEST(Window, HasTheBitsOfTheWholeSampleAsFarAsNothingCanHaveComeFromBelow) {
  Simulation<2> window = start<2>(window_scene(), MPI_COMM_SELF);
  Simulation<2> whole = start<2>(whole_scene(), MPI_COMM_SELF);
  EXPECT_LT(window.particles.size(), 0.55 * static_cast<double>(whole.particles.size()));
  std::int64_t cut = 0;
  while (window.window.strips == 0) {
    ASSERT_LT(window.clock.step, 2000);
    advance_to(window.clock.step + 1, 0, window);
    if (window.window.strips > 0) break;
    cut = window.clock.step;
    if (cut % 50 != 0) continue;
    advance_to(cut, 0, whole);
    ASSERT_EQ(whole.clock.time, window.clock.time);
    EXPECT_EQ(same_from(window, whole), 0.0) << "step " << cut;
  }
  EXPECT_GT(cut, 300);
  const double plane = window.window.first * cell;
  EXPECT_GT(plane, 7 * cell);
  // What a particle does depends on those of 3 rows around it, and it crosses less than one.
  constexpr int rows_per_step = 4;
  for (int steps = 1; steps <= 12; ++steps) {
    advance_to(cut + steps, 0, window);
    advance_to(cut + steps, 0, whole);
    EXPECT_LE(same_from(window, whole), plane + steps * rows_per_step * cell) << steps << " steps";
    EXPECT_GT(same_from(window, whole), plane) << "the plane is no part of the whole sample";
  }
}

TEST(Window, ClosesEnergyMassAndMomentum) {
  Simulation<2> sim = start<2>(window_scene(), MPI_COMM_WORLD);
  const HistoryRow first = stock(sim);
  const auto mass = [&] {
    std::vector<Int128> sums = {sim.ledger.handed_over.mass - sim.ledger.taken_in.mass};
    for (const double m : sim.particles.mass)
      sums[0] += quantise(m, 1.0 / mass_quantum(sim.ledger));
    sum(sums, sim.communicator);
    return static_cast<double>(sums[0]);
  };
  const double mass_before = mass();
  advance_to(1300, 0, sim);
  EXPECT_GT(sim.window.strips, 3);
  const HistoryRow last = stock(sim);
  EXPECT_GT(last.handed_over, 0.2 * first.total);
  EXPECT_GT(last.taken_in, 0.2 * first.total);
  EXPECT_EQ(last.escaped, 0.0);
  EXPECT_EQ(mass(), mass_before);
  EXPECT_NEAR(last.total / first.total, 1.0, 1e-13);
  const double scale = std::abs(first.momentum[1]);
  EXPECT_NEAR(last.total_momentum[1] / scale, first.total_momentum[1] / scale, 1e-13);
}

TEST(Window, HasTheSameBitsOnAllRanksAndAfterRestarts) {
  const Scene scene = window_scene();
  const int all = size(MPI_COMM_WORLD);
  constexpr std::int64_t last = 930;  // beyond the second strip
  const std::uint64_t alone = checksum_after<2>(scene, 1, last);
  EXPECT_EQ(checksum_after<2>(scene, all, last, 70), alone);
  EXPECT_EQ(checksum_with_restart<2>(scene, all, 1, 500, last), alone);
  EXPECT_EQ(checksum_with_restart<2>(scene, 1, all, 850, last), alone);
}

TEST(Window, GrainsThatComeLaterAreThoseOfTheWholeSample) {
  const Scene scene =
      window_scene({"domain.size=[0.16e-3, 1.28e-3]", "sample.kind=packed_grains",
                    "sample.grain_radius=35e-6", "sample.porosity=0.3", "output.beat=5e-9"});
  Simulation<2> sim = start<2>(scene, MPI_COMM_WORLD);
  EXPECT_EQ(sim.grain_fields.grains,
            first_grain_number(scene) + static_cast<int>(sim.sample.grains.size()));
  while (sim.window.strips < 2) advance_to(sim.clock.step + 10, 0, sim);
  EXPECT_GT(sum(sim.ledger.taken_in.particles, MPI_COMM_WORLD), 0);
  const std::uint64_t together = checksum(sim);
  EXPECT_EQ(checksum_after<2>(scene, 1, sim.clock.step), together);
}

// A plate shock at 1500 m/s has no precursor: the state behind it is that of the Hugoniot, however
// often the wall has moved up.
TEST(Window, KeepsTheStateBehindAPlateShock) {
  const Scene scene = window_scene({"sample.kind=solid", "output.beat=5e-9"});
  Simulation<2> sim = start<2>(scene, MPI_COMM_WORLD);
  while (sim.window.strips < 7) advance_to(sim.clock.step + 20, 0, sim);
  const MaterialParameters& m = scene.materials.front();
  const double u = scene.loading.velocity;
  const double stress = m.density * (m.c0 + m.lambda * u) * u + 2.0 / 3.0 * m.yield;
  std::vector<double> sums(2, 0.0);
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    const double row = sim.particles.position[1][p] / cell - sim.window.first;
    if (row < 8.0 || row > 40.0) continue;
    sums[0] += sim.particles.pressure[p] - sim.particles.deviator[1][p];
    sums[1] += 1.0;
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 2, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  EXPECT_NEAR(sums[0] / sums[1] / stress, 1.0, 0.01);
}

}  // namespace
}  // namespace poreshock::test
