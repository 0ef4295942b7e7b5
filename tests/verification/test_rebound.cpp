// Elastic discs that collide head-on: the speed they keep, and an account without gaps.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "support/runs.hpp"
#include "verification/grain_motion.hpp"
#include "verification/verify.hpp"

namespace poreshock::test {
namespace {

constexpr double sound = 6200.0;  // m/s

/// Velocities of elastic discs in a row, `gap` cells apart, after the time `end`.
std::vector<double> collide(int cells, double gap, const std::vector<double>& velocities,
                            double end, const std::vector<std::string>& scheme) {
  constexpr double cell = 1e-5;
  const double radius = 0.5 * cells * cell, pitch = 2.0 * radius + gap * cell;
  const double count = static_cast<double>(velocities.size());
  std::string text = "[domain]\ncell = 1e-5\nsize = [" +
                     digits(std::ceil(count * pitch / cell + 12.0) * cell) + ", " +
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
  for (std::size_t n = 0; n < velocities.size(); ++n) {
    const double x = 4.3 * cell + radius + static_cast<double>(n) * pitch;
    text += "[[body]]\nshape = \"disc\"\nradius = " + digits(radius) + "\ncenter = [" + digits(x) +
            ", " + digits(5.45 * cell + radius) + "]\ngrain = " + std::to_string(n + 1) +
            "\nvelocity = [" + digits(velocities[n]) + ", 0.0]\n";
  }
  text += "[output]\nbeat = " + digits(end) + "\n[time]\nend = " + digits(end) + "\n";
  Simulation<2> sim = start<2>(scene_of(text, scheme), MPI_COMM_SELF);
  const HistoryRow before = stock(sim);
  advance_to(1000000, 0, sim);
  const HistoryRow after = stock(sim);
  // What rounds is the stored energy, a part of m c^2.
  const double mass = std::accumulate(sim.particles.mass.begin(), sim.particles.mass.end(), 0.0);
  EXPECT_LT(std::abs(unnamed_energy(before, after)), 3e-15 * mass * sound * sound);
  EXPECT_EQ(after.contact_heat, 0.0);
  std::vector<double> result;
  for (std::size_t n = 0; n < velocities.size(); ++n) {
    result.push_back(motion_of(sim.particles, static_cast<int>(n) + 1).velocity[0]);
  }
  return result;
}

/// Long after the waves of a collision have crossed its discs.
double collision_time(int cells) {
  return 11.0 * cells * 1e-5 / sound;
}

/// Speed of two elastic discs after a head-on collision at 50 m/s each, over that before it.
double rebound(int cells, const std::vector<std::string>& scheme) {
  constexpr double gap = 0.6;
  const double end = gap * 1e-5 / 100.0 + collision_time(cells);
  return -collide(cells, gap, {50.0, -50.0}, end, scheme)[0] / 50.0;
}

TEST(ElasticDiscs, KeepTheirSpeed) {
  verify_at_least("rebound", "speed_10", rebound(10, {}), 0.86);
  verify_at_least("rebound", "speed_20", rebound(20, {}), 0.95);
  verify_at_least("rebound", "speed_40", rebound(40, {}), 0.98);
  const char* slopes = "transfer.gradient=slopes";
  verify_at_least("rebound", "speed_10_slopes", rebound(10, {slopes}), 0.82);
  const char* polyflip = "transfer.velocity=polyflip";
  verify_at_least("rebound", "speed_10_polyflip", rebound(10, {polyflip}), 0.88);
}

TEST(ElasticDiscs, KeepTheirSpeedWhateverTheStep) {
  double least = 1.0, most = 0.0;
  for (const char* cfl : {"0.125", "0.25", "0.5", "0.8", "1.0"}) {
    const double speed = rebound(10, {std::string("time.cfl=") + cfl});
    least = std::min(least, speed);
    most = std::max(most, speed);
  }
  verify_at_least("rebound", "speed_10_whatever_the_step", least, 0.85);
  verify_known_shortfall("rebound", "spread_over_steps", most / least - 1.0, 0.02, 0.026);
}

TEST(ElasticDiscs, KeepLessOfALowSpeed) {
  // The slower, the smaller is the place of contact, beside the same cells, and the longer they
  // touch.
  for (const auto& [speed, least] : {std::pair{5.0, 0.60}, {25.0, 0.76}}) {
    const auto v = collide(10, 1.0, {speed, -speed}, 0.5e-5 / speed + 3.0 * collision_time(10), {});
    const std::string figure = "speed_10_at_" + digits(2.0 * speed);
    verify_at_least("rebound", figure, 0.5 * (v[1] - v[0]) / speed, least);
  }
}

TEST(ElasticDiscs, PassTheirMotionAlongARow) {
  // A whole number of cells apart, all have the same particles; each pair collides alone.
  constexpr double gap = 3.0, speed = 50.0, slowest = 0.5 * speed;
  const double end = 4.0 * (gap * 1e-5 / slowest + collision_time(10));
  const auto v = collide(10, gap, {speed, 0.0, 0.0, 0.0, 0.0}, end, {});
  EXPECT_NEAR(std::accumulate(v.begin(), v.end(), 0.0), speed, 1e-11 * speed);
  verify_at_least("rebound", "speed_of_fifth", v[4] / speed, 0.63);
}

}  // namespace
}  // namespace poreshock::test
