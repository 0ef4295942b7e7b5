#include <gtest/gtest.h>

#include <numbers>
#include <random>

#include "poreshock/sample/fill.hpp"
#include "sample/block.hpp"
#include "sample_scenes.hpp"

namespace poreshock {
namespace {

constexpr double pi = std::numbers::pi;

/// A unit square or cube whose lateral sides are periodic or not.
Scene unit_scene(int dimension, bool periodic) {
  Scene scene;
  scene.dimension = dimension;
  scene.domain.size = {1.0, 1.0, 1.0};
  scene.domain.periodic = {periodic, periodic && dimension == 3};
  scene.sample.height = 1.0;
  return scene;
}

double lens(double r, double d) {
  return 2.0 * r * r * std::acos(d / (2.0 * r)) - 0.5 * d * std::sqrt(4.0 * r * r - d * d);
}

double segment(double r, double depth) {
  return r * r * std::acos(1.0 - depth / r) -
         (r - depth) * std::sqrt(2.0 * r * depth - depth * depth);
}

TEST(VoidFraction, TwoDiscsShareTheirLens) {
  const std::vector<Void> voids = {{{0.4, 0.5, 0.0}, 0.2}, {{0.55, 0.5, 0.0}, 0.2}};
  EXPECT_NEAR(void_fraction(voids, unit_scene(2, false)), 2.0 * pi * 0.04 - lens(0.2, 0.15), 1e-15);
}

TEST(VoidFraction, TheLensMayLieAcrossThePeriodicSide) {
  const std::vector<Void> voids = {{{0.05, 0.3, 0.0}, 0.2}, {{0.9, 0.3, 0.0}, 0.2}};
  EXPECT_NEAR(void_fraction(voids, unit_scene(2, true)), 2.0 * pi * 0.04 - lens(0.2, 0.15), 1e-15);
}

TEST(VoidFraction, PartsOutsideTheBlockDoNotCount) {
  const std::vector<Void> top = {{{0.5, 0.9, 0.0}, 0.2}};
  EXPECT_NEAR(void_fraction(top, unit_scene(2, true)), pi * 0.04 - segment(0.2, 0.1), 1e-15);
  const std::vector<Void> side = {{{0.05, 0.5, 0.0}, 0.2}};
  EXPECT_NEAR(void_fraction(side, unit_scene(2, false)), pi * 0.04 - segment(0.2, 0.15), 1e-15);
  EXPECT_NEAR(void_fraction(side, unit_scene(2, true)), pi * 0.04, 1e-15);
  const std::vector<Void> corner = {{{0.0, 0.0, 0.0}, 0.2}};
  EXPECT_NEAR(void_fraction(corner, unit_scene(2, false)), pi * 0.01, 1e-15);
  EXPECT_NEAR(void_fraction(corner, unit_scene(2, true)), pi * 0.02, 1e-15);
}

TEST(VoidFraction, HiddenAndEqualDiscsCountOnce) {
  const std::vector<Void> voids = {
      {{0.5, 0.5, 0.0}, 0.3}, {{0.45, 0.5, 0.0}, 0.1}, {{0.5, 0.5, 0.0}, 0.3}};
  EXPECT_NEAR(void_fraction(voids, unit_scene(2, false)), pi * 0.09, 1e-15);
}

TEST(VoidFraction, DiscsThatCoverTheBlockGiveOne) {
  const std::vector<Void> voids = {{{0.3, 0.5, 0.0}, 0.8}, {{0.7, 0.5, 0.0}, 0.8}};
  EXPECT_NEAR(void_fraction(voids, unit_scene(2, false)), 1.0, 1e-14);
}

TEST(VoidFraction, TwoBallsShareTheirLens) {
  const double r = 0.2, d = 0.15;
  const double both =
      2.0 * 4.0 / 3.0 * pi * r * r * r - pi * (4.0 * r + d) * (2.0 * r - d) * (2.0 * r - d) / 12.0;
  const double s = d / std::sqrt(3.0);
  const std::vector<Void> inside = {{{0.4, 0.5, 0.45}, r}, {{0.4 + s, 0.5 + s, 0.45 + s}, r}};
  EXPECT_NEAR(void_fraction(inside, unit_scene(3, false)), both, 1e-7);
  const std::vector<Void> across = {{{0.97, 0.02, 0.45}, r},
                                    {{0.97 + s - 1.0, 0.02 + s, 0.45 + s}, r}};
  EXPECT_NEAR(void_fraction(across, unit_scene(3, true)), both, 1e-7);
}

TEST(VoidFraction, BallsCutByTheBlockKeepTheirCaps) {
  const double r = 0.2;
  const double ball = 4.0 / 3.0 * pi * r * r * r;
  const std::vector<Void> top = {{{0.5, 0.5, 0.9}, r}};
  EXPECT_NEAR(void_fraction(top, unit_scene(3, true)), ball - pi * 0.01 * (3.0 * r - 0.1) / 3.0,
              1e-8);
  const std::vector<Void> edge = {{{0.0, 0.0, 0.5}, r}};
  EXPECT_NEAR(void_fraction(edge, unit_scene(3, true)), ball, 1e-15);
  EXPECT_NEAR(void_fraction(edge, unit_scene(3, false)), ball / 4.0, 1e-6);
}

/// Share of random points that lie in a void or in one of its images.
double counted_fraction(const std::vector<Void>& voids, const Scene& scene, int points) {
  std::mt19937_64 words(12345);
  const auto uniform = [&] { return static_cast<double>(words() >> 11) * 0x1p-53; };
  int inside = 0;
  for (int n = 0; n < points; ++n) {
    const Triple p{uniform(), uniform(), scene.dimension == 3 ? uniform() : 0.0};
    bool hit = false;
    for (const Void& v : voids) {
      double square = 0.0;
      for (int axis = 0; axis < scene.dimension; ++axis) {
        double d = std::fabs(p[axis] - v.center[axis]);
        const bool wraps = axis < scene.dimension - 1 && scene.domain.periodic[axis];
        if (wraps) d = std::min(d, 1.0 - d);
        square += d * d;
      }
      hit = hit || square <= v.radius * v.radius;
    }
    inside += hit ? 1 : 0;
  }
  return static_cast<double>(inside) / points;
}

std::vector<Void> random_voids(int count, int dimension, double radius) {
  std::mt19937_64 words(99);
  const auto uniform = [&] { return static_cast<double>(words() >> 11) * 0x1p-53; };
  std::vector<Void> voids;
  for (int i = 0; i < count; ++i) {
    Void v;
    for (int axis = 0; axis < dimension; ++axis) v.center[axis] = uniform();
    v.radius = radius * (0.5 + uniform());
    voids.push_back(v);
  }
  return voids;
}

TEST(VoidFraction, RandomDiscsAgreeWithPointCounting) {
  for (const bool periodic : {true, false}) {
    const Scene scene = unit_scene(2, periodic);
    const std::vector<Void> voids = random_voids(40, 2, 0.09);
    const double exact = void_fraction(voids, scene);
    constexpr int points = 1000000;
    const double error = std::sqrt(exact * (1.0 - exact) / points);
    EXPECT_NEAR(counted_fraction(voids, scene, points), exact, 4.0 * error);
  }
}

TEST(VoidFraction, RandomBallsAgreeWithPointCounting) {
  for (const bool periodic : {true, false}) {
    const Scene scene = unit_scene(3, periodic);
    const std::vector<Void> voids = random_voids(40, 3, 0.15);
    const double exact = void_fraction(voids, scene);
    constexpr int points = 1000000;
    const double error = std::sqrt(exact * (1.0 - exact) / points);
    EXPECT_NEAR(counted_fraction(voids, scene, points), exact, 4.0 * error);
  }
}

TEST(VoidFraction, BallsGiveTheSameVolumeAlongEveryAxis) {
  // The planes cut the same union in three unrelated ways: what differs is the error of the rule.
  const Scene scene = unit_scene(3, false);
  std::vector<Void> voids = random_voids(150, 3, 0.1);
  for (Void& v : voids) {
    for (double& c : v.center) c = v.radius + c * (1.0 - 2.0 * v.radius);
  }
  const double first = void_fraction(voids, scene);
  EXPECT_GT(first, 0.3);
  for (int turn = 0; turn < 2; ++turn) {
    for (Void& v : voids) v.center = {v.center[1], v.center[2], v.center[0]};
    const double turned = void_fraction(voids, scene);
    EXPECT_NEAR(turned, first, 1e-5);
    EXPECT_NE(turned, first);
  }
}

TEST(LeastGap, LooksAcrossThePeriodicSideAndAtEveryPair) {
  const Block periodic{.dimension = 2, .size = {1.0, 3.0, 0.0}, .periodic = {true, false, false}};
  const std::vector<Void> voids = {{{0.1, 0.5, 0.0}, 0.1}, {{0.8, 0.5, 0.0}, 0.15}};
  EXPECT_NEAR(least_gap(voids, periodic), 0.3 - 0.25, 1e-15);
  const std::vector<Void> far = {{{0.5, 0.2, 0.0}, 0.01}, {{0.5, 2.9, 0.0}, 0.01}};
  EXPECT_DOUBLE_EQ(least_gap(far, periodic), 0.98);  // its own image across x
  const Block closed{.dimension = 2, .size = {1.0, 3.0, 0.0}, .periodic = {}};
  EXPECT_NEAR(least_gap(far, closed), 2.68, 1e-14);
  EXPECT_TRUE(std::isinf(least_gap({far[0]}, closed)));
}

TEST(LeastGap, AgreesWithAllPairs) {
  const Block block{.dimension = 3, .size = {1.0, 1.0, 1.0}, .periodic = {true, true, false}};
  const std::vector<Void> voids = random_voids(300, 3, 0.01);
  double least = INFINITY;
  for (std::size_t i = 0; i < voids.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      const double d = std::sqrt(squared_distance(block, voids[i].center, voids[j].center));
      least = std::min(least, d - (voids[i].radius + voids[j].radius));
    }
  }
  EXPECT_EQ(least_gap(voids, block), least);
}

}  // namespace
}  // namespace poreshock
