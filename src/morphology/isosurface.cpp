#include "poreshock/morphology/isosurface.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "poreshock/core/parallel.hpp"
#include "ranks.hpp"
#include "slab.hpp"

namespace poreshock {
namespace {

constexpr double area_unit = 1073741824.0;  // 2^30

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
  const double between = (threshold - value[a]) / (value[b] - value[a]);
  // An infinite value has no place; its crossing is taken half way.
  const double share = std::isfinite(between) ? between : 0.5;
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

/// Rows of voxels at the four edges of a row of cubes along x, as the numbers of their first
/// voxels; bit 0 of the place is along y, bit 1 along z.
using RowOfCubes = std::array<std::size_t, 4>;

/// Adds the surfaces in a row of cubes.
void add_row(const PixelField<3>& map, std::size_t field, const Slab& slab, const RowOfCubes& rows,
             std::span<const std::uint32_t> ranks, std::span<const double> thresholds,
             std::vector<std::int64_t>& areas) {
  const auto nx = static_cast<std::size_t>(slab.nx);
  const std::vector<double>& values = map.values[field];
  for (std::size_t x = 0; x + (slab.periodic_x ? 0 : 1) < nx; ++x) {
    const std::size_t next = x + 1 < nx ? x + 1 : 0;
    std::array<std::size_t, 8> at;
    for (std::size_t c = 0; c < 8; ++c) at[c] = rows[c >> 1] + ((c & 1) != 0 ? next : x);
    std::uint32_t most = 0, least = ranks[at[0]];
    bool solid = true;
    for (const std::size_t i : at) {
      most = std::max(most, ranks[i]);
      least = std::min(least, ranks[i]);
      solid = solid && map.solid[i] != 0;
    }
    if (!solid || least == most) continue;
    Corners corners;
    for (std::size_t c = 0; c < 8; ++c) corners[c] = values[at[c]];
    for (std::uint32_t j = least; j < most; ++j) {
      double area = 0.0;
      for (const Tetrahedron& one : tetrahedra) area += area_in(one, corners, thresholds[j]);
      areas[j] += std::llrint(area_unit * area);
    }
  }
}

}  // namespace

std::vector<double> isosurface_areas(const PixelField<3>& map, std::size_t field,
                                     std::span<const double> thresholds, MPI_Comm communicator) {
  const RankTable table = make_rank_table(thresholds);
  const Slab slab = slab_of(map);
  const std::size_t stored = slab.stored_size();
  std::vector<std::uint32_t> ranks(stored);
  rank_row(table, std::span<const double>(map.values.at(field)).first(stored),
           std::span<const std::uint8_t>(map.solid).first(stored), ranks.data());
  std::vector<std::int64_t> areas(thresholds.size(), 0);
  const auto row = [&](int y, int z) {
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(slab.ny) +
            static_cast<std::size_t>(y)) *
           static_cast<std::size_t>(slab.nx);
  };
  for (int z = 0; z + 1 < slab.stored; ++z) {
    for (int y = 0; y + (slab.periodic_y ? 0 : 1) < slab.ny; ++y) {
      const int next = y + 1 < slab.ny ? y + 1 : 0;
      const RowOfCubes rows = {row(y, z), row(next, z), row(y, z + 1), row(next, z + 1)};
      add_row(map, field, slab, rows, ranks, thresholds, areas);
    }
  }
  sum(areas, communicator);
  std::vector<double> result;
  for (const std::int64_t area : areas) {
    result.push_back(static_cast<double>(area) / area_unit);
  }
  return result;
}

}  // namespace poreshock
