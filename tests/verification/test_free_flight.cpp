// Bodies on which nothing acts: at rest under pressure, in flight through the grid, turning, and as
// single particles.

#include <algorithm>
#include <limits>

#include "verification/states.hpp"

namespace poreshock::test {
namespace {

constexpr double bulk = 2700.0 * 5350.0 * 5350.0;

double fastest(const Simulation<2>& sim, const Plane& frame) {
  double largest = 0.0;
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    for (int a = 0; a < 2; ++a) {
      largest = std::max(largest, std::abs(sim.particles.velocity[a][p] - frame[a]));
    }
  }
  return largest;
}

double largest_stress(const Simulation<2>& sim) {
  double largest = 0.0;
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    largest = std::max(largest, std::abs(sim.particles.pressure[p]));
    for (const auto& column : sim.particles.deviator) {
      largest = std::max(largest, std::abs(column[p]));
    }
  }
  return largest;
}

/// Rows asleep would only be moved, and nothing could go wrong.
std::vector<std::string> awake(std::vector<std::string> overrides) {
  overrides.emplace_back("time.sleep=false");
  return overrides;
}

// --- at rest ---------------------------------------------------------------------------------

/// A block between symmetry planes, denser than its material by a factor: 1.01 is 0.8 GPa.
Simulation<2> compressed_block(double factor, const std::vector<std::string>& overrides) {
  const std::string text = std::string(R"(
[domain]
size = [40e-6, 80e-6]
cell = 10e-6
periodic = true
[boundary]
low = "symmetry"
high = "symmetry"
[sample]
kind = "solid"
[time]
end = 1.0
)") + aluminium_text;
  Simulation<2> sim = start<2>(plain_scene_of(text, awake(overrides)), MPI_COMM_SELF);
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    sim.particles.mass[p] *= factor;
    sim.particles.density[p] *= factor;
  }
  StressReport report;
  initialise_stress<2>(sim.materials, stress_settings(sim), sim.particles, report);
  sim.clock.limit = report.dt_limit;
  return sim;
}

constexpr std::int64_t quiet_steps = 100000;

struct Drift {
  double velocity = 0.0;     ///< of the sound speed
  double temperature = 0.0;  ///< K
  double rounding = 0.0;     ///< K, of one rounding of the volume in every step, at this pressure
};

Drift quiet_run(double factor, const std::vector<std::string>& overrides) {
  Simulation<2> sim = compressed_block(factor, overrides);
  EXPECT_GT(sim.particles.pressure[0], 0.6 * bulk * (factor - 1.0));
  std::vector<double> before, after;
  derive_field<2>("temperature", sim.particles, sim.materials, sim.scene.thermal, before);
  step_by(sim.clock.limit, quiet_steps, sim);
  derive_field<2>("temperature", sim.particles, sim.materials, sim.scene.thermal, after);
  Drift drift;
  drift.velocity = fastest(sim, {0.0, 0.0}) / longitudinal_sound_speed(sim.materials[0]);
  for (const double T : after)
    drift.temperature = std::max(drift.temperature, std::abs(T - before[0]));
  drift.rounding = quiet_steps * std::numeric_limits<double>::epsilon() *
                   sim.particles.pressure[0] / (sim.particles.density[0] * sim.materials[0].eos.cv);
  return drift;
}

void stay_quiet(const std::string& name, double factor, const std::vector<std::string>& overrides) {
  const Drift drift = quiet_run(factor, overrides);
  verify_at_most(name, "velocity_over_c", drift.velocity, 1e-12);
  verify_at_most(name, "temperature_drift_of_rounding", drift.temperature / drift.rounding, 1.0);
}

TEST(QuietSolid, ApicStaysQuietUnderPressure) {
  stay_quiet("quiet_solid_apic", 1.01, {});
}

TEST(QuietSolid, FlipStaysQuietUnderPressure) {
  stay_quiet("quiet_solid_flip", 1.01, {"transfer.velocity=flip"});
}

TEST(QuietSolid, AflipStaysQuietUnderPressure) {
  stay_quiet("quiet_solid_aflip", 1.01, default_scheme());
}

TEST(QuietSolid, QuadraticAflipStaysQuietUnderPressure) {
  stay_quiet("quiet_solid_quadratic_aflip", 1.01,
             with_transfer(VelocityTransfer::aflip, {"transfer.shape=quadratic"}));
}

// --- translation -----------------------------------------------------------------------------

