#pragma once
// Particles around chosen nodes, one by one: what sums on the nodes cannot tell.

#include <cstdint>
#include <span>
#include <vector>

#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/particles/cell_order.hpp"
#include "poreshock/particles/particles.hpp"

namespace poreshock {

/// A particle as a node sees it.
template <int Dim>
struct NodePoint {
  Vector<Dim> offset = Vector<Dim>::Zero();  ///< cells, from the node
  double volume = 0.0;                       ///< of a cell
  std::int32_t field = 0;                    ///< its velocity field
};

/// Particles of chosen nodes of a slab: those of node number n are points[start[n]] ...
/// points[start[n + 1]].
template <int Dim>
struct NodePoints {
  std::vector<std::uint32_t> start;
  std::vector<NodePoint<Dim>> points;
};

/// Those of one node; none where nothing was collected.
template <int Dim>
std::span<const NodePoint<Dim>> points_of(const NodePoints<Dim>& all, std::size_t node) {
  if (all.start.empty()) return {};
  return {all.points.data() + all.start[node], all.start[node + 1] - all.start[node]};
}

/// A particle in its stencil cell, as ranks send it to each other.
template <int Dim>
struct CellPoint {
  std::int32_t row = 0, lateral = 0;
  std::int32_t field = 0;
  double volume = 0.0;     ///< of a cell
  double place[Dim] = {};  ///< cells
};

/// Node of a row that stands for node i across periodic sides. Pure function.
int original_node(const GridShape& shape, int i);

/// Cells of a slab, row after row: not 0 for those that are chosen.
using ChosenCells = std::vector<std::uint8_t>;

/// Whether the particles of a cell are taken; all are where nothing was chosen.
inline bool is_chosen(const ChosenCells& chosen, int row, int lateral, const SlabGrid& grid) {
  if (chosen.empty()) return true;
  const std::ptrdiff_t width = grid.shape().row_size;
  return chosen[static_cast<std::size_t>((row - grid.first_row()) * width + lateral)] != 0;
}

/// The stencil cells of this slab that reach one of some nodes; those across periodic sides count
/// as one. Not collective.
ChosenCells cells_at(const std::vector<NodePlace>& nodes, const SlabGrid& grid);

/// The particles in the chosen cells, in canonical order. Not collective.
template <int Dim>
std::vector<CellPoint<Dim>> collect_points(const Particles<Dim>& particles, const CellOrder& cells,
                                           const ChosenCells& chosen, const SlabGrid& grid);

/// Sends those in the rows next to the slabs of the neighbours to them and puts what they send in
/// front and behind: what reaches nodes in [first_row, node_end) is then there, in canonical order.
/// Collective (neighbours).
template <int Dim>
void exchange_points(const SlabGrid& grid, std::vector<CellPoint<Dim>>& points);

/// The points that reach each of some nodes in [first_row, node_end). Not collective.
template <int Dim>
NodePoints<Dim> points_at_nodes(const std::vector<CellPoint<Dim>>& points,
                                const std::vector<NodePlace>& nodes, const SlabGrid& grid);

}  // namespace poreshock
