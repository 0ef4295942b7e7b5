#include "poreshock/physics/self_contact.hpp"

#include <array>
#include <cmath>

#include "poreshock/core/tensor.hpp"
#include "poreshock/transfer/node_lanes.hpp"

namespace poreshock {

namespace {

using Surface = SurfaceLane<2>;

constexpr double opposite = -0.5;  // cosine of two mean directions that face each other

Vector<2> direction(const Lanes& lanes) {
  return {lanes[Surface::facing], lanes[Surface::facing + 1]};
}

Vector<2> place(const Lanes& lanes) {
  return {lanes[Surface::place], lanes[Surface::place + 1]};
}

/// Direction along which the quarters face, whichever way: the first axis of the sum of G G^T / V,
/// its larger component positive.
Vector<2> facing_axis(const QuarterSums& quarters) {
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const Lanes& q : quarters) {
    if (!(q[Surface::volume] > 0.0)) continue;
    const Vector<2> g = direction(q);
    xx += g[0] * g[0] / q[Surface::volume];
    xy += g[0] * g[1] / q[Surface::volume];
    yy += g[1] * g[1] / q[Surface::volume];
  }
  const double half = 0.5 * (xx - yy), radius = std::sqrt(half * half + xy * xy);
  Vector<2> axis{0.0, 1.0};
  if (half > 0.0) axis = {half + radius, xy};
  if (half <= 0.0 && radius > 0.0) axis = {xy, radius - half};
  const double larger = axis[0] * axis[0] > axis[1] * axis[1] ? axis[0] : axis[1];
  return larger < 0.0 ? Vector<2>(-axis) : axis;
}

bool belongs(int quarter, std::uint8_t side) {
  return (side >> quarter & 1) != 0;
}

/// Sum over the quarters of a side, of the lanes that at(quarter) gives.
template <class At>
Lanes sum_over(std::uint8_t side, At&& at) {
  Lanes sum{};
  for (int f = 0; f < facing_quarters; ++f) {
    if (belongs(f, side)) sum += at(f);
  }
  return sum;
}

bool face_each_other(const Lanes& first, const Lanes& second, const Vector<2>& axis) {
  const Vector<2> a = direction(first), b = direction(second);
  const double lengths = std::sqrt(a.squaredNorm() * b.squaredNorm());
  if (!(lengths > 0.0) || a.dot(b) > opposite * lengths) return false;
  // The first side faces along the axis, so the second one must lie there: the two faces of a thin
  // ligament look away from each other.
  const Vector<2> way =
      place(second) / second[Surface::volume] - place(first) / first[Surface::volume];
  return way.dot(axis) > 0.0;
}

/// One row of nodes of every quarter.
struct NodeRows {
  Lanes* of[facing_quarters];
};

/// Calls visit(sides, rows, i) for every node with material, i in its row.
template <class Visit>
void for_each_node(const std::vector<NodeSides>& sides, SlabGrid& grid, Visit&& visit) {
  NodeRows rows;
  std::size_t node = 0;
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    for (int f = 0; f < facing_quarters; ++f) rows.of[f] = grid.row(row, f);
    for (int i = 0; i < grid.shape().row_size; ++i, ++node) {
      if (sides[node] != NodeSides{}) visit(sides[node], rows, i);
    }
  }
}

Lanes sum_at(const NodeRows& rows, int i, std::uint8_t side) {
  return sum_over(side, [&](int f) { return rows.of[f][i]; });
}

}  // namespace

NodeSides sides_of_node(const QuarterSums& quarters) {
  std::uint8_t all = 0;
  for (std::size_t f = 0; f < quarters.size(); ++f) {
    if (quarters[f][Surface::volume] > 0.0) all |= static_cast<std::uint8_t>(1U << f);
  }
  if ((all & (all - 1)) == 0) return {all, 0};
  const Vector<2> axis = facing_axis(quarters);
  NodeSides sides;
  for (std::size_t f = 0; f < quarters.size(); ++f) {
    const auto bit = static_cast<std::uint8_t>(1U << f);
    if ((all & bit) == 0) continue;
    (direction(quarters[f]).dot(axis) >= 0.0 ? sides.first : sides.second) |= bit;
  }
  const auto of = [&](int f) { return quarters[static_cast<std::size_t>(f)]; };
  if (sides.first == 0 || sides.second == 0 ||
      !face_each_other(sum_over(sides.first, of), sum_over(sides.second, of), axis)) {
    return {all, 0};
  }
  return sides;
}

std::vector<NodeSides> find_sides(const SlabGrid& surfaces) {
  const int width = surfaces.shape().row_size;
  std::vector<NodeSides> sides;
  sides.reserve(static_cast<std::size_t>(surfaces.node_end() - surfaces.first_row()) * width);
  QuarterSums quarters;
  for (int row = surfaces.first_row(); row < surfaces.node_end(); ++row) {
    for (int i = 0; i < width; ++i) {
      for (int f = 0; f < facing_quarters; ++f) quarters[f] = surfaces.row(row, f)[i];
      sides.push_back(sides_of_node(quarters));
    }
  }
  return sides;
}

void join_sides(const std::vector<NodeSides>& sides, SlabGrid& grid) {
  for_each_node(sides, grid, [](const NodeSides& node, const NodeRows& rows, int i) {
    const Lanes first = sum_at(rows, i, node.first), second = sum_at(rows, i, node.second);
    rows.of[0][i] = first;
    rows.of[1][i] = second;
    for (int f = 2; f < facing_quarters; ++f) rows.of[f][i] = Lanes{};
  });
}

void spread_sides(const std::vector<NodeSides>& sides, SlabGrid& grid) {
  for_each_node(sides, grid, [](const NodeSides& node, const NodeRows& rows, int i) {
    const Lanes first = rows.of[0][i], second = rows.of[1][i];
    for (int f = 0; f < facing_quarters; ++f) {
      rows.of[f][i] = belongs(f, node.first) ? first : (belongs(f, node.second) ? second : Lanes{});
    }
  });
}

}  // namespace poreshock
