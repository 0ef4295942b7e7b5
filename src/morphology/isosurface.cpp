#include "poreshock/morphology/isosurface.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "interpolated.hpp"

namespace poreshock {
namespace {

/// Values at the centres of 2 x 2 x 2 voxels; bit a of a corner's number is its place along axis a.
using Corners = std::array<double, 8>;
using Point = std::array<double, 3>;
using Tetrahedron = std::array<std::size_t, 4>;

/// One for every order of the axes on the way from corner 0 to corner 7. Two cubes cut the face
/// between them alike, so that the surface has no gaps.
constexpr std::array<Tetrahedron, 6> tetrahedra = {
    {{0, 1, 3, 7}, {0, 1, 5, 7}, {0, 2, 3, 7}, {0, 2, 6, 7}, {0, 4, 5, 7}, {0, 4, 6, 7}}};

/// Place of the crossing on the edge from corner a to corner b.
Point crossing(const Corners& value, std::size_t a, std::size_t b, double threshold) {
  const double share = crossing_share(value[a], value[b], threshold);
  Point point;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto from = static_cast<double>(a >> axis & 1);
    const auto to = static_cast<double>(b >> axis & 1);
    point[axis] = from + share * (to - from);
  }
  return point;
}

/// Area of a plane quadrangle with its corners in circular order: half the cross product of its
/// diagonals. A triangle has one corner twice.
double area_of(const Point& p, const Point& q, const Point& r, const Point& s) {
  Point a, b;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    a[axis] = r[axis] - p[axis];
    b[axis] = s[axis] - q[axis];
  }
  const double x = a[1] * b[2] - a[2] * b[1];
  const double y = a[2] * b[0] - a[0] * b[2];
  const double z = a[0] * b[1] - a[1] * b[0];
  return 0.5 * std::sqrt(x * x + y * y + z * z);
}

double area_in(const Tetrahedron& corners, const Corners& value, double threshold) {
  Tetrahedron sorted{};  // white corners first
  std::size_t white = 0, black = 0;
  for (const std::size_t corner : corners) {
    const bool hot = value[corner] >= threshold;
    sorted[hot ? white++ : 3 - black++] = corner;
  }
  if (white == 0 || black == 0) return 0.0;
  const auto cut = [&](std::size_t i, std::size_t j) {
    return crossing(value, sorted[i], sorted[j], threshold);
  };
  if (white == 2) return area_of(cut(0, 2), cut(1, 2), cut(1, 3), cut(0, 3));
  const std::size_t alone = white == 1 ? 0 : 3;
  const Point last = cut(alone, white == 1 ? 3 : 2);
  return area_of(cut(alone, white == 1 ? 1 : 0), cut(alone, white == 1 ? 2 : 1), last, last);
}

/// Area of the surface within the cube of eight centres.
double area_in_cube(const Corners& value, double threshold) {
  double area = 0.0;
  for (const Tetrahedron& one : tetrahedra) area += area_in(one, value, threshold);
  return area;
}

}  // namespace

std::vector<double> isosurface_areas(const PixelField<3>& map, std::size_t field,
                                     std::span<const double> thresholds, MPI_Comm communicator) {
  const std::vector<std::uint32_t> ranks = ranks_of_map(map, field, thresholds);
  const Slab slab = slab_of(map);
  const auto nx = static_cast<std::size_t>(slab.nx);
  BoundarySums areas(thresholds.size(), 0);
  const auto row = [&](int y, int z) {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(slab.ny) +
            static_cast<std::size_t>(y)) *
           nx;
  };
  for (int z = 0; z + 1 < slab.stored; ++z) {
    for (int y = 0; y + (slab.periodic_y ? 0 : 1) < slab.ny; ++y) {
      const int above = y + 1 < slab.ny ? y + 1 : 0;
      const std::array<std::size_t, 4> rows = {row(y, z), row(above, z), row(y, z + 1),
                                               row(above, z + 1)};
      for (std::size_t x = 0; x + (slab.periodic_x ? 0 : 1) < nx; ++x) {
        const std::size_t next = x + 1 < nx ? x + 1 : 0;
        std::array<std::size_t, 8> at;
        for (std::size_t c = 0; c < 8; ++c) at[c] = rows[c >> 1] + ((c & 1) != 0 ? next : x);
        add_cell(map, field, at, ranks, thresholds, area_in_cube, areas);
      }
    }
  }
  return boundary_sizes(std::move(areas), communicator);
}

}  // namespace poreshock
