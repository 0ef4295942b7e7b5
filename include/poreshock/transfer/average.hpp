#pragma once
// Averaged dilatation: volume-weighted average to nodes and back. The operator is self-adjoint in
// the volume-weighted product, so the averaged pressure in the force and the averaged dilatation in
// the work are conjugate and the energy closes.

#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/particles/cell_order.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/transfer/step_data.hpp"

namespace poreshock {

/// Sets step.averaged_pressure = (1 - share) (p + q) + share A(p + q). `averages` keeps the nodal
/// volumes for average_dilatation. Collective (one exchange of `averages`).
template <int Dim>
void average_pressure(const Particles<Dim>& particles, const CellOrder& cells,
                      const Transfer& transfer, SlabGrid& averages, StepData<Dim>& step);

/// Sets step.dilatation_end and dilatation_mid, own and averaged mixed by the share, from the nodal
/// motion in `grid` (periodic images filled). Collective (one exchange of `averages`).
template <int Dim>
void average_dilatation(const Particles<Dim>& particles, const CellOrder& cells,
                        const Transfer& transfer, const SlabGrid& grid, SlabGrid& averages,
                        StepData<Dim>& step);

}  // namespace poreshock
