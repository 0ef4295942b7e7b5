#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>

#include "block.hpp"
#include "cell_list.hpp"
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

/// Planes to integrate over: finer for few balls, whose errors do not average out. A power of two,
/// so that the result hardly ever jumps when the radii change a little.
std::size_t plane_count(const std::vector<Void>& balls, const Block& block) {
  double radius = 0.0;
  for (const Void& b : balls) radius += b.radius;
  radius /= static_cast<double>(balls.size());
  const double per_radius =
      std::clamp(64.0 * std::sqrt(100.0 / static_cast<double>(balls.size())), 8.0, 256.0);
  return std::bit_ceil(static_cast<std::size_t>(block.size[2] / radius * per_radius) + 1);
}

/// What the midpoint rule misses at the poles of the balls. The area of the union sets in there
/// with a slope of 2 pi r, unless another ball hides the pole; a ramp that starts at share s of a
/// plane's thickness h is missed by slope h^2 ((1 - s)^2 / 2 - max(1/2 - s, 0) - 1/24).
double pole_correction(const std::vector<Void>& balls, const Block& block, double thickness) {
  double largest = 0.0;
  for (const Void& b : balls) largest = std::max(largest, b.radius);
  CellList cells = make_cell_list(block, largest, balls.size());
  for (std::size_t i = 0; i < balls.size(); ++i) {
    insert(balls[i].center, static_cast<int>(i), cells);
  }
  double correction = 0.0;
  for (std::size_t i = 0; i < balls.size(); ++i) {
    for (const double way : {-1.0, 1.0}) {
      Triple pole = balls[i].center;
      pole[2] += way * balls[i].radius;
      if (pole[2] < 0.0 || pole[2] > block.size[2]) continue;
      const bool hidden = any_near(cells, pole, [&](int j) {
        const Void& other = balls[static_cast<std::size_t>(j)];
        return static_cast<std::size_t>(j) != i &&
               squared_distance(block, pole, other.center) < other.radius * other.radius;
      });
      if (hidden) continue;
      const double place = pole[2] / thickness;
      const double below = place - std::floor(place);
      const double s = way < 0.0 ? below : 1.0 - below;
      const double missed = 0.5 * ((1.0 - s) * (1.0 - s)) - std::max(0.5 - s, 0.0) - 1.0 / 24.0;
      correction += 2.0 * std::numbers::pi * balls[i].radius * (thickness * thickness) * missed;
    }
  }
  return correction;
}

/// Volume of the union of balls inside the block: area of the union in each plane exactly, midpoint
/// rule across planes with a correction at the poles. What is left of its error comes from where
/// two balls begin to meet, where the area is smooth.
double ball_union(const std::vector<Void>& balls, const Block& block) {
  const std::size_t planes = plane_count(balls, block);
  const double thickness = block.size[2] / static_cast<double>(planes);
  std::vector<std::vector<Disc>> sections(planes);
  for (const Void& b : balls) {
    const double last = static_cast<double>(planes - 1);
    const double low = std::clamp((b.center[2] - b.radius) / thickness - 1.0, 0.0, last);
    const double high = std::clamp((b.center[2] + b.radius) / thickness + 1.0, 0.0, last);
    for (std::size_t k = static_cast<std::size_t>(low); k <= static_cast<std::size_t>(high); ++k) {
      const double dz = (static_cast<double>(k) + 0.5) * thickness - b.center[2];
      const double square = b.radius * b.radius - dz * dz;
      if (square > 0.0) sections[k].push_back({b.center[0], b.center[1], std::sqrt(square)});
    }
  }
  double volume = pole_correction(balls, block, thickness);
  for (const std::vector<Disc>& section : sections) {
    const std::vector<Disc> images =
        with_images(section, block.size[0], block.size[1], block.periodic[0], block.periodic[1]);
    volume += thickness * union_area(images, block.size[0], block.size[1]);
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
