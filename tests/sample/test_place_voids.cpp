#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "poreshock/sample/fill.hpp"
#include "sample/block.hpp"
#include "sample_scenes.hpp"

namespace poreshock {
namespace {

using testing::plane_scene;
using testing::refined;
using testing::space_scene;

double summed_fraction(const std::vector<Void>& voids, const Scene& scene) {
  return summed_measure(voids, scene.dimension) / block_measure(sample_block(scene));
}

void expect_inside(const std::vector<Void>& voids, const Scene& scene) {
  const Block block = sample_block(scene);
  for (const Void& v : voids) {
    for (int axis = 0; axis < block.dimension; ++axis) {
      const double margin = block.periodic[axis] ? 0.0 : scene.sample.keep_out + v.radius;
      EXPECT_GE(v.center[axis], margin);
      EXPECT_LE(v.center[axis], block.size[axis] - margin);
    }
  }
}

bool same_bits(const std::vector<Void>& a, const std::vector<Void>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const Void& p, const Void& q) {
    return p.center == q.center && p.radius == q.radius;
  });
}

TEST(PlaceVoids, LowPorosityOfThePaperMeetsItsTarget) {
  const Scene scene = plane_scene(5e-3, 0.077);
  const std::vector<Void> voids = place_voids(scene);
  ASSERT_EQ(voids.size(), 77U);
  EXPECT_NEAR(summed_fraction(voids, scene), 0.077, 1e-15);
  EXPECT_NEAR(voids.front().radius, 40e-6, 0.01 * 40e-6);
  EXPECT_GE(least_gap(voids, sample_block(scene)), 0.0);
  expect_inside(voids, scene);
}

TEST(PlaceVoids, HighPorosityKeepsLigamentAndKeepOut) {
  Scene scene = plane_scene(5e-3, 0.46);
  scene.sample.ligament = 4e-6;
  scene.sample.keep_out = 20e-6;
  const std::vector<Void> voids = place_voids(scene);
  EXPECT_NEAR(void_fraction(voids, scene), 0.46, 1e-14);
  EXPECT_GE(least_gap(voids, sample_block(scene)), 4e-6 * (1.0 - 1e-9));
  expect_inside(voids, scene);
}

TEST(PlaceVoids, PacksEqualDiscsBeyondRandomSequentialAddition) {
  for (const double porosity : {0.50, 0.60, 0.70}) {
    const Scene scene = plane_scene(2e-3, porosity);
    const std::vector<Void> voids = place_voids(scene);
    EXPECT_NEAR(summed_fraction(voids, scene), porosity, 1e-14);
    // Distances are compared as squares: rounding leaves a few parts in 1e16.
    EXPECT_GE(least_gap(voids, sample_block(scene)), -1e-15 * 80e-6);
    expect_inside(voids, scene);
  }
}

TEST(PlaceVoids, ClosedSidesKeepVoidsInside) {
  Scene scene = plane_scene(2e-3, 0.45);
  scene.domain.periodic = {false, false};
  scene.sample.keep_out = 5e-6;
  const std::vector<Void> voids = place_voids(scene);
  EXPECT_NEAR(summed_fraction(voids, scene), 0.45, 1e-14);
  expect_inside(voids, scene);
}

TEST(PlaceVoids, IsTheSameAtEveryResolutionBitForBit) {
  for (const bool overlap : {false, true}) {
    for (const double porosity : {0.2, 0.5}) {
      Scene scene = plane_scene(2.5e-3, porosity);
      scene.sample.overlap = overlap;
      Scene fine = refined(scene);
      fine.sample.particles_per_cell = 3;
      const std::vector<Void> voids = place_voids(scene);
      EXPECT_TRUE(same_bits(voids, place_voids(fine)));
      EXPECT_TRUE(same_bits(voids, place_voids(scene)));
      scene.sample.seed = 8;
      EXPECT_FALSE(same_bits(voids, place_voids(scene)));
    }
  }
}

TEST(PlaceVoids, ScalingTheSceneByAPowerOfTwoScalesTheVoids) {
  Scene scene = plane_scene(1.5e-3, 0.55);
  scene.sample.ligament = 1e-6;
  std::vector<Void> voids = place_voids(scene);
  for (double& length : scene.domain.size) length *= 1024.0;
  scene.domain.cell *= 1024.0;
  scene.sample.height *= 1024.0;
  scene.sample.void_radius *= 1024.0;
  scene.sample.ligament *= 1024.0;
  for (Void& v : voids) {
    v.radius *= 1024.0;
    for (double& c : v.center) c *= 1024.0;
  }
  EXPECT_TRUE(same_bits(voids, place_voids(scene)));
}

