#pragma once
// Area of an interpolated isosurface written as plainly as possible: one threshold, one cube, one
// tetrahedron at a time, its polygon ordered by angle and cut into triangles. Slow, and independent
// of the code under test.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "support/pixel_reference.hpp"

namespace poreshock::reference {

using Spot = std::array<double, 3>;

inline double apart(const Spot& a, const Spot& b) {
  double sum = 0.0;
  for (std::size_t axis = 0; axis < 3; ++axis) sum += (a[axis] - b[axis]) * (a[axis] - b[axis]);
  return std::sqrt(sum);
}

/// Heron's formula.
inline double triangle(const Spot& a, const Spot& b, const Spot& c) {
  const double p = apart(a, b), q = apart(b, c), r = apart(c, a);
  const double s = 0.5 * (p + q + r);
  return std::sqrt(std::max(0.0, s * (s - p) * (s - q) * (s - r)));
}

/// Three or four points of a plane convex polygon in any order: of the three ways round four
/// points the shortest is the one without crossing.
inline double polygon(const std::vector<Spot>& points) {
  if (points.size() < 3) return 0.0;
  if (points.size() == 3) return triangle(points[0], points[1], points[2]);
  double least = INFINITY, area = 0.0;
  for (const std::array<std::size_t, 3>& way :
       {std::array<std::size_t, 3>{1, 2, 3}, {1, 3, 2}, {2, 1, 3}}) {
    const Spot &a = points[0], &b = points[way[0]], &c = points[way[1]], &d = points[way[2]];
    const double round = apart(a, b) + apart(b, c) + apart(c, d) + apart(d, a);
    if (!(round < least)) continue;
    least = round;
    area = triangle(a, b, c) + triangle(a, c, d);
  }
  return area;
}

/// Area of the surface in the cube whose lowest corner is this voxel; zero where the cube leaves
/// the map or has a void corner.
inline double area_in_cube(const Image& image, std::array<int, 3> low, double threshold) {
  double area = 0.0;
  for (int dz = 0; dz < 2; ++dz) {
    for (int dy = 0; dy < 2; ++dy) {
      for (int dx = 0; dx < 2; ++dx) {
        const std::ptrdiff_t i = index_of(image, low[0] + dx, low[1] + dy, low[2] + dz);
        if (i < 0 || image.solid[static_cast<std::size_t>(i)] == 0) return 0.0;
      }
    }
  }
  std::array<int, 3> axes = {0, 1, 2};
  do {
    std::array<Spot, 4> corner{};
    std::array<double, 4> value{};
    for (std::size_t k = 0; k < 4; ++k) {
      if (k > 0) corner[k] = corner[k - 1];
      if (k > 0) corner[k][static_cast<std::size_t>(axes[k - 1])] = 1.0;
      const auto at = [&](std::size_t axis) {
        return low[axis] + static_cast<int>(corner[k][axis]);
      };
      value[k] = image.values[static_cast<std::size_t>(index_of(image, at(0), at(1), at(2)))];
    }
    std::vector<Spot> points;
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t l = k + 1; l < 4; ++l) {
        if ((value[k] >= threshold) == (value[l] >= threshold)) continue;
        const double share = (threshold - value[k]) / (value[l] - value[k]);
        Spot& point = points.emplace_back();
        for (std::size_t axis = 0; axis < 3; ++axis) {
          point[axis] = corner[k][axis] + share * (corner[l][axis] - corner[k][axis]);
        }
      }
    }
    area += polygon(points);
  } while (std::next_permutation(axes.begin(), axes.end()));
  return area;
}

/// Area of the surface in the whole map, in voxel faces.
inline double plain_isosurface(const Image& image, double threshold) {
  double area = 0.0;
  for (int z = 0; z < image.height; ++z) {
    for (int y = 0; y < image.depth; ++y) {
      for (int x = 0; x < image.width; ++x) area += area_in_cube(image, {x, y, z}, threshold);
    }
  }
  return area;
}

}  // namespace poreshock::reference
