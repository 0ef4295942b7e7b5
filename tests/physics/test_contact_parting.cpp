// Two grains at a node that forces pull apart while the residuals of their particles still close.
#include <gtest/gtest.h>

#include <vector>

#include "poreshock/physics/contact.hpp"

namespace {

using namespace poreshock;

constexpr double cell = 1e-5;

/// Two grains that fill `share` of a node, with their face across y. They close at 10 m/s before
/// the step, after it at `closing`.
std::vector<NodeGrain<2>> grains_of(double closing, double share) {
  std::vector<NodeGrain<2>> grains(2);
  for (int g = 0; g < 2; ++g) {
    const double up = g == 0 ? 1.0 : -1.0;
    NodeGrain<2>& grain = grains[static_cast<std::size_t>(g)];
    grain.mass = 1e-6;
    grain.start = {0.0, 5.0 * up};
    grain.end = {0.0, 0.5 * closing * up};
    grain.volume = 0.5 * share * cell * cell;
    grain.gradient = {0.0, 2.0 / 3.0 * cell * up};
    grain.place = {0.0, -0.4 * cell * up};
  }
  return grains;
}

int pairs_of(std::vector<NodeGrain<2>>& grains) {
  const FaceTable faces{Transfer{}};
  return resolve_contact<2>(grains, {.cell = cell, .kept = 0.9, .capacity = cell * cell}, faces)
      .pairs;
}

// Of the 10 m/s the particles keep 9, so that a tie would pull them if less than 9 m/s closed.
TEST(Parting, TwoGrainsPartBeforeATiePullsTheirParticles) {
  auto grains = grains_of(2.0, 1.0);
  const auto before = grains;
  EXPECT_EQ(pairs_of(grains), 0);
  for (std::size_t g = 0; g < grains.size(); ++g) {
    EXPECT_EQ(grains[g].start[1], before[g].start[1]);
    EXPECT_EQ(grains[g].end[1], before[g].end[1]);
  }
}

TEST(Parting, TheyStayTiedWhileTheirParticlesArePushed) {
  auto grains = grains_of(9.5, 1.0);
  EXPECT_EQ(pairs_of(grains), 1);
  EXPECT_NEAR(grains[1].end[1] - grains[0].end[1], 0.0, 1e-14);
}

TEST(Parting, TheyStayTiedWhereTheyOverlap) {
  auto grains = grains_of(2.0, 1.01);
  EXPECT_EQ(pairs_of(grains), 1);
}

}  // namespace
