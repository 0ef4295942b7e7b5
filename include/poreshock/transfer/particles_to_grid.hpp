#pragma once
// Particles to nodes: mass, momentum, internal force and the kinetic energy of affine particles.

#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/particles/cell_order.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/scene/scene.hpp"

namespace poreshock {

/// Sums SumLane of every node from the particles of this slab (paper eqs 10, 13, 14). With
/// `averages` (of average_pressure, null without averaging) the pressure P in the force is
/// (1 - share) (p + q) + share A(p + q), else p + q. After it the grid awaits exchange(). Not
/// collective.
template <int Dim>
void particles_to_grid(const Particles<Dim>& particles, const CellOrder& cells,
                       const Transfer& transfer, const SlabGrid* averages, SlabGrid& grid);

}  // namespace poreshock
