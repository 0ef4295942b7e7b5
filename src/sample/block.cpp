#include "block.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "cell_list.hpp"

namespace poreshock {

Block sample_block(const Scene& scene) {
  Block block;
  block.dimension = scene.dimension;
  const int shock = scene.dimension - 1;
  for (int axis = 0; axis < shock; ++axis) {
    block.size[axis] = scene.domain.size[axis];
    block.periodic[axis] = scene.domain.periodic[axis];
  }
  block.size[shock] = scene.sample.height;
  return block;
}

double block_measure(const Block& block) {
  double result = 1.0;
  for (int axis = 0; axis < block.dimension; ++axis) result *= block.size[axis];
  return result;
}

double ball_measure(double radius, int dimension) {
  const double disc = std::numbers::pi * (radius * radius);
  return dimension == 2 ? disc : disc * radius * (4.0 / 3.0);
}

double summed_measure(const std::vector<Void>& voids, int dimension) {
  double sum = 0.0, lost = 0.0;
  for (const Void& v : voids) {
    const double term = ball_measure(v.radius, dimension) - lost;
    const double next = sum + term;
    lost = (next - sum) - term;
    sum = next;
  }
  return sum;
}

AxisRange centre_range(const Block& block, double keep_out, double radius, int axis) {
  if (block.periodic[axis]) return {0.0, block.size[axis]};
  const double margin = keep_out + radius;
  return {margin, block.size[axis] - margin};
}

Triple wrap(const Block& block, Triple point) {
  for (int axis = 0; axis < block.dimension; ++axis) {
    if (!block.periodic[axis]) continue;
    const double size = block.size[axis];
    if (point[axis] < 0.0) point[axis] += size;
    // A tiny negative number plus the size rounds to the size itself: hence the second test.
    if (point[axis] >= size) point[axis] -= size;
  }
  return point;
}

Triple separation(const Block& block, const Triple& from, const Triple& to) {
  Triple result{};
  for (int axis = 0; axis < block.dimension; ++axis) {
    double d = to[axis] - from[axis];
    if (block.periodic[axis]) {
      const double size = block.size[axis];
      if (d > 0.5 * size) d -= size;
      if (d < -0.5 * size) d += size;
    }
    result[axis] = d;
  }
  return result;
}

double squared_distance(const Block& block, const Triple& from, const Triple& to) {
  const Triple d = separation(block, from, to);
  return (d[0] * d[0] + d[1] * d[1]) + d[2] * d[2];
}

namespace {

/// Least gap over the pairs that a cell list of this cutoff finds: every pair closer than it.
double least_gap_within(const std::vector<Void>& voids, const Block& block, double cutoff) {
  CellList cells = make_cell_list(block, cutoff, voids.size());
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < voids.size(); ++i) {
    any_near(cells, voids[i].center, [&](int j) {
      const Void& other = voids[static_cast<std::size_t>(j)];
      const double distance = std::sqrt(squared_distance(block, voids[i].center, other.center));
      least = std::min(least, distance - (voids[i].radius + other.radius));
      return false;
    });
    insert(voids[i].center, static_cast<int>(i), cells);
  }
  return least;
}

}  // namespace

double least_gap(const std::vector<Void>& voids, const Block& block) {
  double least = std::numeric_limits<double>::infinity();
  if (voids.empty()) return least;
  double largest = 0.0;
  for (const Void& v : voids) largest = std::max(largest, v.radius);
  double diagonal = 0.0;
  for (int axis = 0; axis < block.dimension; ++axis) {
    if (block.periodic[axis]) least = std::min(least, block.size[axis] - 2.0 * largest);
    diagonal += block.size[axis];
  }
  // Pairs farther apart than the cutoff have a gap above cutoff - 2 largest.
  const double spacing = std::pow(block_measure(block) / static_cast<double>(voids.size()),
                                  1.0 / static_cast<double>(block.dimension));
  for (double cutoff = 2.0 * largest + 0.5 * spacing;; cutoff *= 2.0) {
    least = std::min(least, least_gap_within(voids, block, cutoff));
    if (least <= cutoff - 2.0 * largest || cutoff > diagonal) return least;
  }
}

}  // namespace poreshock
