// Rows that no wave has reached only move, and that changes nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <map>

#include "poreshock/solver/sleep.hpp"
#include "support/runs.hpp"

namespace poreshock::test {
namespace {

/// Largest difference of two runs with the same particles in any column, relative to the column's
/// largest value. Ids tell particles apart.
template <int Dim>
double difference(const Simulation<Dim>& a, const Simulation<Dim>& b) {
  std::map<std::int64_t, std::size_t> place;
  for (std::size_t p = 0; p < b.particles.size(); ++p) place[b.particles.id[p]] = p;
  std::vector<const void*> other;
  for_each_column(b.particles, [&](auto, int, const auto& column) { other.push_back(&column); });
  double worst = 0.0;
  std::size_t k = 0;
  for_each_column(a.particles, [&](auto, int, const auto& column) {
    const auto& twin = *static_cast<const std::remove_cvref_t<decltype(column)>*>(other[k++]);
    double error = 0.0, largest = 0.0;
    for (std::size_t p = 0; p < column.size(); ++p) {
      const double x = static_cast<double>(column[p]);
      const double y = static_cast<double>(twin[place.at(a.particles.id[p])]);
      error = std::max(error, std::abs(x - y));
      largest = std::max(largest, std::abs(y));
    }
    if (largest > 0.0) worst = std::max(worst, error / largest);
  });
  return worst;
}

/// Runs with and without sleep; returns their difference and the share of particles asleep halfway.
struct Comparison {
  double difference, asleep;
};

template <int Dim>
std::int64_t asleep(const Simulation<Dim>& sim) {
  return sleeping_particles(sim.cells, *sim.grid);
}

Comparison compare(const Scene& scene, std::int64_t steps) {
  Scene awake = scene;
  awake.time.sleep = false;
  Simulation<2> a = start<2>(scene, MPI_COMM_SELF), b = start<2>(awake, MPI_COMM_SELF);
  advance_to(steps / 2, 0, a);
  const double share = static_cast<double>(asleep(a)) / static_cast<double>(a.particles.size());
  advance_to(steps, 0, a);
  advance_to(steps, 0, b);
  EXPECT_EQ(asleep(b), 0);
  EXPECT_EQ(a.particles.size(), b.particles.size());
  EXPECT_NEAR(a.clock.time, b.clock.time, 1e-12 * b.clock.time);
  return {difference(a, b), share};
}

TEST(Sleep, ChangesAPorousSampleByLessThanRoundOffDoes) {
  const std::string tall = "sample.height=1.5e-3", domain = "domain.size=[0.2e-3, 1.6e-3]";
  for (const char* scheme :
       {"transfer.velocity=polyflip", "transfer.velocity=apic", "transfer.velocity=flip"}) {
    const Comparison c = compare(scene_of(porous_text(), {tall, domain, scheme}), 300);
    EXPECT_LT(c.difference, 1e-10) << scheme;
    EXPECT_GT(c.asleep, 0.5) << scheme;
  }
}

TEST(Sleep, WaitsForNothingWhereMotionIsNotUniform) {
  const Scene uniform = scene_of(porous_text());
  const auto asleep_at_start = [](const Scene& scene) {
    Simulation<2> sim = start<2>(scene, MPI_COMM_SELF);
    advance_to(1, 0, sim);
    return asleep(sim);
  };
  EXPECT_GT(asleep_at_start(uniform), 0);
  for (const char* change :
       {"body_force.acceleration=[0.0, -1e9]", "time.sleep=false", "boundary.lateral='wall'"}) {
    std::vector<std::string> overrides = {change};
    if (std::string(change).starts_with("boundary")) overrides.push_back("domain.periodic=false");
    EXPECT_EQ(asleep_at_start(scene_of(porous_text(), overrides)), 0) << change;
  }
}

/// Runs with rows that rest and with none that does, to the last bit the same; returns the least
/// and the largest share of particles that rested.
template <int Dim>
std::pair<double, double> compare_rest(const Scene& scene, std::int64_t steps) {
  Simulation<Dim> a = start<Dim>(scene, MPI_COMM_SELF), b = start<Dim>(scene, MPI_COMM_SELF);
  double least = 1.0, most = 0.0;
  while (a.clock.step < steps) {
    b.cells.resting.clear();
    for (Simulation<Dim>* sim : {&a, &b}) advance_to(sim->clock.step + 1, 0, *sim);
    const double share =
        static_cast<double>(resting_particles(a.cells)) / static_cast<double>(a.particles.size());
    least = std::min(least, share), most = std::max(most, share);
    EXPECT_EQ(asleep(a), asleep(b));
  }
  EXPECT_EQ(difference(a, b), 0.0);
  return {least, most};
}

TEST(Sleep, OfRowsThatRestChangesNoBit) {
  const auto plane = compare_rest<2>(
      scene_of(porous_text(), {"sample.height=1.2e-3", "domain.size=[0.1e-3, 1.3e-3]"}), 700);
  EXPECT_GT(plane.second, 0.8);
  EXPECT_LT(plane.first, 0.5);
  const auto space = compare_rest<3>(
      scene_of(balls_text(), {"sample.height=300e-6", "domain.size=[60e-6, 60e-6, 320e-6]"}), 60);
  EXPECT_GT(space.second, 0.3);
}

TEST(Sleep, MovesABlockInFreeFlightExactly) {
  const Scene scene = scene_of(porous_text(), {"boundary.low=free"});
  Simulation<2> sim = start<2>(scene, MPI_COMM_SELF);
  std::map<std::int64_t, double> height;
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    height[sim.particles.id[p]] = sim.particles.position[1][p];
  }
  advance_to(39, 0, sim);
  const auto last = static_cast<std::int64_t>(sim.particles.size());  // some leave at each step
  advance_to(40, 0, sim);
  EXPECT_EQ(asleep(sim), last);
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    EXPECT_EQ(sim.particles.velocity[1][p], -1100.0);
    EXPECT_EQ(sim.particles.pressure[p], 0.0);
    EXPECT_NEAR(sim.particles.position[1][p],
                height.at(sim.particles.id[p]) - 1100.0 * sim.clock.time, 1e-15);
  }
}

}  // namespace
}  // namespace poreshock::test
