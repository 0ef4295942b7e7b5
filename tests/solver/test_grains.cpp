// Whole steps with grains: energy and momentum, one field against several, what cannot be.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "support/runs.hpp"

namespace poreshock::test {
namespace {

class GrainsCloseTheEnergy : public ::testing::TestWithParam<std::vector<std::string>> {};

// Impact, friction, walls that rub, more than two grains at a node: every joule has a name.
TEST_P(GrainsCloseTheEnergy, AndKeepMomentum) {
  Simulation<2> sim = start<2>(scene_of(grains_text(), GetParam()), MPI_COMM_WORLD);
  const HistoryRow before = stock(sim);
  advance_to(150, 0, sim);
  const HistoryRow after = stock(sim);
  EXPECT_NEAR(after.total, before.total, 1e-12 * before.kinetic);
  EXPECT_LT(std::abs(unnamed_energy(before, after)), 1e-12 * before.kinetic);
  for (std::size_t a = 0; a < 2; ++a) {
    EXPECT_NEAR(after.total_momentum[a], before.total_momentum[a],
                1e-13 * std::abs(before.momentum[1]));
  }
  EXPECT_GT(after.contact_heat, 0.0);  // beside the wall alone
  EXPECT_LT(after.contact_heat, 0.1 * before.kinetic);
  const bool rubs = sim.scene.contact.friction > 0.0;
  EXPECT_EQ(after.friction_heat > 1e-3 * before.kinetic, rubs) << after.friction_heat;
}

INSTANTIATE_TEST_SUITE_P(
    Schemes, GrainsCloseTheEnergy,
    ::testing::Values(std::vector<std::string>{}, std::vector<std::string>{"contact.friction=0.0"},
                      std::vector<std::string>{"contact.friction=1e30",
                                               "boundary.low={kind='wall', friction=0.4}"},
                      std::vector<std::string>{"contact.gap=none", "viscosity.limited=false"},
                      std::vector<std::string>{"contact.normal=regression"},
                      std::vector<std::string>{"transfer.gradient=moments"},
                      std::vector<std::string>{"transfer.velocity=flip", "transfer.damping=0.2"},
                      std::vector<std::string>{"transfer.velocity=apic"},
                      std::vector<std::string>{"transfer.velocity=aflip"},
                      std::vector<std::string>{"thermal=paper", "transfer.shape=quadratic"}));

/// Two boxes, one on the other, that hit a wall; both are grain 0, or the upper one is grain 1.
std::string stacked_text(int upper_grain, double gap) {
  const std::string from = std::to_string(145.0 + gap) + "e-6";
  const std::string to = std::to_string(320.0 + gap) + "e-6";
  return std::string(R"(
[domain]
size = [0.08e-3, 0.48e-3]
cell = 10e-6
periodic = true
[boundary]
low = "wall"
high = "free"
[[body]]
shape = "box"
low = [0.0, 0.0]
high = [0.08e-3, 0.145e-3]
[[body]]
shape = "box"
low = [0.0, )") +
         from + "]\nhigh = [0.08e-3, " + to + "]\ngrain = " + std::to_string(upper_grain) + R"(
[loading]
velocity = 500
[contact]
friction = 1e30
gap = "none"
[time]
end = 1e-6
)" + aluminium_text;
}

double largest_difference(const std::vector<double>& a, const std::vector<double>& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) largest = std::max(largest, std::abs(a[i] - b[i]));
  return largest;
}

/// Columns in the order of the ids.
std::vector<double> by_id(const Particles<2>& particles, const std::vector<double>& column) {
  std::vector<double> sorted(column.size());
  std::vector<std::size_t> order(column.size());
  for (std::size_t p = 0; p < order.size(); ++p) order[p] = p;
  std::sort(order.begin(), order.end(),
            [&](std::size_t p, std::size_t q) { return particles.id[p] < particles.id[q]; });
  for (std::size_t p = 0; p < order.size(); ++p) sorted[p] = column[order[p]];
  return sorted;
}

/// Particles of two boxes of one grain and of two, to 1e-12. Returns the largest pressure, Pa.
double expect_one_field(const Simulation<2>& one, const Simulation<2>& two) {
  const auto difference = [&](const std::vector<double>& a, const std::vector<double>& b) {
    return largest_difference(by_id(one.particles, a), by_id(two.particles, b));
  };
  for (int a = 0; a < 2; ++a) {
    EXPECT_LE(difference(one.particles.velocity[a], two.particles.velocity[a]), 1e-12 * 500.0);
    EXPECT_LE(difference(one.particles.position[a], two.particles.position[a]), 1e-12 * 0.48e-3);
  }
  const double most =
      *std::max_element(one.particles.pressure.begin(), one.particles.pressure.end());
  EXPECT_LE(difference(one.particles.pressure, two.particles.pressure), 1e-12 * most);
  EXPECT_LE(difference(one.particles.plastic_strain, two.particles.plastic_strain), 1e-12);
  return most;
}

// Infinite friction and no gap test in a compression wave: two fields move as one does. With PIC,
// as nothing but the new nodal velocity moves particles then; in paper mode, as pressure does not
// know where within a node heat arises.
TEST(Grains, StickAsOneField) {
  const std::vector<std::string> scheme = {"transfer.velocity=pic", "transfer.gradient=slopes",
                                           "thermal=paper"};
  Simulation<2> one = start<2>(scene_of(stacked_text(0, 0.0), scheme), MPI_COMM_SELF);
  Simulation<2> two = start<2>(scene_of(stacked_text(1, 0.0), scheme), MPI_COMM_SELF);
  ASSERT_EQ(one.grain_fields.grains, 0);
  ASSERT_EQ(two.grain_fields.grains, 2);
  advance_to(120, 0, one);
  advance_to(120, 0, two);
  ASSERT_EQ(two.grid->fields(), 2);
  EXPECT_GT(expect_one_field(one, two), 5e9);
}

// One grain holds nothing for contact.
TEST(Grains, OfOneNumberHoldNoMemory) {
  Simulation<2> sim = start<2>(scene_of(porous_text()), MPI_COMM_WORLD);
  advance_to(20, 7, sim);
  const GrainFields& all = sim.grain_fields;
  EXPECT_FALSE(all.faces.has_value());
  EXPECT_EQ(all.surfaces, nullptr);
  EXPECT_EQ(all.colours.capacity() + all.shared.capacity() + all.sides.capacity(), 0U);
  EXPECT_EQ(sim.cells.part.capacity() + sim.cells.field.capacity(), 0U);
  for (const auto& column : sim.particles.facing) EXPECT_EQ(column.capacity(), 0U);
}

/// Stores particles in the order of their ids: with one field, what sleeps may rest elsewhere.
void sort_by_id(Particles<2>& particles) {
  std::vector<std::uint32_t> order(particles.size());
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(),
            [&](std::uint32_t a, std::uint32_t b) { return particles.id[a] < particles.id[b]; });
  reorder(order, particles);
}

