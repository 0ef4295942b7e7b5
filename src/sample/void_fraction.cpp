#include <algorithm>
#include <cmath>
#include <numbers>

#include "block.hpp"
#include "union_area.hpp"

namespace poreshock {
namespace {

/// Whether no two voids overlap and none reaches out of the block.
bool stand_apart(const std::vector<Void>& voids, const Block& block) {
  for (const Void& v : voids) {
    for (int axis = 0; axis < block.dimension; ++axis) {
      const AxisRange range = centre_range(block, 0.0, v.radius, axis);
      if (v.center[axis] < range.low || v.center[axis] > range.high) return false;
    }
  }
  return least_gap(voids, block) >= 0.0;
}

double disc_union(const std::vector<Void>& voids, const Block& block) {
  std::vector<Disc> discs;
  discs.reserve(voids.size());
  for (const Void& v : voids) discs.push_back({v.center[0], v.center[1], v.radius});
  return union_area(with_images(discs, block.size[0], block.size[1], block.periodic[0], false),
                    block.size[0], block.size[1]);
}

/// Volume of a ball between the planes z = 0 and z = height.
double ball_between(const Void& ball, double height) {
  const double low = std::max(-ball.radius, -ball.center[2]);
  const double high = std::min(ball.radius, height - ball.center[2]);
  if (high <= low) return 0.0;
  const double cubes = (high * high * high - low * low * low) / 3.0;
  return std::numbers::pi * (ball.radius * ball.radius * (high - low) - cubes);
}

/// Area that the discs of one plane count too often: their sum less their union.
double double_count(const std::vector<Disc>& discs, const Block& block) {
  double sum = 0.0;
  for (const Disc& d : discs) sum += std::numbers::pi * (d.radius * d.radius);
  return sum - union_area(with_images(discs, block.size[0], block.size[1], block.periodic[0],
                                      block.periodic[1]),
                          block.size[0], block.size[1]);
}

/// Planes to integrate over: finer for few balls, whose errors do not average out.
std::size_t plane_count(const std::vector<Void>& balls, const Block& block) {
  double radius = 0.0;
  for (const Void& b : balls) radius += b.radius;
  radius /= static_cast<double>(balls.size());
  const double per_radius =
      std::clamp(128.0 * std::sqrt(100.0 / static_cast<double>(balls.size())), 10.0, 512.0);
  return static_cast<std::size_t>(std::ceil(block.size[2] / radius * per_radius));
}

/// Volumes of the balls one by one, exactly, less what overlaps count too often: exact in each
/// plane, midpoint rule across planes. That remainder is smooth and vanishes with its slope where
/// two balls begin to meet, so the rule converges fast.
double ball_union(const std::vector<Void>& balls, const Block& block) {
  const std::size_t planes = plane_count(balls, block);
  const double thickness = block.size[2] / static_cast<double>(planes);
  double volume = 0.0;
  std::vector<std::vector<Disc>> sections(planes);
  for (const Void& b : balls) {
    volume += ball_between(b, block.size[2]);
    const double last = static_cast<double>(planes - 1);
    const double low = std::clamp((b.center[2] - b.radius) / thickness - 1.0, 0.0, last);
    const double high = std::clamp((b.center[2] + b.radius) / thickness + 1.0, 0.0, last);
    for (std::size_t k = static_cast<std::size_t>(low); k <= static_cast<std::size_t>(high); ++k) {
      const double dz = (static_cast<double>(k) + 0.5) * thickness - b.center[2];
      const double square = b.radius * b.radius - dz * dz;
      if (square > 0.0) sections[k].push_back({b.center[0], b.center[1], std::sqrt(square)});
    }
  }
  for (const std::vector<Disc>& section : sections) {
    volume -= thickness * double_count(section, block);
  }
  return volume;
}

}  // namespace

double void_fraction(const std::vector<Void>& voids, const Block& block) {
  if (voids.empty()) return 0.0;
  const double whole = block_measure(block);
  if (stand_apart(voids, block)) return summed_measure(voids, block.dimension) / whole;
  const double taken = block.dimension == 2 ? disc_union(voids, block) : ball_union(voids, block);
  return taken / whole;
}

double void_fraction(const std::vector<Void>& voids, const Scene& scene) {
  return void_fraction(voids, sample_block(scene));
}

}  // namespace poreshock