void translate(const std::string& name, const std::vector<std::string>& overrides) {
  // More than 100 cells along y, and 440 along x.
  const std::string text = std::string(R"(
[domain]
size = [60e-6, 4e-3]
cell = 10e-6
periodic = true
[boundary]
low = "free"
[sample]
kind = "solid"
height = 60e-6
[loading]
frame = [1100.0, 250.0]
[time]
end = 1.0
)") + aluminium_text;
  Simulation<2> sim = start<2>(plain_scene_of(text, awake(overrides)), MPI_COMM_SELF);
  const HistoryRow before = stock(sim);
  const double dt = sim.clock.limit;
  const auto half_steps = static_cast<std::int64_t>(std::ceil(50.5 * 10e-6 / (250.0 * dt)));
  double stress_halfway = 0.0;
  for (int half = 0; half < 2; ++half) {
    step_by(dt, half_steps, sim);
    if (half == 0) stress_halfway = largest_stress(sim);
  }
  const HistoryRow after = stock(sim);
  EXPECT_GT(250.0 * sim.clock.time, 100 * 10e-6);
  EXPECT_EQ(after.particles, before.particles);
  verify_at_most(name, "stress_over_K0", largest_stress(sim) / bulk, 1e-9);
  record(name, "stress_over_K0_halfway", stress_halfway / bulk);
  for (std::size_t a = 0; a < 2; ++a) {
    verify_at_most(name, a == 0 ? "momentum_x" : "momentum_y",
                   std::abs(after.momentum[a] / before.momentum[a] - 1.0), 1e-14);
  }
  verify_at_most(name, "velocity_noise", fastest(sim, {1100.0, 250.0}) / 1100.0, 1e-10);
}

TEST(Translation, CubicApicFeelsNothing) {
  translate("translation_cubic_apic", {});
}

TEST(Translation, CubicFlipFeelsNothing) {
  translate("translation_cubic_flip", {"transfer.velocity=flip"});
}

TEST(Translation, AflipFeelsNothing) {
  translate("translation_aflip", default_scheme());
}

TEST(Translation, QuadraticAflipFeelsNothing) {
  translate("translation_quadratic_aflip",
            with_transfer(VelocityTransfer::aflip, {"transfer.shape=quadratic"}));
}

// --- single particles ------------------------------------------------------------------------

/// A box of particles in the middle of a domain that is free all around.
std::string spray_scene() {
  return std::string(R"(
[domain]
size = [2.8e-3, 2.8e-3]
cell = 10e-6
[boundary]
low = "free"
[[body]]
shape = "box"
low = [1.2e-3, 1.2e-3]
high = [1.6e-3, 1.6e-3]
[time]
end = 1.0
)") + aluminium_text;
}

void spray(const std::string& name, const std::vector<std::string>& overrides) {
  // Every eighth site in both directions: no two particles share a node. They fly apart, the
  // fastest over a hundred cells.
  Simulation<2> sim = start<2>(plain_scene_of(spray_scene(), overrides), MPI_COMM_SELF);
  std::vector<std::uint32_t> kept;
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    const std::int64_t column = sim.particles.id[p] % 560, row = sim.particles.id[p] / 560;
    if (column % 10 == 3 && row % 10 == 7) kept.push_back(static_cast<std::uint32_t>(p));
  }
  reorder(kept, sim.particles);
  ASSERT_GE(sim.particles.size(), 64U);
  const auto speed = [](double x) { return 6.0e6 * (x - 1.4e-3); };
  set_motion([&](const Plane& x) { return Motion{{speed(x[0]), speed(x[1])}, {}}; }, sim);
  std::vector<double> before, after;
  derive_field<2>("temperature", sim.particles, sim.materials, sim.scene.thermal, before);
  sim.scene.time.end = 1.0e-3 / 1100.0;
  advance_to(1000000, 0, sim);
  ASSERT_EQ(sim.clock.bad, 0);
  double velocity = 0.0, place = 0.0, farthest = 0.0;
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    const Plane X = site(sim, p);
    for (int a = 0; a < 2; ++a) {
      const double v = speed(X[a]);
      velocity = std::max(velocity, std::abs(sim.particles.velocity[a][p] - v) / 1100.0);
      const double moved = sim.particles.position[a][p] - X[a];
      place = std::max(place, std::abs(moved - v * sim.clock.time) / 1e-3);
      farthest = std::max(farthest, std::abs(moved));
    }
  }
  derive_field<2>("temperature", sim.particles, sim.materials, sim.scene.thermal, after);
  double warming = 0.0;
  for (const double T : after) warming = std::max(warming, std::abs(T - before[0]));
  EXPECT_GE(farthest, 1e-3);
  verify_at_most(name, "velocity_error", velocity, 1e-10);
  verify_at_most(name, "position_error", place, 1e-10);
  verify_at_most(name, "temperature_change_K", warming, 1e-9);
  verify_at_most(name, "stress_over_K0", largest_stress(sim) / bulk, 1e-9);
}

TEST(Spray, ApicParticlesFlyOn) {
  spray("spray_cubic_apic", {});
}

TEST(Spray, FlipParticlesFlyOn) {
  spray("spray_cubic_flip", {"transfer.velocity=flip"});
}

TEST(Spray, PolyFlipParticlesFlyOn) {
  spray("spray_aflip", default_scheme());
}

TEST(Spray, QuadraticApicParticlesFlyOn) {
  spray("spray_quadratic_apic", {"transfer.shape=quadratic"});
}

}  // namespace
}  // namespace poreshock::test