TEST(PlaceVoids, LogNormalRadiiHaveTheirStatistics) {
  Scene scene = plane_scene(40e-3, 0.3);
  scene.sample.void_spread = 0.3;
  const std::vector<Void> voids = place_voids(scene);
  EXPECT_NEAR(summed_fraction(voids, scene), 0.3, 1e-13);
  EXPECT_GE(least_gap(voids, sample_block(scene)), -1e-15 * 80e-6);
  const double n = static_cast<double>(voids.size());
  ASSERT_GT(n, 1500.0);
  double sum = 0.0, squares = 0.0, largest = 0.0;
  for (const Void& v : voids) {
    const double z = std::log(v.radius / 40e-6) / 0.3;
    sum += z;
    squares += z * z;
    largest = std::max(largest, std::fabs(z));
  }
  // Variance of a normal number cut at 2.5 standard deviations.
  const double variance = 0.911257;
  EXPECT_LT(largest, 2.51);
  EXPECT_NEAR(sum / n, 0.0, 4.0 * std::sqrt(variance / n));
  EXPECT_NEAR(squares / n, variance, 4.0 * std::sqrt(2.0 / n));
}

TEST(PlaceVoids, OverlappingVoidsMeetTheTargetAsAUnion) {
  for (const double porosity : {0.1, 0.4, 0.65}) {
    Scene scene = plane_scene(5e-3, porosity);
    scene.sample.overlap = true;
    const std::vector<Void> voids = place_voids(scene);
    EXPECT_NEAR(void_fraction(voids, scene), porosity, 1e-12);
    EXPECT_GT(summed_fraction(voids, scene), porosity);
    EXPECT_NEAR(voids.front().radius, 40e-6, 0.01 * 40e-6);
    expect_inside(voids, scene);
    // Boolean model: -ln(1 - f) of the part between the edges tells the number of voids.
    const double expected = -std::log1p(-porosity) * 5e-6 / (std::numbers::pi * 1.6e-9);
    EXPECT_NEAR(static_cast<double>(voids.size()), expected, 4.0 * std::sqrt(expected) + 20.0);
  }
}

TEST(PlaceVoids, BallsKeepTheirDistance) {
  Scene scene = space_scene(0.6e-3, 0.35);
  scene.sample.ligament = 2e-6;
  scene.sample.keep_out = 3e-6;
  const std::vector<Void> voids = place_voids(scene);
  EXPECT_EQ(voids.size(), 125U);  // 0.35 x 0.096 mm^3 over 2.681e-4 mm^3 a ball
  EXPECT_NEAR(void_fraction(voids, scene), 0.35, 1e-14);
  EXPECT_GE(least_gap(voids, sample_block(scene)), 2e-6 * (1.0 - 1e-9));
  expect_inside(voids, scene);
}

TEST(PlaceVoids, OverlappingBallsMeetTheTarget) {
  Scene scene = space_scene(0.6e-3, 0.6);
  scene.sample.overlap = true;
  const std::vector<Void> voids = place_voids(scene);
  EXPECT_NEAR(void_fraction(voids, scene), 0.6, 1e-6);
  expect_inside(voids, scene);
}

TEST(PlaceVoids, CopesWithAHundredThousandVoids) {
  Scene scene = plane_scene(1e-3, 0.5);
  scene.sample.void_radius = 1e-3 * std::sqrt(0.5 / (std::numbers::pi * 1e5));
  const std::vector<Void> voids = place_voids(scene);
  EXPECT_EQ(voids.size(), 100000U);
  EXPECT_NEAR(summed_fraction(voids, scene), 0.5, 1e-12);
  EXPECT_GE(least_gap(voids, sample_block(scene)), -1e-15 * scene.sample.void_radius);
  expect_inside(voids, scene);
}

TEST(PlaceVoids, NoPorosityMeansNoVoids) {
  EXPECT_TRUE(place_voids(plane_scene(1e-3, 0.0)).empty());
  Scene solid = plane_scene(1e-3, 0.3);
  solid.sample.kind = SampleKind::solid;
  EXPECT_TRUE(place_voids(solid).empty());
}

}  // namespace
}  // namespace poreshock
