#include <gtest/gtest.h>

#include <functional>

#include "poreshock/core/error.hpp"
#include "poreshock/sample/fill.hpp"
#include "sample_scenes.hpp"

namespace poreshock {
namespace {

using testing::plane_scene;
using testing::space_scene;

/// Text of the InputError that the scene's voids end in; empty when there is none.
std::string error_of(const Scene& scene) {
  try {
    place_voids(scene);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

void expect_words(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    EXPECT_NE(text.find(word), std::string::npos) << "'" << word << "' not in: " << text;
  }
}

TEST(SampleErrors, TooDenseNamesTheFractionReachedAndTheLimits) {
  Scene scene = plane_scene(1e-3, 0.7);
  scene.sample.ligament = 10e-6;
  const std::string text = error_of(scene);
  expect_words(text, {"sample.porosity = 0.7 cannot be packed", "139 voids", "4e-05 m",
                      "sample.ligament = 1e-05 m", "void fraction of 0.", "0.84", "Lower",
                      "sample.overlap = true"});
  const std::string mark = "void fraction of ";
  const double reached = std::stod(text.substr(text.find(mark) + mark.size()));
  EXPECT_GT(reached, 0.5);
  EXPECT_LT(reached, 0.7);
}

TEST(SampleErrors, VoidsWithoutSizeOrWithoutEnd) {
  Scene scene = plane_scene(1e-3, 0.3);
  scene.sample.void_radius = 0.0;
  expect_words(error_of(scene), {"sample.void_radius = 0", "positive length in m"});
  scene.sample.void_radius = 1e-8;
  expect_words(error_of(scene),
               {"sample.void_radius = 1e-08 m", "at most 1e7", "Raise sample.void_radius"});
}

TEST(SampleErrors, NarrowBlocksAreNamed) {
  Scene scene = plane_scene(1e-3, 0.7);
  scene.sample.void_radius = 0.15e-3;
  scene.domain.periodic = {false, false};
  expect_words(error_of(scene), {"only 3.", "of the largest voids wide"});
}

TEST(SampleErrors, VoidsLargerThanTheBlock) {
  Scene scene = plane_scene(1e-3, 0.5);
  scene.sample.void_radius = 0.6e-3;
  expect_words(error_of(scene), {"0.0006 m", "0.0012 m", "the domain's width is 0.001 m",
                                 "Lower sample.void_radius"});
  scene.sample.void_radius = 0.45e-3;
  scene.sample.keep_out = 0.1e-3;
  expect_words(error_of(scene), {"sample.keep_out", "sample.height is 0.001 m"});
  scene.sample.keep_out = 0.0;
  scene.sample.ligament = 0.2e-3;
  expect_words(error_of(scene), {"its own image", "sample.ligament"});
}

TEST(SampleErrors, LessThanHalfAVoid) {
  Scene scene = plane_scene(1e-3, 0.001);
  expect_words(error_of(scene), {"sample.porosity = 0.001", "less than half a void",
                                 "makes 0.005027 of the block", "[[void]]"});
}

TEST(SampleErrors, FractionsOutOfRange) {
  expect_words(error_of(plane_scene(1e-3, 1.0)), {"sample.porosity = 1.", "from 0 to below 1"});
  expect_words(error_of(plane_scene(1e-3, -0.1)), {"sample.porosity = -0.1"});
  Scene scene = plane_scene(1e-3, 0.7);
  scene.sample.overlap = true;
  expect_words(error_of(scene), {"sample.overlap = true", "at most 0.65 in 2-D", "pieces"});
}

TEST(SampleErrors, KeepOutLeavesTooLittleForOverlappingVoids) {
  Scene scene = plane_scene(1e-3, 0.6);
  scene.sample.overlap = true;
  scene.sample.keep_out = 0.25e-3;
  expect_words(error_of(scene),
               {"cannot be reached", "sample.keep_out = 0.00025 m", "of the block", "Lower"});
}

TEST(SampleWarnings, NameTheKeyAndTheNumber) {
  Scene scene = plane_scene(1e-3, 0.2);
  scene.sample.ligament = 20e-6;
  SampleReport report;
  report.voids = place_voids(scene);
  report.least_gap = 20e-6;
  std::vector<std::string> warnings = sample_warnings(scene, report);
  ASSERT_EQ(warnings.size(), 2U);
  expect_words(warnings[0], {"8 cells across", "16", "domain.cell to 5e-06 m"});
  expect_words(warnings[1], {"2e-05 m", "2 cells", "below 3.5 cells", "cubic", "3.5e-05 m",
                             "domain.cell to 5.714e-06 m"});

  report.least_gap = 30e-6;
  scene.transfer.shape = ShapeFunction::quadratic;
  EXPECT_EQ(sample_warnings(scene, report).size(), 1U);
  report.least_gap = 10e-6;
  warnings = sample_warnings(scene, report);
  ASSERT_EQ(warnings.size(), 3U);
  expect_words(warnings[1], {"2 particles", "below 3", "1.5e-05 m", "domain.cell to 6.667e-06 m"});
  expect_words(warnings[2], {"1 cells", "below 2.5 cells", "quadratic"});

  scene = testing::refined(scene);
  report.least_gap = 20e-6;
  EXPECT_TRUE(sample_warnings(scene, report).empty());
  report.particles = 900;
  report.island_particles = 100;
  report.particle_void_fraction = 0.5;
  warnings = sample_warnings(scene, report);
  ASSERT_EQ(warnings.size(), 1U);
  expect_words(warnings[0], {"10 % of the particles", "0.5", "sample.seed"});
}

TEST(SampleWarnings, TellOfGrainsOfFewCells) {
  const Scene scene = plane_scene(1e-3, 0.2);
  SampleReport report;
  for (const double cells : {0.5, 4.0, 20.0}) {
    report.grains.push_back({.measure = std::pow(cells * scene.domain.cell, 2)});
  }
  const std::vector<std::string> warnings = sample_warnings(scene, report);
  ASSERT_EQ(warnings.size(), 2U);
  expect_words(warnings[0], {"1 of 3 grains", "smaller than a cell", "domain.cell to 5e-06 m"});
  expect_words(warnings[1], {"1 of 3 grains", "less than 8 cells", "domain.cell to 5e-06 m"});
}

TEST(SampleWarnings, TellWhenFewVoidsChangeTheRadius) {
  const Scene scene = testing::refined(plane_scene(1e-3, 0.012));
  SampleReport report;
  report.voids = place_voids(scene);
  report.least_gap = 1e-3;
  ASSERT_EQ(report.voids.size(), 2U);
  const std::vector<std::string> warnings = sample_warnings(scene, report);
  ASSERT_EQ(warnings.size(), 1U);
  expect_words(warnings[0], {"4.37e-05 m instead of 4e-05 m", "2 whole voids"});
}

}  // namespace
}  // namespace poreshock
