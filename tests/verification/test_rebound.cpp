// Two elastic discs that collide head-on: the speed they keep, and an account without gaps.
#include <gtest/gtest.h>

#include <algorithm>

#include "support/runs.hpp"
#include "verification/grain_motion.hpp"
#include "verification/verify.hpp"

namespace poreshock::test {
namespace {

/// Speed of two elastic discs after a head-on collision at 50 m/s each, over that before it.
double rebound(int cells, const std::vector<std::string>& scheme) {
  const double cell = 1e-5, radius = 0.5 * cells * cell, gap = 0.6 * cell, sound = 6200.0;
  const double x = 4.3 * cell + 2.0 * radius, y = 5.45 * cell + radius;
  std::string text = "[domain]\ncell = 1e-5\nsize = [" + digits(3.0 * (cells + 4) * cell) + ", " +
                     digits((cells + 12) * cell) + R"(]
[boundary]
low = "free"
high = "free"
[viscosity]
linear = 0.0
quadratic = 0.0
[[material]]
name = "elastic"
density = 2700
young = 69e9
poisson = 0.33
yield = 1e15
c0 = 5350
lambda = 1.34
gamma = 2.0
cv = 880
)";
  const auto disc = [&](double center, const char* grain_and_velocity) {
    text += "[[body]]\nshape = \"disc\"\nradius = " + digits(radius) + "\ncenter = [" +
            digits(center) + ", " + digits(y) + "]\n" + grain_and_velocity;
  };
  disc(x, "grain = 1\nvelocity = [50.0, 0.0]\n");
  disc(x + 2.0 * radius + gap, "grain = 2\nvelocity = [-50.0, 0.0]\n");
  // Long after the waves of the collision have crossed the discs.
  const std::string end = digits(gap / 100.0 + 11.0 * cells * cell / sound);
  text += "[output]\nbeat = " + end + "\n[time]\nend = " + end + "\n";
  Simulation<2> sim = start<2>(scene_of(text, scheme), MPI_COMM_SELF);
  const HistoryRow before = stock(sim);
  advance_to(1000000, 0, sim);
  const HistoryRow after = stock(sim);
  EXPECT_LT(std::abs(unnamed_energy(before, after)), 1e-10 * before.kinetic);
  EXPECT_EQ(after.contact_heat, 0.0);
  return -motion_of(sim.particles, 1).velocity[0] / 50.0;
}

TEST(ElasticDiscs, KeepTheirSpeed) {
  verify_at_least("rebound", "speed_10", rebound(10, {}), 0.80);
  verify_at_least("rebound", "speed_20", rebound(20, {}), 0.92);
  verify_at_least("rebound", "speed_40", rebound(40, {}), 0.97);
  const char* moments = "transfer.gradient=moments";
  verify_at_least("rebound", "speed_10_moments", rebound(10, {moments}), 0.84);
  verify_at_least("rebound", "speed_20_moments", rebound(20, {moments}), 0.95);
  const char* polyflip = "transfer.velocity=polyflip";
  verify_at_least("rebound", "speed_10_polyflip", rebound(10, {polyflip}), 0.82);
}

TEST(ElasticDiscs, KeepTheirSpeedWhateverTheStep) {
  double least = 1.0, most = 0.0;
  for (const char* cfl : {"0.25", "0.5", "0.8", "1.0"}) {
    const double speed = rebound(10, {std::string("time.cfl=") + cfl});
    least = std::min(least, speed);
    most = std::max(most, speed);
  }
  verify_at_most("rebound", "spread_over_steps", most / least - 1.0, 0.02);
}

}  // namespace
}  // namespace poreshock::test
