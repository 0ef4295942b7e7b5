// Solid plate on a rigid wall against the exact elastic-plastic shock, in 2-D and 3-D.
#include <gtest/gtest.h>

#include <cmath>

#include "poreshock/material/derived.hpp"
#include "support/aluminium.hpp"
#include "support/reference_shock.hpp"
#include "support/runs.hpp"

namespace poreshock::test {
namespace {

/// Means over the middle half of the shocked length.
struct Plateau {
  double stress = 0.0, density = 0.0, temperature = 0.0, plastic_strain = 0.0;
};

template <int Dim>
Plateau plateau(const Simulation<Dim>& sim, double front) {
  std::vector<double> T;
  derive_field<Dim>("temperature", sim.particles, sim.materials, sim.scene.thermal, T);
  std::array<double, 5> sums{};
  constexpr int axial = Dim - 1;  // xx yy zz: the shock axis
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    const double y = sim.particles.position[Dim - 1][p];
    if (y < 0.25 * front || y > 0.75 * front) continue;
    sums[0] += 1.0;
    sums[1] += sim.particles.pressure[p] - sim.particles.deviator[axial][p];
    sums[2] += sim.particles.density[p];
    sums[3] += T[p];
    sums[4] += sim.particles.plastic_strain[p];
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), 5, MPI_DOUBLE, MPI_SUM, sim.communicator);
  return {sums[1] / sums[0], sums[2] / sums[0], sums[3] / sums[0], sums[4] / sums[0]};
}

std::string plate_text(const std::string& size, const std::string& height) {
  return "[domain]\nsize = " + size + "\ncell = 20e-6\nperiodic = true\n" +
         "[sample]\nheight = " + height + R"(
kind = "solid"
[boundary]
low = "wall"
[loading]
velocity = 1100
[time]
end = 500e-9
)" + aluminium_text;
}

template <int Dim>
Plateau run_plate(const std::string& size, const std::string& height, const std::string& end,
                  const std::string& cfl) {
  constexpr double velocity = 1100.0;
  Simulation<Dim> sim =
      start<Dim>(scene_of(plate_text(size, height), {"time.end=" + end, cfl}), MPI_COMM_WORLD);
  advance_to(1000000, 0, sim);
  const auto exact = reference::piston(reference::solid(reference::aluminium()), velocity);
  return plateau(sim, (exact.shocked.front - velocity) * sim.clock.time);
}

void expect_exact(const Plateau& found, double velocity) {
  const auto exact = reference::piston(reference::solid(reference::aluminium()), velocity).shocked;
  EXPECT_NEAR(found.stress / exact.stress, 1.0, 0.005);
  EXPECT_NEAR(found.density / exact.density(), 1.0, 0.001);
  EXPECT_NEAR(found.temperature, exact.temperature, 0.02 * (exact.temperature - 300.0));
  EXPECT_NEAR(found.plastic_strain / exact.plastic_strain, 1.0, 0.02);
}

TEST(Plate, MatchesTheExactShockAt1100) {
  expect_exact(run_plate<2>("[0.08e-3, 5.2e-3]", "5e-3", "500e-9", "time.cfl=1"), 1100.0);
}

TEST(Plate, ThreeDimensionsGiveTheSameNumbers) {
  // Longer steps are bounded by what a particle alone bears, and that is less in 3-D.
  const std::string same = "time.cfl=0.15";
  const Plateau plane = run_plate<2>("[0.08e-3, 1.6e-3]", "1.4e-3", "150e-9", same);
  const Plateau space = run_plate<3>("[0.08e-3, 0.08e-3, 1.6e-3]", "1.4e-3", "150e-9", same);
  EXPECT_NEAR(space.stress / plane.stress, 1.0, 1e-9);
  EXPECT_NEAR(space.density / plane.density, 1.0, 1e-9);
  EXPECT_NEAR(space.temperature / plane.temperature, 1.0, 1e-9);
  EXPECT_NEAR(space.plastic_strain / plane.plastic_strain, 1.0, 1e-9);
}

}  // namespace
}  // namespace poreshock::test