// Grains too far apart to share a node have one colour, and then the bits are those of one field.
TEST(Grains, FarApartAreOneFieldBitForBit) {
  const std::vector<std::string> scheme = {"transfer.gradient=moments"};
  Simulation<2> one = start<2>(scene_of(stacked_text(0, 80.0), scheme), MPI_COMM_SELF);
  Simulation<2> two = start<2>(scene_of(stacked_text(1, 80.0), scheme), MPI_COMM_SELF);
  advance_to(60, 0, one);
  advance_to(60, 0, two);
  EXPECT_EQ(two.grid->fields(), 1);
  EXPECT_EQ(two.grain_fields.surfaces, nullptr);
  sort_by_id(one.particles);
  sort_by_id(two.particles);
  for_each_column(one.particles, [&](std::string_view name, int component, const auto& column) {
    if (name == "grain") return;
    for_each_column(two.particles, [&](std::string_view other, int k, const auto& twin) {
      if constexpr (std::is_same_v<decltype(column), decltype(twin)>) {
        if (name != other || component != k) return;
        EXPECT_EQ(column, twin) << name << component;
      }
    });
  });
}

// A box that is thrown after a slower one meets it only when their faces touch, and both then move
// on with one velocity; before, not even nodes that see both change anything.
TEST(Grains, MeetWhenTheirFacesTouch) {
  std::string text = stacked_text(1, 20.0);
  text.replace(text.find("low = \"wall\""), 12, "low = \"free\"");
  text.replace(text.find("grain = 1"), 9, "grain = 1\nvelocity = [0.0, -50.0]");
  text.replace(text.find("gap = \"none\""), 12, "gap = \"volume\"");
  text.replace(text.find("velocity = 500"), 14, "velocity = 0");
  Simulation<2> sim = start<2>(scene_of(text, {"output.beat=10e-9"}), MPI_COMM_SELF);
  const auto gap = [&] {
    double top = 0.0, bottom = 1.0;
    for (std::size_t p = 0; p < sim.particles.size(); ++p) {
      const double y = sim.particles.position[1][p];
      if (sim.particles.grain[p] == 0) top = std::max(top, y);
      if (sim.particles.grain[p] == 1) bottom = std::min(bottom, y);
    }
    return (bottom - top - 5e-6) / 10e-6;
  };
  double met_at = -1.0;
  while (met_at < 0.0 && sim.clock.step < 5000) {
    const double before = gap();
    advance_to(sim.clock.step + 1, 0, sim);
    double fastest = 0.0;
    for (std::size_t p = 0; p < sim.particles.size(); ++p) {
      if (sim.particles.grain[p] == 0) {
        fastest = std::max(fastest, std::abs(sim.particles.velocity[1][p]));
      }
    }
    if (fastest > 0.05) met_at = before;
  }
  EXPECT_GE(met_at, 0.0);
  EXPECT_LE(met_at, 0.2);
  EXPECT_LE(gap(), 0.2);
}

