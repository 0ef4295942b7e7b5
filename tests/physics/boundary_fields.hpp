#pragma once
// Random motion on the nodes of small grids, and the sides that act on it.

#include <map>

#include "physics/node_fields.hpp"
#include "poreshock/physics/boundary.hpp"

namespace poreshock::test {

/// Nodes by their index.
template <int Dim>
using Field = std::map<NodeIndex<Dim>, Lanes>;

/// Random motion of a node: mass, start and end velocities, some heat.
template <int Dim>
Lanes random_motion(const NodeIndex<Dim>& index, std::uint64_t seed) {
  using Motion = MotionLane<Dim>;
  reference::Random random = random_at<Dim>(index, seed);
  Lanes node{};
  node[Motion::mass] = 1.0e-6 * (0.05 + random.uniform());
  for (int a = 0; a < 2 * Dim; ++a) node[a] = 3000.0 * (random.uniform() - 0.5);
  node[Motion::heat] = 100.0 * random.uniform();
  return node;
}

/// A grid whose nodes hold motion(index). Collective.
template <int Dim>
std::unique_ptr<SlabGrid> grid_of(const std::array<int, Dim>& cells, const auto& motion,
                                  MPI_Comm communicator = MPI_COMM_SELF) {
  auto grid = make_grid(shape_of<Dim>(cells), communicator);
  grid->clear();
  for_each_node<Dim>(*grid,
                     [&](const NodeIndex<Dim>& index, Lanes& node) { node = motion(index); });
  return grid;
}

/// A copy of all nodes.
template <int Dim>
Field<Dim> field_of(SlabGrid& grid) {
  Field<Dim> field;
  for_each_node<Dim>(grid, [&](const NodeIndex<Dim>& i, const Lanes& node) { field[i] = node; });
  return field;
}

/// The kinds of all sides.
inline Boundary sides(SideKind low, SideKind high, SideKind lateral = SideKind::free) {
  Boundary boundary;
  boundary.low.kind = low;
  boundary.high.kind = high;
  boundary.lateral = {lateral, lateral};
  return boundary;
}

/// All lanes are equal; -0 equals +0.
template <int Dim>
void expect_unchanged(const Lanes& found, const Lanes& expected) {
  for (int k = 0; k < lane_count; ++k) EXPECT_EQ(found[k], expected[k]) << "lane " << k;
}

}  // namespace poreshock::test
