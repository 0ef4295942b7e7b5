// A collapsing porous block and its mirror image, and the same block one cell further along the
// periodic axis.

#include <algorithm>
#include <functional>

#include "verification/states.hpp"

namespace poreshock::test {
namespace {

constexpr int columns = 40;  // particles across the block

/// 20 x 40 cells with an edge of 2^-17 m, so that places mirror and shift without rounding.
Scene block(const std::vector<std::string>& overrides) {
  std::vector<std::string> all = {"domain.cell=7.62939453125e-06",
                                  "domain.size=[1.52587890625e-04, 3.35693359375e-04]",
                                  "sample.height=3.0517578125e-04", "sample.void_radius=23e-6"};
  all.insert(all.end(), overrides.begin(), overrides.end());
  return plain_scene_of(porous_text(), all);
}

struct State {
  double pressure;
  Plane velocity;
  double internal_energy;
};

/// Runs and returns the states by site; `column` and `sign` name the site and the x direction that
/// a particle of the changed block has in the original.
template <class Change, class Column>
std::unordered_map<std::int64_t, State> run_changed(const Scene& scene, std::int64_t steps,
                                                    Change&& change, Column&& column, double sign) {
  Simulation<2> sim = start<2>(scene, MPI_COMM_SELF);
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    double& x = sim.particles.position[0][p];
    x = change(x, scene.domain.size[0]);
    const auto place =
        static_cast<std::int64_t>(x / scene.domain.cell * scene.sample.particles_per_cell);
    std::int64_t& id = sim.particles.id[p];
    id = id / columns * columns + place;
  }
  distribute(sim);
  advance_to(steps, 0, sim);
  std::unordered_map<std::int64_t, State> states;
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    const Particles<2>& q = sim.particles;
    const std::int64_t original = q.id[p] / columns * columns + column(q.id[p] % columns);
    states[original] = {
        q.pressure[p], {sign * q.velocity[0][p], q.velocity[1][p]}, q.internal_energy[p]};
  }
  return states;
}

const auto unchanged_place = [](double x, double) { return x; };
const auto unchanged_column = [](std::int64_t c) { return c; };

/// Largest difference of pressure, velocity and energy relative to the largest values.
double difference(const std::unordered_map<std::int64_t, State>& a,
                  const std::unordered_map<std::int64_t, State>& b) {
  double pressure = 0.0, speed = 0.0, energy = 0.0;
  double dp = 0.0, dv = 0.0, de = 0.0;
  EXPECT_EQ(a.size(), b.size());
  for (const auto& [id, s] : a) {
    const State& t = b.at(id);
    pressure = std::max(pressure, std::abs(s.pressure));
    energy = std::max(energy, std::abs(s.internal_energy));
    dp = std::max(dp, std::abs(s.pressure - t.pressure));
    de = std::max(de, std::abs(s.internal_energy - t.internal_energy));
    for (std::size_t k = 0; k < 2; ++k) {
      speed = std::max(speed, std::abs(s.velocity[k]));
      dv = std::max(dv, std::abs(s.velocity[k] - t.velocity[k]));
    }
  }
  return std::max({dp / pressure, dv / speed, de / energy});
}

using Verify =
    std::function<void(const std::string& figure, double difference, std::int64_t steps)>;

void mirror_and_shift(const std::vector<std::string>& overrides, const Verify& verify) {
  const Scene scene = block(overrides);
  for (const std::int64_t steps : {100, 400}) {
    const auto original = run_changed(scene, steps, unchanged_place, unchanged_column, 1.0);
    const auto mirrored = run_changed(
        scene, steps, [](double x, double width) { return width - x; },
        [](std::int64_t c) { return columns - 1 - c; }, -1.0);
    const double cell = scene.domain.cell;
    const auto shifted = run_changed(
        scene, steps,
        [&](double x, double width) { return x + cell < width ? x + cell : x + cell - width; },
        [](std::int64_t c) { return (c + columns - 2) % columns; }, 1.0);
    const std::string suffix = steps == 100 ? "_100" : "_400";
    verify("mirror" + suffix, difference(original, mirrored), steps);
    verify("shift" + suffix, difference(original, shifted), steps);
  }
}

constexpr double bar_after(std::int64_t steps) {
  return steps == 100 ? 1e-12 : 1e-10;
}

Verify meets_bars(const std::string& name) {
  return [name](const std::string& figure, double found, std::int64_t steps) {
    verify_at_most(name, figure, found, bar_after(steps));
  };
}

TEST(Invariance, MirrorAndShiftWithCubicApic) {
  mirror_and_shift({}, meets_bars("invariance_cubic_apic"));
}

TEST(Invariance, MirrorAndShiftWithAflip) {
  // Where a limiter sets in, rounding decides which of two jumps is the smaller.
  mirror_and_shift(default_scheme(), [](const auto& figure, double found, std::int64_t steps) {
    if (steps == 100) {
      verify_known_shortfall("invariance_aflip", figure, found, bar_after(steps), 1e-11);
    } else {
      verify_at_most("invariance_aflip", figure, found, bar_after(steps));
    }
  });
}

TEST(Invariance, MirrorAndShiftWithQuadraticFlip) {
  mirror_and_shift({"transfer.shape=quadratic", "transfer.velocity=flip", "transfer.damping=0.1"},
                   meets_bars("invariance_quadratic_flip"));
}

}  // namespace
}  // namespace poreshock::test
