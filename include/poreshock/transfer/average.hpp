#pragma once
// Averaged dilatation: volume-weighted average to nodes and back. The operator is self-adjoint in
// the volume-weighted product, so the averaged pressure in the force and the averaged dilatation in
// the work are conjugate and the energy closes.

#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/particles/cell_order.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/transfer/step_data.hpp"

namespace poreshock {

/// First half of average_pressure: volume and volume x (p + q) of every node, complete. Collective
/// (one exchange of `averages`).
template <int Dim>
void sum_pressure(const Particles<Dim>& particles, const CellOrder& cells, const Transfer& transfer,
                  SlabGrid& averages);

/// Second half: turns sums of volume x quantity into averages; empty nodes stay zero. Fills
/// periodic images. Not collective.
void divide_by_volume(SlabGrid& averages);

/// The halves of average_dilatation; the first is collective (one exchange of `averages`).
template <int Dim>
void sum_dilatation(const Particles<Dim>& particles, const CellOrder& cells,
                    const Transfer& transfer, const SlabGrid& grid, SlabGrid& averages);
template <int Dim>
void divide_dilatation(SlabGrid& grid, SlabGrid& averages);

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
