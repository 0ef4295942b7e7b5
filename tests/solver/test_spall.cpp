// Spall in whole runs: pull-back of a free surface, tension without a spall strength, energy, bits.
//
// Acoustic solution. A wave P(x + c t) runs upwards into the free surface, whose velocity is
// u = 2 P/(rho c). The reflected wave is -P, so at a depth x the pressure is that of the wave 2x
// later minus that of the wave before. Let P be a plateau P0 that falls off linearly: then the
// tension grows from the surface downwards and reaches S first where the tail has fallen to
// P0 - S (at half the length from the start of the plateau to there). What comes later from below
// is held back by the new surface, so the velocity of the free surface falls by 2 S/(rho c) from
// its plateau, and then rises again. Without a strength the tension grows to P0.
#include <gtest/gtest.h>

#include <algorithm>

#include "poreshock/material/derived.hpp"
#include "support/runs.hpp"
#include "support/same_bits.hpp"

namespace poreshock::test {
namespace {

constexpr double c0 = 5350.0, density = 2700.0;
constexpr double plateau_pressure = 2e8;                          ///< Pa
constexpr double tail = 0.8e-3, plateau = 0.1e-3, rise = 0.1e-3;  ///< m
constexpr double top = 1.2e-3;                                    ///< m, the free surface

/// The wave as a function of the distance below its front.
double wave(double below) {
  if (below < 0.0) return 0.0;
  if (below < rise) return plateau_pressure * below / rise;
  below -= rise + plateau;
  if (below < 0.0) return plateau_pressure;
  return below < tail ? plateau_pressure * (1.0 - below / tail) : 0.0;
}

/// A strip without strength, with the wave in it just below its free surface.
Simulation<2> strip_with_wave(double cell, double spall) {
  char text[64];
  std::snprintf(text, sizeof text, "domain.cell=%g", cell);
  const std::string cells = text;
  std::snprintf(text, sizeof text, "domain.size=[%g, 1.28e-3]", 4.0 * cell);
  const std::string size = text;
  Simulation<2> sim =
      start<2>(plain_scene_of(porous_text(),
                              {cells, size, "sample.kind=solid", "sample.height=1.2e-3",
                               "boundary.low=free", "loading.velocity=0.0", "material.0.young=0.0",
                               "material.0.yield=0.0", "material.0.hardening=0.0",
                               "material.0.spall=" + std::to_string(spall), "time.end=1e-6"}),
               MPI_COMM_WORLD);
  Particles<2>& p = sim.particles;
  for (std::size_t i = 0; i < p.size(); ++i) {
    // P = rho c u; on the isentrope E = P^2/(2 rho K) to the order that matters here.
    const double P = wave(top - p.position[1][i]);
    const double eta = P / (density * c0 * c0);
    p.velocity[1][i] = P / (density * c0);
    p.density[i] = density / (1.0 - eta);
    p.internal_energy[i] = 0.5 * P * eta / density;
  }
  StressReport report;
  initialise_stress<2>(sim.materials, stress_settings(sim), p, report);
  return sim;
}

/// What the run shows from outside and inside.
struct Spalling {
  double fastest = 0.0, slowest_after = 0.0;  ///< m/s, free surface
  double tension = 0.0;                       ///< Pa, largest
  std::int64_t failed = 0;
};

/// Runs until the signal of the first failure has passed the surface. Collective.
Spalling observe(double cell, double spall) {
  Simulation<2> sim = strip_with_wave(cell, spall);
  Spalling seen;
  while (sim.clock.time < 2.2e-7) {
    advance_to(sim.clock.step + 1, 0, sim);
    const Particles<2>& p = sim.particles;
    std::array<double, 2> ends = {-1e30, -1e30};
    for (std::size_t i = 0; i < p.size(); ++i) {
      // The particle of the surface is the one that lay there at first.
      if (p.position[1][i] > ends[0]) ends[0] = p.position[1][i], ends[1] = p.velocity[1][i];
      seen.tension = std::max(seen.tension, -p.pressure[i]);
    }
    struct {
      double height;
      int rank;
    } highest = {ends[0], rank(MPI_COMM_WORLD)};
    MPI_Allreduce(MPI_IN_PLACE, &highest, 1, MPI_DOUBLE_INT, MPI_MAXLOC, MPI_COMM_WORLD);
    MPI_Bcast(&ends[1], 1, MPI_DOUBLE, highest.rank, MPI_COMM_WORLD);
    seen.slowest_after = ends[1] > seen.fastest ? ends[1] : std::min(seen.slowest_after, ends[1]);
    seen.fastest = std::max(seen.fastest, ends[1]);
  }
  MPI_Allreduce(MPI_IN_PLACE, &seen.tension, 1, MPI_DOUBLE, MPI_MAX, MPI_COMM_WORLD);
  for (const std::int32_t f : sim.particles.failed) seen.failed += f > 0 ? 1 : 0;
  seen.failed = sum(seen.failed, MPI_COMM_WORLD);
  return seen;
}

TEST(Spall, WithoutAStrengthTensionReachesTheAcousticValue) {
  const Spalling seen = observe(5e-6, 0.0);
  EXPECT_EQ(seen.failed, 0);
  // The material is stiffer under pressure by 4 lambda eta = 1.4 %; the corners of the wave ring.
  EXPECT_NEAR(seen.fastest / (2.0 * plateau_pressure / (density * c0)), 1.0, 0.015);
  EXPECT_NEAR(seen.tension / plateau_pressure, 1.0, 0.04);
  EXPECT_NEAR((seen.fastest - seen.slowest_after) / seen.fastest, 1.0, 0.01);
}

TEST(Spall, PullBackOfTheFreeSurface) {
  const double strength = 0.5 * plateau_pressure;
  const double exact = 2.0 * strength / (density * c0);
  // It holds its strength until it has opened, so that the dip has a flat bottom, which no front of
  // a few cells rounds off.
  // Corners of the wave ring, and the material is stiffer under pressure by 1.4 %.
  for (const double cell : {5e-6, 2.5e-6}) {
    const Spalling seen = observe(cell, strength);
    EXPECT_GT(seen.failed, 0);
    EXPECT_LE(seen.tension, strength);
    EXPECT_GT(seen.tension, 0.999 * strength);
    EXPECT_NEAR((seen.fastest - seen.slowest_after) / exact, 1.0,
                0.03 * std::max(1.0, cell / 3e-6));
  }
}

/// A flyer of half the thickness hits a target; the releases of both free sides meet in it.
std::string flyer_text() {
  return std::string(R"(
[domain]
size = [40e-6, 1.1e-3]
cell = 10e-6
periodic = true
[boundary]
low = "free"
high = "free"
[[body]]
shape = "box"
low = [0, 0.1e-3]
high = [40e-6, 0.7e-3]
[[body]]
shape = "box"
low = [0, 0.7e-3]
high = [40e-6, 1.0e-3]
velocity = [0, -800]
[time]
end = 1e-6
)") + aluminium_text +
         "spall = 1e9\n";
}

class SpallEnergy : public ::testing::TestWithParam<std::vector<std::string>> {};

TEST_P(SpallEnergy, Closes) {
  std::vector<std::string> overrides = GetParam();
  overrides.push_back("time.end=2.2e-7");  // before the first particles leave
  Simulation<2> sim = start<2>(plain_scene_of(flyer_text(), overrides), MPI_COMM_WORLD);
  const HistoryRow before = stock(sim);
  advance_to(1000000, 0, sim);
  std::int64_t failed = 0;
  for (const std::int32_t f : sim.particles.failed) failed += f > 0 ? 1 : 0;
  EXPECT_GT(sum(failed, MPI_COMM_WORLD), 10);
  EXPECT_LT(sum(failed, MPI_COMM_WORLD), before.particles / 2);
  const HistoryRow after = stock(sim);
  EXPECT_EQ(after.particles, before.particles);
  EXPECT_NEAR(after.total / before.total, 1.0, 1e-12);
  EXPECT_LT(std::abs(unnamed_energy(before, after)), 1e-12 * before.total);
}

INSTANTIATE_TEST_SUITE_P(
    Schemes, SpallEnergy,
    ::testing::Values(std::vector<std::string>{},
                      std::vector<std::string>{"transfer.shape=quadratic", "transfer.velocity=flip",
                                               "time.cfl=0.5"},
                      std::vector<std::string>{"transfer.velocity=polyflip",
                                               "viscosity.limited=true"},
                      std::vector<std::string>{"thermal=paper"},
                      std::vector<std::string>{
                          "material.0.kinematic_share=1.0", "material.0.plastic_heat=dissipation",
                          "conduction.on=true", "material.0.conductivity=237"}));

TEST(Spall, ScabFliesAway) {
  // The target breaks in the middle: its lower half leaves with the momentum it trapped, and the
  // temperatures of what opened stay those of a solid.
  Simulation<2> sim = start<2>(plain_scene_of(flyer_text()), MPI_COMM_WORLD);
  advance_to(100000, 0, sim);
  std::vector<double> T;
  EXPECT_EQ(derive_field<2>("temperature", sim.particles, sim.materials, Thermal::conserving, T),
            0);
  double coldest = 1e9;
  for (const double t : T) coldest = std::min(coldest, t);
  MPI_Allreduce(MPI_IN_PLACE, &coldest, 1, MPI_DOUBLE, MPI_MIN, MPI_COMM_WORLD);
  EXPECT_GT(coldest, 290.0);
}

TEST(Spall, SameBitsOnAnyRanksAndAfterARestart) {
  const Scene scene = plain_scene_of(flyer_text());
  const int all = size(MPI_COMM_WORLD);
  const std::uint64_t alone = checksum_after<2>(scene, 1, 400);
  EXPECT_EQ(checksum_after<2>(scene, all, 400), alone);
  EXPECT_EQ(checksum_with_restart<2>(scene, all, all, 250, 400), alone);
}

TEST(Spall, CostsNothingWithoutAStrength) {
  const Simulation<2> sim =
      start<2>(plain_scene_of(flyer_text(), {"material.0.spall=0.0"}), MPI_COMM_WORLD);
  EXPECT_FALSE(sim.particles.options.failed);
  EXPECT_EQ(sim.particles.failed.capacity(), 0u);
}

}  // namespace
}  // namespace poreshock::test
