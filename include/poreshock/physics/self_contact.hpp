#pragma once
// Contact of a grain with itself: at a node where walls of a void face each other, the material is
// parted into two sides, and these collide like two grains (field-gradient partitioning: Homel &
// Herbold, Int. J. Numer. Meth. Eng. 109 (2017) 1013).
//
// Particles come sorted by the quarter of the plane they face, a velocity field each. A node
// gives every quarter to one of its two sides, by the sign of the product of the quarter's mean
// direction and the node's own. Quarters of one side move as one field there.

#include <array>
#include <cstdint>
#include <vector>

#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/physics/node_ledger.hpp"

namespace poreshock {

/// Quarters of the plane: facing down, up, left, right; what faces nothing counts as down.
inline constexpr int facing_quarters = 4;

/// Quarter of a direction in the plane. Pure function.
inline int facing_quarter(double x, double y) {
  if (y * y >= x * x) return y > 0.0 ? 1 : 0;
  return x > 0.0 ? 3 : 2;
}

/// Which quarters form the sides of a node: bit f for quarter f. One side alone is `first`.
struct NodeSides {
  std::uint8_t first = 0, second = 0;
  bool operator==(const NodeSides&) const = default;
};

/// SurfaceLane<2> of the quarters at one node.
using QuarterSums = std::array<Lanes, facing_quarters>;

/// Sides of a node from SurfaceLane<2> of its quarters. There are two where both face each other:
/// mean directions more than 120 degrees apart, each towards the place of the other. Pure function.
NodeSides sides_of_node(const QuarterSums& quarters);

/// Sides of all nodes in [first_row, node_end), row after row. `surfaces`: a field per quarter,
/// each with all nodes. Not collective.
std::vector<NodeSides> find_sides(const SlabGrid& surfaces);

/// At every node, the sums of the first side go to the first field, those of the second to the
/// second one; a side that is not there and the other fields get zeros. Not collective.
void join_sides(const std::vector<NodeSides>& sides, SlabGrid& grid);

/// The reverse: each quarter gets what its side has become. Not collective.
void spread_sides(const std::vector<NodeSides>& sides, SlabGrid& grid);

}  // namespace poreshock
