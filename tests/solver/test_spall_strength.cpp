// The strength that the free surface of a plate tells, as a velocimeter sees it.
#include <gtest/gtest.h>

#include "poreshock/run/trace.hpp"
#include "poreshock/scene/read_scene.hpp"
#include "support/runs.hpp"

namespace poreshock::test {
namespace {

constexpr double c0 = 5350.0, density = 2700.0;

/// Spall strength (Pa) that the free surface of input/plate_spall.toml tells.
double told_strength(double cell, double strength, std::vector<std::string> changes) {
  changes.push_back("domain.cell=" + std::to_string(1e6 * cell) + "e-6");
  changes.push_back("material.0.spall=" + std::to_string(strength));
  changes.push_back("time.end=450e-9");
  const Scene scene = read_scene(PORESHOCK_SOURCE_DIR "/input/plate_spall.toml", changes);
  Simulation<2> sim = start<2>(scene, MPI_COMM_SELF);
  const double layer = scene.domain.size[0] / (0.5 * cell), last = 1.9e-3 / (0.5 * cell) - 1.0;
  std::vector<double> time, velocity;
  while (sim.clock.time < sim.scene.time.end) {
    advance_to(sim.clock.step + 1, 0, sim);
    double speed = 0.0;
    for (std::size_t p = 0; p < sim.particles.size(); ++p) {
      // The layer that lay at the free surface.
      if (static_cast<double>(sim.particles.id[p]) < layer * last) continue;
      speed += sim.particles.velocity[1][p] / layer;
    }
    time.push_back(sim.clock.time);
    velocity.push_back(speed);
  }
  return read_figures(time, velocity, density * c0).spall_strength;
}

TEST(SpallStrength, PlateTellsItsStrength) {
  // Without strength the acoustic formula is exact: expansion is linear in the volume.
  const std::vector<std::string> fluid = {"material.0.young=0.0", "material.0.yield=0.0",
                                          "material.0.hardening=0.0"};
  EXPECT_NEAR(told_strength(10e-6, 2e9, fluid) / 2e9, 1.0, 0.03);
  EXPECT_NEAR(told_strength(10e-6, 1e9, fluid) / 1e9, 1.0, 0.03);
  EXPECT_NEAR(told_strength(5e-6, 2e9, fluid) / 2e9, 1.0, 0.01);
}

TEST(SpallStrength, PlateWithAYieldStressTellsItsStrength) {
  EXPECT_NEAR(told_strength(5e-6, 2e9, {}) / 2e9, 1.0, 0.03);
}

}  // namespace
}  // namespace poreshock::test
