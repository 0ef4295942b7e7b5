// Runs in which nothing can happen, or from which the material flies off, are told before the
// start.
#include "poreshock/run/start_warnings.hpp"

#include <gtest/gtest.h>

#include "support/runs.hpp"

namespace poreshock::test {
namespace {

/// Two plates in a domain of 0.2 x 0.6 mm; the upper one begins 20 um above the lower one.
std::string plates_text(const std::string& lower_velocity, const std::string& upper_velocity) {
  return std::string(R"(
[domain]
size = [0.2e-3, 0.6e-3]
cell = 10e-6
[[body]]
shape = "box"
low = [0.05e-3, 0.2e-3]
high = [0.15e-3, 0.3e-3]
grain = 1
velocity = [)") +
         lower_velocity + R"(]
[[body]]
shape = "box"
low = [0.05e-3, 0.32e-3]
high = [0.15e-3, 0.42e-3]
grain = 2
velocity = [)" +
         upper_velocity + R"(]
[time]
end = 100e-9
)" + aluminium_text;
}

std::vector<std::string> warnings_of(const std::string& text,
                                     const std::vector<std::string>& changes = {}) {
  const Scene scene = scene_of(text, changes);
  return scene.dimension == 2 ? motion_warnings(start<2>(scene, MPI_COMM_WORLD))
                              : motion_warnings(start<3>(scene, MPI_COMM_WORLD));
}

void expect_words(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    EXPECT_NE(text.find(word), std::string::npos) << "'" << word << "' not in: " << text;
  }
}

TEST(StartWarnings, ImpactsHaveNone) {
  EXPECT_TRUE(warnings_of(porous_text()).empty());
  EXPECT_TRUE(warnings_of(grains_text()).empty());
  EXPECT_TRUE(warnings_of(plates_text("0, 0", "0, -500")).empty());
  EXPECT_TRUE(warnings_of(plates_text("0, 300", "0, 0")).empty());
  // A wall that moves into material at rest, and both in a frame of their own.
  EXPECT_TRUE(warnings_of(porous_text(),
                          {"loading.velocity=0", "boundary.low={kind='wall', velocity=1100}"})
                  .empty());
  EXPECT_TRUE(warnings_of(porous_text(), {"loading.frame=[0, 300]"}).empty());
}

TEST(StartWarnings, NothingToHit) {
  const std::vector<std::string> apart = warnings_of(plates_text("0, 0", "0, 500"));
  ASSERT_EQ(apart.size(), 1U);
  expect_words(apart[0],
               {"Nothing is hit until time.end = 1e-07 s: no wall, symmetry plane or body",
                "boundary.low = \"wall\""});
  EXPECT_EQ(warnings_of(plates_text("0, -100", "0, -100")).size(), 1U);
  EXPECT_EQ(warnings_of(plates_text("0, 0", "0, 0")).size(), 1U);
  EXPECT_EQ(warnings_of(plates_text("0, 0", "100, -10")).size(), 1U);  // too late
  const std::vector<std::string> late = warnings_of(plates_text("0, 0", "0, -100"));
  ASSERT_EQ(late.size(), 1U);
  expect_words(late[0], {"the first impact comes at 2e-07 s", "Raise time.end"});
  EXPECT_TRUE(warnings_of(plates_text("0, 0", "0, -100"), {"time.end=300e-9"}).empty());
  // Side by side they never meet, around the domain they do.
  const std::vector<std::string> beside = {"body.1.low=[0.16e-3, 0.2e-3]",
                                           "body.1.high=[0.19e-3, 0.3e-3]",
                                           "body.0.high=[0.1e-3, 0.3e-3]"};
  std::vector<std::string> around = beside;
  around.emplace_back("domain.periodic=true");
  EXPECT_EQ(warnings_of(plates_text("0, 0", "900, 0"), beside).size(), 1U);
  EXPECT_TRUE(warnings_of(plates_text("0, 0", "900, 0"), around).empty());
  // What goes on by itself needs no impact.
  EXPECT_TRUE(warnings_of(plates_text("0, 0", "0, 0"), {"body.0.spin=1e6"}).empty());
  EXPECT_TRUE(
      warnings_of(plates_text("0, 0", "0, 0"), {"body_force.acceleration=[0, -10]"}).empty());
}

TEST(StartWarnings, MaterialThatLeavesAtOnce) {
  const std::vector<std::string> fallen = warnings_of(porous_text(), {"boundary.low=free"});
  ASSERT_EQ(fallen.size(), 2U);
  expect_words(fallen[0], {" %) leave the domain within the first 20 steps",
                           "through the open side boundary.low", "\"wall\" or \"symmetry\""});
  expect_words(fallen[1], {"Nothing is hit"});
  const std::vector<std::string> up = {"boundary.high=free", "body.1.high=[0.15e-3, 0.6e-3]",
                                       "boundary.low=wall", "body.0.velocity=[0, -2000]"};
  const std::vector<std::string> risen = warnings_of(plates_text("0, 0", "0, 900"), up);
  ASSERT_EQ(risen.size(), 2U);
  expect_words(risen[0], {"boundary.high"});
  const std::vector<std::string> aside = {"body.1.high=[0.2e-3, 0.42e-3]"};
  expect_words(warnings_of(plates_text("0, 0", "900, -500"), aside).at(0),
               {"boundary.lateral (high x)", "Set boundary.lateral = "});
  // Nobody leaves where the side turns with it, or where the grid rides along.
  EXPECT_TRUE(
      warnings_of(plates_text("0, 0", "900, -500"), {aside[0], "boundary.lateral=wall"}).empty());
}

TEST(StartWarnings, InThreeDimensions) {
  const std::string ball = std::string(R"(
[domain]
size = [0.1e-3, 0.1e-3, 0.2e-3]
cell = 10e-6
periodic = true
[boundary]
low = "free"
[[body]]
shape = "ball"
center = [50e-6, 50e-6, 45e-6]
radius = 43e-6
velocity = [0, 0, -1500]
[time]
end = 50e-9
)") + aluminium_text;
  const std::vector<std::string> found = warnings_of(ball);
  ASSERT_EQ(found.size(), 2U);
  expect_words(found[0], {"boundary.low"});
  EXPECT_TRUE(warnings_of(ball, {"boundary.low=wall"}).empty());
}

TEST(StartWarnings, GrainsThatTakeNearlyAllFields) {
  // Balls of four cells whose neighbours need eleven fields at the start and more when they meet.
  const std::string bed = std::string(R"(
[domain]
size = [0.1e-3, 0.1e-3, 0.2e-3]
cell = 10e-6
periodic = [true, false]
[boundary]
low = "wall"
lateral = "symmetry"
[sample]
kind = "packed_grains"
height = 0.15e-3
grain_radius = 20e-6
porosity = 0.52
[loading]
velocity = 800
[time]
end = 20e-9
)") + aluminium_text;
  const std::vector<std::string> found = warnings_of(bed);
  ASSERT_EQ(found.size(), 1U);
  expect_words(found[0], {"The grains take 11 of the 12 velocity fields", "exit code 3"});
  EXPECT_TRUE(warnings_of(bed, {"sample.porosity=0.8"}).empty());
}

}  // namespace
}  // namespace poreshock::test
