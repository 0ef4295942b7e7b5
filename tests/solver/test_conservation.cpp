// Energy, momentum and symmetries of whole runs.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "poreshock/material/derived.hpp"
#include "poreshock/run/checksum.hpp"
#include "support/runs.hpp"

namespace poreshock::test {
namespace {

template <int Dim>
double drift_after(const Scene& scene, std::int64_t steps) {
  Simulation<Dim> sim = start<Dim>(scene, MPI_COMM_WORLD);
  const HistoryRow before = stock(sim);
  advance_to(steps, 0, sim);
  const HistoryRow after = stock(sim);
  EXPECT_EQ(negative_heats(sim), 0);
  // Relative to the kinetic energy of the impact; at rest the sample itself has none.
  double mass = 0.0;
  for (const double m : sim.particles.mass) mass += m;
  MPI_Allreduce(MPI_IN_PLACE, &mass, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  const double scale = 0.5 * mass * 1100.0 * 1100.0;
  EXPECT_LT(std::abs(unnamed_energy(before, after)), 1e-12 * scale);
  EXPECT_NE(after.step_heat, 0.0);
  return (after.total - before.total) / scale;
}

class EnergyCloses : public ::testing::TestWithParam<std::vector<std::string>> {};

TEST_P(EnergyCloses, OnAPorousSample) {
  EXPECT_LT(std::abs(drift_after<2>(scene_of(porous_text(), GetParam()), 600)), 1e-12);
}

INSTANTIATE_TEST_SUITE_P(Transfers, EnergyCloses, ::testing::ValuesIn(all_transfers()));

INSTANTIATE_TEST_SUITE_P(
    Schemes, EnergyCloses,
    ::testing::Values(
        std::vector<std::string>{"transfer.velocity=pic", "transfer.shape=quadratic"},
        std::vector<std::string>{"transfer.velocity=apic", "transfer.shape=quadratic"},
        std::vector<std::string>{"transfer.velocity=iapic", "transfer.shape=quadratic"},
        std::vector<std::string>{"transfer.shape=quadratic"},
        std::vector<std::string>{"transfer.velocity=flip", "transfer.damping=0.2"},
        std::vector<std::string>{"transfer.velocity=aflip", "transfer.damping=0.0"},
        std::vector<std::string>{"transfer.damping=0.0"},
        std::vector<std::string>{"transfer.damping=10.0"},
        std::vector<std::string>{"viscosity.limited=false"},
        std::vector<std::string>{"transfer.gradient=moments"},
        std::vector<std::string>{"transfer.gradient=moments", "transfer.velocity=polypic"},
        std::vector<std::string>{"transfer.gradient=moments", "transfer.shape=quadratic"},
        std::vector<std::string>{"transfer.preset=lineage"},
        std::vector<std::string>{"transfer.preset=lineage", "transfer.damping=0.2"},
        std::vector<std::string>{"thermal=paper"},
        std::vector<std::string>{"material.0.kinematic_share=1.0",
                                 "material.0.plastic_heat=dissipation"},
        std::vector<std::string>{"loading.frame=[1000.0, 0.0]"},
        std::vector<std::string>{"loading.velocity=0.0",
                                 "boundary.low={kind='wall', velocity=1100.0}"},
        std::vector<std::string>{"body_force.acceleration=[1e9, -1e9]"},
        std::vector<std::string>{"domain.periodic=false", "boundary.lateral=symmetry"},
        std::vector<std::string>{"conduction.on=true", "material.0.conductivity=2e4"},
        std::vector<std::string>{"conduction.on=true", "material.0.conductivity=2e4",
                                 "thermal=paper", "transfer.shape=quadratic",
                                 "material.0.kinematic_share=0.5"}));

TEST(Conservation, EnergyClosesIn3D) {
  const std::string text = balls_text();
  for (const auto& transfer : all_transfers()) {
    EXPECT_LT(std::abs(drift_after<3>(scene_of(text, transfer), 60)), 1e-12) << transfer.front();
  }
}

// Hats stop on collapsing voids; what they do until then closes too.
TEST(Conservation, EnergyClosesWithHats) {
  const Scene scene = scene_of(porous_text(), {"transfer.shape=linear", "loading.velocity=50.0"});
  Simulation<2> sim = start<2>(scene, MPI_COMM_WORLD);
  const HistoryRow before = stock(sim);
  advance_to(200, 0, sim);
  EXPECT_NEAR(stock(sim).total / before.total, 1.0, 1e-12);
  EXPECT_EQ(negative_heats(sim), 0);
}

TEST(Conservation, EscapedParticlesTakeTheirEnergyAlong) {
  const Scene scene = scene_of(porous_text(), {"boundary.low=free", "time.end=2e-7"});
  Simulation<2> sim = start<2>(scene, MPI_COMM_WORLD);
  const HistoryRow before = stock(sim);
  advance_to(1000000, 0, sim);
  const HistoryRow after = stock(sim);
  EXPECT_LT(after.particles, before.particles);
  EXPECT_EQ(after.particles + sum(sim.ledger.escaped.particles, MPI_COMM_WORLD), before.particles);
  const double each = 2700.0 * 5e-6 * 5e-6;
  std::vector<Int128> escaped = {sim.ledger.escaped.mass};
  sum(escaped, MPI_COMM_WORLD);
  EXPECT_NEAR(static_cast<double>(escaped[0]) * mass_quantum(sim.ledger),
              each * static_cast<double>(before.particles - after.particles), 1e-12 * each * 1e4);
  EXPECT_GT(after.escaped, 0.4 * before.total);
  EXPECT_NEAR(after.total / before.total, 1.0, 1e-13);
  EXPECT_EQ(negative_heats(sim), 0);
}

class MomentumIsKept : public ::testing::TestWithParam<std::vector<std::string>> {};

TEST_P(MomentumIsKept, ButForTheImpulseOfTheWall) {
  Simulation<2> sim = start<2>(scene_of(porous_text(), GetParam()), MPI_COMM_WORLD);
  const HistoryRow before = stock(sim);
  advance_to(400, 0, sim);
  const HistoryRow after = stock(sim);
  std::vector<Int128> impulse = {sim.ledger.nodes.wall_impulse[0],
                                 sim.ledger.nodes.wall_impulse[1]};
  sum(impulse, MPI_COMM_WORLD);
  const double scale = std::abs(before.momentum[1]);
  for (std::size_t a = 0; a < 2; ++a) {
    const double given = static_cast<double>(impulse[a]) * sim.ledger.momentum_quantum;
    EXPECT_NEAR(after.momentum[a] - before.momentum[a], given, 1e-12 * scale) << "axis " << a;
  }
  EXPECT_NEAR(after.momentum[0], 0.0, 1e-12 * scale);
  EXPECT_GT(after.momentum[1] - before.momentum[1], 0.3 * scale);
}

INSTANTIATE_TEST_SUITE_P(Transfers, MomentumIsKept, ::testing::ValuesIn(all_transfers()));

TEST(Conservation, TotalMomentumOfTheHistoryIsConstant) {
  const std::vector<std::vector<std::string>> scenes = {
      {"body_force.acceleration=[1e9, -1e9]"},
      {"boundary.low=free", "time.end=2e-7"},
      {"domain.periodic=false", "boundary.lateral=symmetry", "loading.frame=[0.0, 300.0]"}};
  for (const auto& changes : scenes) {
    Simulation<2> sim = start<2>(scene_of(porous_text(), changes), MPI_COMM_WORLD);
    const HistoryRow before = stock(sim);
    const double scale = 2700.0 * 0.8 * 0.2e-3 * 0.4e-3 * 1100.0;
    EXPECT_NEAR(before.momentum[1] / scale, changes[0][0] == 'd' ? -8.0 / 11.0 : -1.0, 0.01);
    advance_to(changes[1 % changes.size()][0] == 't' ? 1000000 : 400, 0, sim);
    const HistoryRow after = stock(sim);
    EXPECT_GT(std::abs(after.momentum[1] - before.momentum[1]), 0.05 * scale);
    EXPECT_EQ(negative_heats(sim), 0) << changes[0];
    for (std::size_t a = 0; a < 2; ++a) {
      EXPECT_NEAR(after.total_momentum[a], before.total_momentum[a], 1e-12 * scale) << changes[0];
      const double balance = after.momentum[a] + after.escaped_momentum[a] - after.wall_impulse[a] -
                             after.body_impulse[a];
      EXPECT_NEAR(after.total_momentum[a], balance, 1e-12 * scale);
    }
  }
}

TEST(Conservation, WallForceIsTheImpulseOverTime) {
  Simulation<2> sim = start<2>(scene_of(porous_text()), MPI_COMM_WORLD);
  EXPECT_EQ(mean_wall_force(sim.ledger, 2, 0.0, MPI_COMM_WORLD), 0.0);
  double impulse = 0.0, time = 0.0;
  for (const std::int64_t step : {100, 130, 300}) {
    advance_to(step, 0, sim);
    const double force = mean_wall_force(sim.ledger, 2, sim.clock.time, MPI_COMM_WORLD);
    EXPECT_GT(force, 0.0);
    impulse += force * (sim.clock.time - time);
    time = sim.clock.time;
    mark_row(2, time, sim.ledger);
  }
  EXPECT_NEAR(impulse / stock(sim).wall_impulse[1], 1.0, 1e-12);
  EXPECT_EQ(negative_heats(sim), 0);
}

TEST(Symmetry, ScaledByTwoGivesTheSameBits) {
  // Without conduction the equations have no length: twice the size and time, the same fields.
  const auto fields = [](const std::vector<std::string>& overrides, std::int64_t steps) {
    Simulation<2> sim = start<2>(scene_of(porous_text(), overrides), MPI_COMM_SELF);
    advance_to(steps, 0, sim);
    std::vector<std::pair<std::int64_t, std::pair<double, double>>> values;
    for (std::size_t p = 0; p < sim.particles.size(); ++p) {
      values.push_back(
          {sim.particles.id[p], {sim.particles.pressure[p], sim.particles.internal_energy[p]}});
    }
    std::sort(values.begin(), values.end());
    return values;
  };
  const auto small = fields({"output.beat=4e-9"}, 200);
  const auto large =
      fields({"domain.size=[0.4e-3, 0.88e-3]", "domain.cell=20e-6", "sample.height=0.8e-3",
              "sample.void_radius=60e-6", "time.end=2e-6", "output.beat=8e-9"},
             200);
  EXPECT_TRUE(small == large);
}

TEST(Symmetry, UniformTranslationStaysQuiet) {
  // A block that flies through the grid feels nothing.
  const Scene scene = scene_of(
      porous_text(), {"boundary.low=free", "domain.size=[0.2e-3, 1.2e-3]", "loading.velocity=0.0",
                      "loading.frame=[700.0, 1100.0]", "time.end=6e-7"});
  Simulation<2> sim = start<2>(scene, MPI_COMM_WORLD);
  advance_to(1000000, 0, sim);
  double stress = 0.0, error = 0.0;
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    stress = std::max(stress, std::abs(sim.particles.pressure[p]));
    for (const auto& column : sim.particles.deviator)
      stress = std::max(stress, std::abs(column[p]));
    error = std::max({error, std::abs(sim.particles.velocity[0][p] - 700.0),
                      std::abs(sim.particles.velocity[1][p] - 1100.0)});
  }
  EXPECT_GT(sim.clock.step, 500);
  EXPECT_LT(stress, 1e-9 * 77.28e9);
  EXPECT_LT(error, 1e-9 * 1100.0);
}

TEST(Symmetry, MovingWallEqualsFallingBlock) {
  const auto stress_of = [](const std::vector<std::string>& overrides) {
    Simulation<2> sim = start<2>(scene_of(porous_text(), overrides), MPI_COMM_WORLD);
    advance_to(300, 0, sim);
    HistoryRow row = stock(sim);
    return row.internal;
  };
  const double falling = stress_of({});
  const double pushed =
      stress_of({"loading.velocity=0.0", "boundary.low={kind='wall', velocity=1100.0}"});
  EXPECT_NEAR(pushed / falling, 1.0, 1e-9);
}

}  // namespace
}  // namespace poreshock::test
