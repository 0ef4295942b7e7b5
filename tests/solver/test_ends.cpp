// A free side with material behind it: what comes back of a plane wave, ledger, bits.
#include <gtest/gtest.h>

#include <cmath>

#include "support/runs.hpp"
#include "support/same_bits.hpp"

namespace poreshock::test {
namespace {

/// A plate of a height (m) on a wall, hit at a velocity, waves leave it at its top.
Scene plate(double velocity, double height, const std::string& behind) {
  return scene_of(
      porous_text(),
      {"sample.kind=solid", "domain.size=[40e-6, " + std::to_string(height + 50e-6) + "]",
       "sample.height=" + std::to_string(height), "loading.velocity=" + std::to_string(velocity),
       "boundary.high={kind='free', behind='" + behind + "'}"});
}

/// Mean velocity (m/s) along the shock axis of the particles that started between two heights.
double velocity_between(const Simulation<2>& sim, double low, double high) {
  double sums[2] = {0.0, 0.0};
  const std::int64_t layer = 2 * sim.scene.domain.cells[0];
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    const double start = 5e-6 * (static_cast<double>(sim.particles.id[p] / layer) + 0.5);
    if (start < low || start > high) continue;
    sums[0] += 1.0;
    sums[1] += sim.particles.velocity[1][p];
  }
  MPI_Allreduce(MPI_IN_PLACE, sums, 2, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  return sums[1] / sums[0];
}

class Leaving : public ::testing::TestWithParam<double> {};

TEST_P(Leaving, LessThanOnePercentOfTheEnergyComesBack) {
  // Behind the wave all is at rest in the laboratory. A wave that comes back with a share r of the
  // velocity has r^2 of the energy; a free surface has r = 1.
  const double velocity = GetParam(), height = 0.4e-3;
  Simulation<2> sim = start<2>(plate(velocity, height, "aluminium"), MPI_COMM_WORLD);
  const double mass = stock(sim).kinetic / (0.5 * velocity * velocity);
  while (sim.clock.time < 1.6 * height / 6400.0) advance_to(sim.clock.step + 1, 0, sim);
  const double back = velocity_between(sim, 0.25e-3, 0.4e-3) / velocity;
  EXPECT_LT(back * back, 0.01) << back;
  std::printf("%g m/s: %.2g of the energy comes back\n", velocity, back * back);
  // All momentum of the plate went into the wall and into what lies behind its top.
  const HistoryRow row = stock(sim);
  EXPECT_NEAR(row.total_momentum[1] / (-mass * velocity), 1.0, 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Velocities, Leaving, ::testing::Values(100.0, 500.0, 1100.0, 1500.0));

TEST_P(Leaving, ALongSampleHasTheSameTrace) {
  const double velocity = GetParam(), height = 0.4e-3;
  Simulation<2> short_one = start<2>(plate(velocity, height, "aluminium"), MPI_COMM_WORLD);
  Simulation<2> long_one = start<2>(plate(velocity, 2.0 * height, ""), MPI_COMM_WORLD);
  double worst = 0.0;
  // Until the wave has left the short one, and half of the way back again.
  for (int beat = 1; beat <= 20; ++beat) {
    for (auto* sim : {&short_one, &long_one}) {
      while (sim->clock.beat < beat) advance_to(sim->clock.step + 1, 0, *sim);
    }
    worst = std::max(worst, std::abs(velocity_between(short_one, 0.2e-3, 0.3e-3) -
                                     velocity_between(long_one, 0.2e-3, 0.3e-3)));
  }
  EXPECT_LT(worst / velocity, 0.01);
  std::printf("%g m/s: largest difference %.2g\n", velocity, worst / velocity);
}

TEST(Ends, EnergyThatLeavesIsInTheLedger) {
  // A piston pushes into a sample at rest. When the wave has left at the top, as much energy leaves
  // there as the piston brings in, P V per area and time, and the sample keeps what it has.
  const double velocity = 1100.0, height = 0.4e-3;
  Scene scene = plate(0.0, height, "aluminium");
  scene.boundary.low.velocity = velocity;
  Simulation<2> sim = start<2>(scene, MPI_COMM_WORLD);
  double mass = 0.0;
  for (const double m : sim.particles.mass) mass += m;
  MPI_Allreduce(MPI_IN_PLACE, &mass, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  std::vector<HistoryRow> rows;
  for (const double time : {80e-9, 120e-9}) {
    while (sim.clock.time < time) advance_to(sim.clock.step + 1, 0, sim);
    rows.push_back(stock(sim));
    const double energy = rows.back().kinetic + rows.back().internal;
    EXPECT_NEAR(rows.back().wall_work / energy, 1.0, 1e-12);
    EXPECT_NEAR(rows.back().wall_impulse[1] / (mass * velocity), 1.0, 0.01);
  }
  const double front = 5350.0 + 1.34 * velocity;
  const double entered = mass / height * front * velocity * velocity * 40e-9;
  EXPECT_LT(std::abs(rows[1].wall_work - rows[0].wall_work), 0.01 * entered);
}

TEST(Ends, SameBitsOnAnyRanksAndAfterARestart) {
  const Scene scene = scene_of(porous_text(), {"boundary.high={kind='free', behind='aluminium'}"});
  const int all = size(MPI_COMM_WORLD);
  const std::uint64_t alone = checksum_after<2>(scene, 1, 200);
  EXPECT_EQ(checksum_after<2>(scene, all, 200), alone);
  EXPECT_EQ(checksum_with_restart<2>(scene, all, all, 120, 200), alone);
}

}  // namespace
}  // namespace poreshock::test