// Grains of one particle, thrown at a large one and at each other: they carry their momentum, and
// nothing becomes NaN.
TEST(Grains, OfOneParticleCarryMomentum) {
  std::string text = R"(
[domain]
size = [0.2e-3, 0.2e-3]
cell = 10e-6
[boundary]
low = "free"
high = "free"
[[body]]
shape = "box"
low = [50e-6, 50e-6]
high = [150e-6, 90e-6]
grain = 1
[contact]
friction = 0.3
[time]
end = 1e-6
)";
  for (int g = 0; g < 5; ++g) {
    const int x = 61 + 20 * g;
    text += "[[body]]\nshape = \"box\"\nlow = [" + std::to_string(x) + "e-6, " +
            std::to_string(121 + 10 * (g % 2)) + "e-6]\nhigh = [" + std::to_string(x + 3) +
            "e-6, " + std::to_string(124 + 10 * (g % 2)) +
            "e-6]\ngrain = " + std::to_string(g + 2) + "\nvelocity = [" +
            std::to_string(50 - 25 * g) + ".0, -500.0]\n";
  }
  Simulation<2> sim = start<2>(scene_of(text + aluminium_text), MPI_COMM_WORLD);
  const HistoryRow before = stock(sim);
  ASSERT_EQ(before.particles, 8 * 20 + 5);
  advance_to(400, 0, sim);
  const HistoryRow after = stock(sim);
  EXPECT_EQ(after.particles, before.particles);
  for (std::size_t a = 0; a < 2; ++a) {
    EXPECT_NEAR(after.momentum[a], before.momentum[a], 1e-12 * std::abs(before.momentum[1]));
  }
  EXPECT_NEAR(after.total, before.total, 1e-12 * before.total);
  double large = 0.0;
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    if (sim.particles.grain[p] == 1) large += sim.particles.mass[p] * sim.particles.velocity[1][p];
  }
  MPI_Allreduce(MPI_IN_PLACE, &large, 1, MPI_DOUBLE, MPI_SUM, MPI_COMM_WORLD);
  EXPECT_LT(large, 0.5 * before.momentum[1]);  // it has taken most of theirs
}

}  // namespace
}  // namespace poreshock::test
