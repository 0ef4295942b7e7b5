#pragma once
// Particles to nodes: mass, momentum and internal force.

#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/particles/cell_order.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/scene/scene.hpp"

namespace poreshock {

/// Sums SumLane of every node from the particles of this slab (paper eqs 10, 13, 14). After it the
/// grid awaits exchange(). Not collective.
template <int Dim>
void particles_to_grid(const Particles<Dim>& particles, const CellOrder& cells,
                       const Transfer& transfer, SlabGrid& grid);

}  // namespace poreshock
