#include <gtest/gtest.h>

#include <numbers>

#include "poreshock/core/error.hpp"
#include "poreshock/sample/bodies.hpp"

namespace poreshock {
namespace {

constexpr double pi = std::numbers::pi;

Region make_region(BodyShape shape) {
  Region region;
  region.shape = shape;
  region.center = {1.0, 2.0, 3.0};
  region.radius = 0.5;
  region.inner_radius = 0.25;
  region.low = {0.0, 1.0, 2.0};
  region.high = {2.0, 4.0, 6.0};
  return region;
}

TEST(Bodies, DiscIsClosedAndIgnoresTheThirdCoordinateIn2D) {
  const Region disc = make_region(BodyShape::disc);
  EXPECT_TRUE(contains(disc, {1.5, 2.0, 99.0}, 2));
  EXPECT_FALSE(contains(disc, {1.5, 2.0, 99.0}, 3));
  EXPECT_FALSE(contains(disc, {1.5000000001, 2.0, 3.0}, 3));
  EXPECT_DOUBLE_EQ(measure(disc, 2), pi / 4.0);
  EXPECT_DOUBLE_EQ(measure(disc, 3), pi / 6.0);
  EXPECT_EQ(centroid(disc, 3), (Triple{1.0, 2.0, 3.0}));
}

TEST(Bodies, RingHasAHole) {
  const Region ring = make_region(BodyShape::ring);
  EXPECT_FALSE(contains(ring, {1.0, 2.0, 3.0}, 2));
  EXPECT_TRUE(contains(ring, {1.25, 2.0, 3.0}, 2));
  EXPECT_TRUE(contains(ring, {1.0, 2.5, 3.0}, 3));
  EXPECT_FALSE(contains(ring, {1.0, 2.51, 3.0}, 2));
  EXPECT_DOUBLE_EQ(measure(ring, 2), pi * (0.25 - 0.0625));
  EXPECT_DOUBLE_EQ(measure(ring, 3), 4.0 / 3.0 * pi * (0.125 - 0.015625));
}

TEST(Bodies, BoxCountsTheAxesInUse) {
  const Region box = make_region(BodyShape::box);
  EXPECT_TRUE(contains(box, {0.0, 4.0, -7.0}, 2));
  EXPECT_FALSE(contains(box, {0.0, 4.0, -7.0}, 3));
  EXPECT_FALSE(contains(box, {-1e-12, 2.0, 3.0}, 3));
  EXPECT_DOUBLE_EQ(measure(box, 2), 6.0);
  EXPECT_DOUBLE_EQ(measure(box, 3), 24.0);
  EXPECT_EQ(centroid(box, 3), (Triple{1.0, 2.5, 4.0}));
}

TEST(Bodies, ConcavePolygonFollowsTheEvenOddRule) {
  Region polygon;
  polygon.shape = BodyShape::polygon;
  // An L of three unit squares, clockwise.
  polygon.points = {{0, 0, 0}, {0, 2, 0}, {1, 2, 0}, {1, 1, 0}, {2, 1, 0}, {2, 0, 0}};
  EXPECT_TRUE(contains(polygon, {0.5, 1.5, 0}, 2));
  EXPECT_TRUE(contains(polygon, {1.5, 0.5, 0}, 2));
  EXPECT_FALSE(contains(polygon, {1.5, 1.5, 0}, 2));
  EXPECT_FALSE(contains(polygon, {-0.5, 1.0, 0}, 2));
  EXPECT_TRUE(contains(polygon, {0.5, 1.0, 0}, 2));
  for (const Triple& corner : polygon.points) EXPECT_TRUE(contains(polygon, corner, 2));
  EXPECT_TRUE(contains(polygon, {1.0, 1.5, 0}, 2));
  EXPECT_DOUBLE_EQ(measure(polygon, 2), 3.0);
  const Triple middle = centroid(polygon, 2);
  EXPECT_DOUBLE_EQ(middle[0], 5.0 / 6.0);
  EXPECT_DOUBLE_EQ(middle[1], 5.0 / 6.0);
  EXPECT_THROW(measure(polygon, 3), InputError);
}

TEST(Bodies, LyingWithinLeavesOutWhatIsNearTheSurface) {
  const Region disc = make_region(BodyShape::disc), ring = make_region(BodyShape::ring);
  const Region box = make_region(BodyShape::box);
  EXPECT_TRUE(lies_within(disc, {1.48, 2.0, 9.0}, 0.01, 2));
  EXPECT_FALSE(lies_within(disc, {1.495, 2.0, 9.0}, 0.01, 2));
  EXPECT_FALSE(lies_within(disc, {1.48, 2.0, 9.0}, 0.01, 3));
  EXPECT_TRUE(lies_within(ring, {1.27, 2.0, 3.0}, 0.01, 3));
  EXPECT_FALSE(lies_within(ring, {1.255, 2.0, 3.0}, 0.01, 3));
  EXPECT_FALSE(lies_within(box, {0.005, 2.0, 3.0}, 0.01, 3));
  EXPECT_FALSE(lies_within(box, {1.0, 3.995, 3.0}, 0.01, 3));
  EXPECT_TRUE(lies_within(box, {0.02, 3.98, 2.02}, 0.01, 3));
  Region polygon;
  polygon.shape = BodyShape::polygon;
  polygon.points = {{0, 0, 0}, {2, 0, 0}, {0, 2, 0}};
  EXPECT_FALSE(lies_within(polygon, {1.0, 1.0, 0}, 1e-9, 2));
  EXPECT_FALSE(lies_within(polygon, {0.995, 0.995, 0}, 0.01, 2));
  EXPECT_TRUE(lies_within(polygon, {0.98, 0.98, 0}, 0.01, 2));
  EXPECT_FALSE(lies_within(polygon, {1.01, 1.01, 0}, 0.01, 2));
  EXPECT_FALSE(lies_within(polygon, {1.01, 1.01, 0}, -0.01, 2));
  EXPECT_TRUE(lies_within(polygon, {1.005, 1.005, 0}, -0.01, 2));
  EXPECT_TRUE(lies_within(polygon, {0.5, 0.5, 0}, -0.01, 2));
  EXPECT_TRUE(lies_within(disc, {1.505, 2.0, 3.0}, -0.01, 3));
  EXPECT_TRUE(lies_within(ring, {1.245, 2.0, 3.0}, -0.01, 3));
  EXPECT_TRUE(lies_within(box, {-0.005, 4.005, 3.0}, -0.01, 3));
}

}  // namespace
}  // namespace poreshock
