// Contact of one grain with itself: walls of a void that close part again, and where nothing closes
// nothing changes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "support/runs.hpp"

namespace poreshock::test {
namespace {

class SelfContactClosesTheEnergy : public ::testing::TestWithParam<std::vector<std::string>> {};

// Collapsing voids, walls that rub and that do not: every joule has a name.
TEST_P(SelfContactClosesTheEnergy, AndKeepsMomentum) {
  std::vector<std::string> settings = GetParam();
  settings.push_back("contact.self=true");
  Simulation<2> sim = start<2>(scene_of(porous_text(), settings), MPI_COMM_WORLD);
  const HistoryRow before = stock(sim);
  advance_to(200, 0, sim);
  const HistoryRow after = stock(sim);
  EXPECT_NEAR(after.total, before.total, 1e-12 * before.kinetic);
  for (std::size_t a = 0; a < 2; ++a) {
    EXPECT_NEAR(after.total_momentum[a], before.total_momentum[a],
                1e-13 * std::abs(before.momentum[1]));
  }
  EXPECT_GT(contact_row(sim).nodes, 0);
  EXPECT_EQ(after.contact_heat, 0.0);  // that is beside walls alone
  EXPECT_EQ(after.friction_heat > 1e-5 * before.kinetic, sim.scene.contact.friction > 0.0);
}

INSTANTIATE_TEST_SUITE_P(
    Schemes, SelfContactClosesTheEnergy,
    ::testing::Values(std::vector<std::string>{}, std::vector<std::string>{"contact.friction=0.3"},
                      std::vector<std::string>{"transfer.velocity=flip", "transfer.damping=0.2"},
                      std::vector<std::string>{"transfer.velocity=apic"},
                      std::vector<std::string>{"transfer.velocity=aflip"},
                      std::vector<std::string>{"thermal=paper", "transfer.shape=quadratic"}));

/// Largest difference of a column between two runs, particle by particle.
double largest_difference(const Simulation<2>& a, const Simulation<2>& b,
                          const std::vector<double>& of_a, const std::vector<double>& of_b) {
  std::map<std::int64_t, double> by_id;
  for (std::size_t p = 0; p < of_a.size(); ++p) by_id[a.particles.id[p]] = of_a[p];
  double largest = 0.0;
  for (std::size_t p = 0; p < of_b.size(); ++p) {
    largest = std::max(largest, std::abs(of_b[p] - by_id.at(b.particles.id[p])));
  }
  return largest;
}

void expect_the_same(const Simulation<2>& a, const Simulation<2>& b, double share) {
  const Particles<2>&p = a.particles, &q = b.particles;
  double speed = 0.0, pressure = 0.0;
  for (std::size_t i = 0; i < p.size(); ++i) {
    speed = std::max(speed, std::abs(p.velocity[1][i]));
    pressure = std::max(pressure, std::abs(p.pressure[i]));
  }
  for (int axis = 0; axis < 2; ++axis) {
    EXPECT_LE(largest_difference(a, b, p.velocity[axis], q.velocity[axis]), share * speed);
  }
  EXPECT_LE(largest_difference(a, b, p.pressure, q.pressure), share * pressure);
  EXPECT_LE(largest_difference(a, b, p.plastic_strain, q.plastic_strain), share);
  EXPECT_LE(largest_difference(a, b, p.internal_energy, q.internal_energy), share * speed * speed);
}

/// A block with a round void of 12 cells across in its middle that hits a wall.
std::string one_void_text() {
  return std::string(R"(
[domain]
size = [0.3e-3, 0.36e-3]
cell = 10e-6
periodic = true
[boundary]
low = "wall"
[[body]]
shape = "box"
low = [0.0, 0.0]
high = [0.3e-3, 0.3e-3]
[[void]]
shape = "disc"
center = [0.15e-3, 0.12e-3]
radius = 60e-6
[loading]
velocity = 300
[time]
end = 1e-6
)") + aluminium_text;
}

// Parts of a node that face the same way or away from each other move as one field: to rounding
// nothing changes, in the material, around the void, at its wall, at the rigid wall and at the top.
TEST(SelfContact, ChangesNothingWhereNothingCloses) {
  for (const std::vector<std::string>& scheme :
       {std::vector<std::string>{}, std::vector<std::string>{"transfer.velocity=flip"},
        std::vector<std::string>{"transfer.velocity=apic"}}) {
    Simulation<2> one = start<2>(scene_of(one_void_text(), scheme), MPI_COMM_SELF);
    std::vector<std::string> with = scheme;
    with.push_back("contact.self=true");
    Simulation<2> self = start<2>(scene_of(one_void_text(), with), MPI_COMM_SELF);
    advance_to(60, 0, one);
    advance_to(60, 0, self);
    expect_the_same(one, self, 1e-9);
    EXPECT_EQ(stock(self).contact_heat, 0.0);
  }
}

/// Two plates of 14 cells, 1.5 cells apart, the upper one thrown down and sideways.
std::string plates_text(int upper_grain) {
  return std::string(R"(
[domain]
size = [0.04e-3, 0.46e-3]
cell = 10e-6
periodic = true
[boundary]
low = "free"
[[body]]
shape = "box"
low = [0.0, 0.08e-3]
high = [0.04e-3, 0.22e-3]
[[body]]
shape = "box"
low = [0.0, 0.235e-3]
high = [0.04e-3, 0.375e-3]
velocity = [40.0, -100.0]
)") +
         "grain = " + std::to_string(upper_grain) +
         "\n[time]\nend = 2e-6\nsleep = false\n[contact]\nfriction = 0.1\n" + aluminium_text;
}

double gap_of_plates(const Simulation<2>& sim) {
  // The plates are told apart by the largest gap between two rows of particles.
  std::vector<double> heights = sim.particles.position[1];
  std::sort(heights.begin(), heights.end());
  double largest = 0.0;
  for (std::size_t i = 1; i < heights.size(); ++i) {
    largest = std::max(largest, heights[i] - heights[i - 1]);
  }
  return largest - 5e-6;
}

// A gap in one grain closes, rubs and opens as that between two grains does.
TEST(SelfContact, ClosesSlidesAndReopensAsTwoGrainsDo) {
  Simulation<2> two =
      start<2>(scene_of(plates_text(1), {"transfer.gradient=slopes"}), MPI_COMM_SELF);
  Simulation<2> self = start<2>(scene_of(plates_text(0), {"contact.self=true"}), MPI_COMM_SELF);
  double least = 1.0;
  while (self.clock.time < 0.4e-6) {
    advance_to(two.clock.step + 20, 0, two);
    advance_to(self.clock.step + 20, 0, self);
    least = std::min(least, gap_of_plates(self));
  }
  expect_the_same(two, self, 1e-9);
  EXPECT_LE(least, 0.2 * 10e-6);
  EXPECT_GT(gap_of_plates(self), 1.0 * 10e-6);
  EXPECT_GT(stock(self).friction_heat, 0.0);
  // Without, the plates weld and stay together; APIC damps how the weld swings.
  Simulation<2> welded =
      start<2>(scene_of(plates_text(0), {"transfer.velocity=apic"}), MPI_COMM_SELF);
  advance_to(self.clock.step, 0, welded);
  EXPECT_LT(gap_of_plates(welded), 1.55 * 10e-6);
}

TEST(SelfContact, OfSeveralGrainsIsRefused) {
  try {
    start<2>(scene_of(plates_text(1), {"contact.self=true"}), MPI_COMM_WORLD);
    FAIL() << "self-contact with two grains";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("contact.self: found true"), std::string::npos);
  }
}

}  // namespace
}  // namespace poreshock::test
