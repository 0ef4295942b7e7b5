// The strength that the free surface of a plate tells, as a velocimeter sees it.
#include <gtest/gtest.h>

#include <cstdio>

#include "poreshock/run/trace.hpp"
#include "support/runs.hpp"

namespace poreshock::test {
namespace {

constexpr double c0 = 5350.0, density = 2700.0;

/// Spall strength (Pa) that the free surface of a target tells which a flyer hits at 1100 m/s.
double told_strength(double cell, double strength, std::vector<std::string> material) {
  char text[512];
  std::snprintf(text, sizeof text, R"(
[domain]
size = [%g, 2.4e-3]
cell = %g
periodic = true
[boundary]
low = "free"
high = "free"
[[body]]
shape = "box"
low = [0, 0.1e-3]
high = [%g, 0.7e-3]
velocity = [0, 1100]
grain = 1
[[body]]
shape = "box"
low = [0, 0.7e-3]
high = [%g, 1.9e-3]
grain = 2
[time]
end = 450e-9
)",
                4.0 * cell, cell, 4.0 * cell, 4.0 * cell);
  material.push_back("material.0.spall=" + std::to_string(strength));
  Simulation<2> sim =
      start<2>(scene_of(text + std::string(aluminium_text), material), MPI_COMM_SELF);
  const double layer = 2.0 * 4.0, last = 1.9e-3 / (0.5 * cell) - 1.0;
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
