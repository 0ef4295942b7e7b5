#pragma once
// Averaged dilatation: volume-weighted average to nodes and back. The operator is self-adjoint in
// the volume-weighted product, so the averaged pressure in the force and the averaged dilatation in
// the work are conjugate and the energy closes.

#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/particles/cell_order.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/transfer/step_data.hpp"

namespace poreshock {

/// Averages p + q of the particles to the nodes, periodic images filled, for particles_to_grid.
/// Collective (one exchange of `averages`).
template <int Dim>
void average_pressure(const Particles<Dim>& particles, const CellOrder& cells,
                      const Transfer& transfer, SlabGrid& averages);

/// Averages div v' and div v_mid of the particles to the nodes, from the nodal motion in `grid`
/// (periodic images filled), for grid_to_particles. In 2-D they end in lanes of `grid`, in 3-D in
/// those of `averages`. Collective (one exchange of `averages`).
template <int Dim>
void average_dilatation(const Particles<Dim>& particles, const CellOrder& cells,
                        const Transfer& transfer, SlabGrid& grid, SlabGrid& averages);

}  // namespace poreshock
