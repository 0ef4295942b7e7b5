// The stable step: a particle without neighbours is what bears the least.
#include <gtest/gtest.h>

#include <cmath>

#include "support/runs.hpp"

namespace poreshock::test {
namespace {

constexpr double cell = 20e-6;

/// One particle at rest in empty space.
template <int Dim>
std::string lone_text() {
  const std::string ends = Dim == 2 ? "" : ", 100e-6";
  return "[domain]\nsize = [200e-6, 200e-6" + std::string(Dim == 2 ? "" : ", 200e-6") +
         "]\ncell = 20e-6\n[boundary]\nlow = \"free\"\nhigh = \"free\"\n" +
         "[[body]]\nshape = \"box\"\nlow = [100e-6, 100e-6" + ends + "]\nhigh = [110e-6, 110e-6" +
         (Dim == 2 ? "" : ", 110e-6") + "]\n[time]\nend = 1\nsleep = false\n[output]\nbeat = 1\n" +
         aluminium_text;
}

/// Largest pressure in the second half of 400 steps at the limit of the step, over that at the
/// start, of a particle denser by 1e-6 that is anywhere in its cell.
template <int Dim>
double growth(const std::vector<std::string>& scheme) {
  double worst = 0.0;
  for (int place = 0; place < 36; ++place) {
    Simulation<Dim> sim = start<Dim>(scene_of(lone_text<Dim>(), scheme), MPI_COMM_SELF);
    EXPECT_EQ(sim.particles.size(), 1u);
    sim.particles.position[0][0] += (place % 6) / 5.0 * 0.5 * cell;
    for (int a = 1; a < Dim; ++a) sim.particles.position[a][0] += (place / 6) / 5.0 * 0.5 * cell;
    sim.particles.density[0] *= 1.0 + 1e-6;
    const double start_pressure = 1e-6 * 2700.0 * 5350.0 * 5350.0;
    double largest = 0.0;
    for (std::int64_t step = 1; step <= 400; ++step) {
      advance_to(step, 0, sim);
      if (step > 200) largest = std::max(largest, std::abs(sim.particles.pressure[0]));
    }
    worst = std::max(worst, largest / start_pressure);
  }
  return worst;
}

TEST(LoneParticle, DoesNotSwingUp) {
  for (const auto& transfer : all_transfers()) {
    EXPECT_LT(growth<2>(transfer), 1.0) << transfer.front();
    EXPECT_LT(growth<3>(transfer), 1.0) << transfer.front();
  }
  for (const char* cfl : {"time.cfl=1", "time.cfl=1.5"}) {
    EXPECT_LT(growth<2>({cfl}), 1.0) << cfl;
    EXPECT_LT(growth<3>({cfl}), 1.0) << cfl;
    const std::vector<std::string> quadratic = {"transfer.shape=quadratic", cfl};
    EXPECT_LT(growth<2>(quadratic), 1.0) << cfl;
    EXPECT_LT(growth<3>(quadratic), 1.0) << cfl;
  }
}

}  // namespace
}  // namespace poreshock::test
