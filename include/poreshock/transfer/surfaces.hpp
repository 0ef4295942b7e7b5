#pragma once
// Particles to nodes: volume, its gradient and the mean place of a grain, for contact.

#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/particles/cell_order.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/transfer/node_points.hpp"

namespace poreshock {

/// Sums SurfaceLane of every node from the particles in the chosen cells. After it the grid awaits
/// exchange(). Not collective.
template <int Dim>
void scatter_surfaces(const Particles<Dim>& particles, const CellOrder& cells,
                      const ChosenCells& chosen, const Transfer& transfer, SlabGrid& surfaces);

}  // namespace poreshock
