// Heat conduction in whole runs: what it does to the step, to the energies of the paper's model,
// and that a scene without it holds nothing for it.
#include <gtest/gtest.h>

#include <limits>

#include "poreshock/material/derived.hpp"
#include "poreshock/run/checksum.hpp"
#include "support/runs.hpp"

namespace poreshock::test {
namespace {

Simulation<2> run_to(std::int64_t step, const std::vector<std::string>& overrides) {
  Simulation<2> sim = start<2>(scene_of(porous_text(), overrides), MPI_COMM_WORLD);
  advance_to(step, 0, sim);
  return sim;
}

const std::vector<std::string> conducting = {"conduction.on=true", "material.0.conductivity=237"};

TEST(Conduction, CostsNothingWhereNothingConducts) {
  const std::uint64_t plain = checksum(run_to(60, {}));
  for (const std::vector<std::string>& off :
       {std::vector<std::string>{"material.0.conductivity=237"},
        std::vector<std::string>{"conduction.on=true"},
        std::vector<std::string>{"conduction.on=false", "material.0.conductivity=237"}}) {
    const Simulation<2> sim = run_to(60, off);
    EXPECT_FALSE(sim.heat);
    EXPECT_EQ(sim.heat_flow.excess.capacity(), 0u);
    EXPECT_FALSE(sim.particles.options.conducted_heat);
    EXPECT_EQ(sim.phases.calls[static_cast<std::size_t>(PhaseName::conduction)], 0);
    EXPECT_EQ(checksum(sim), plain);
  }
  const Simulation<2> sim = run_to(60, conducting);
  EXPECT_EQ(sim.phases.calls[static_cast<std::size_t>(PhaseName::conduction)], 60);
  EXPECT_NE(checksum(sim), plain);
}

TEST(Conduction, LimitsTheStep) {
  // 237 W/(m K) hardly matter at this cell; a million times as much does.
  const Simulation<2> mild = start<2>(scene_of(porous_text(), conducting), MPI_COMM_WORLD);
  EXPECT_EQ(mild.clock.limit, start<2>(scene_of(porous_text()), MPI_COMM_WORLD).clock.limit);
  const double a = 2e6 / (2700.0 * 880.0);
  for (const auto& [shape, spread] : {std::pair{"cubic", 3.14}, std::pair{"quadratic", 6.0}}) {
    const Simulation<2> sim = run_to(5, {"conduction.on=true", "material.0.conductivity=2e6",
                                         std::string("transfer.shape=") + shape});
    EXPECT_NEAR(sim.clock.limit, 1e-10 / (2.0 * spread * a), 1e-22) << shape;
  }
}

TEST(Conduction, PaperModeKeepsItsPressure) {
  // Pressure follows from volume and plastic work alone: the motion is that without conduction.
  std::vector<std::string> overrides = {"thermal=paper"};
  const Simulation<2> plain = run_to(200, overrides);
  overrides.insert(overrides.end(), conducting.begin(), conducting.end());
  const Simulation<2> sim = run_to(200, overrides);
  ASSERT_EQ(sim.particles.id, plain.particles.id);
  EXPECT_EQ(sim.particles.pressure, plain.particles.pressure);
  EXPECT_EQ(sim.particles.position, plain.particles.position);
  std::vector<double> T, T_plain;
  derive_field<2>("temperature", sim.particles, sim.materials, Thermal::paper, T);
  derive_field<2>("temperature", plain.particles, plain.materials, Thermal::paper, T_plain);
  double largest = 0.0;
  for (std::size_t p = 0; p < T.size(); ++p) {
    const double rise = sim.particles.conducted_heat[p] / 880.0;
    largest = std::max(largest, std::abs(rise));
    EXPECT_NEAR(T[p], std::max(T_plain[p] + rise, temperature_floor), 1e-9);
    EXPECT_NEAR(sim.particles.internal_energy[p],
                plain.particles.internal_energy[p] + sim.particles.conducted_heat[p], 1e-6);
  }
  EXPECT_GT(from_rank_zero(largest), 1.0);
}

TEST(Conduction, LedgerBooksRoundOffOnly) {
  const Simulation<2> sim = run_to(300, conducting);
  const HistoryRow row = stock(sim);
  EXPECT_LT(std::abs(row.conduction), 1e-13 * row.internal);
}

TEST(Conduction, CoolsTheHotSpots) {
  // The hottest particle is colder, the mean temperature the same within a few kelvin.
  const auto temperatures = [](const std::vector<std::string>& overrides) {
    const Simulation<2> sim = run_to(400, overrides);
    std::vector<double> T;
    derive_field<2>("temperature", sim.particles, sim.materials, Thermal::conserving, T);
    std::array<double, 3> values{};
    for (const double t : T) {
      values[0] = std::max(values[0], t);
      values[1] += t;
      values[2] += 1.0;
    }
    MPI_Allreduce(MPI_IN_PLACE, values.data(), 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
    MPI_Allreduce(MPI_IN_PLACE, values.data() + 1, 2, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
    return std::pair{values[0], values[1] / values[2]};
  };
  const auto [hot, mean] = temperatures({});
  const auto [mild_hot, mild_mean] = temperatures(conducting);
  EXPECT_LT(mild_hot, 0.95 * hot);
  EXPECT_NEAR(mild_mean, mean, 0.02 * (mean - 300.0));
}

}  // namespace
}  // namespace poreshock::test
