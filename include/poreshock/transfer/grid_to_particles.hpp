#pragma once
// Nodes to particles: velocity, position, affine velocity, velocity gradients and heat.

#include "poreshock/core/fixed_point.hpp"
#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/particles/cell_order.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/transfer/step_data.hpp"

namespace poreshock {

/// Replaces the mass lane of every node by the kinetic term of the transfer's filter heat and fills
/// the periodic images. `damped` is the share of velocity noise FLIP removes this step. Not
/// collective.
template <int Dim>
void prepare_gather(const Transfer& transfer, double damped, SlabGrid& grid);

/// Updates velocity, affine velocity and position of the particles of `rows` and sets
/// step.gradient, step.rate and step.heat, in canonical order from the first of them. Positions
/// advance relative to the grid, which moves with grid_velocity. With averaging
/// step.dilatation_end and dilatation_mid are set too, own and averaged mixed by the share;
/// `averages` then holds what average_dilatation left, else it is null. The filter heat of this
/// sweep (J) is added to filter_heat in quanta. Source of the closures: FLIP and APIC kinetic
/// energy balances, sum_p m_p v_p . dv_p = sum_i m_i v_i . dv_i. Not collective.
template <int Dim>
void grid_to_particles(const SlabGrid& grid, const SlabGrid* averages, const CellOrder& cells,
                       RowRange rows, const Transfer& transfer, const Vector<Dim>& grid_velocity,
                       double dt, double inverse_quantum, Particles<Dim>& particles,
                       StepData<Dim>& step, Int128& filter_heat);

/// Share of the velocity noise that FLIP with damping rate `damping` (1/s) removes in one step.
inline double damped_share(const Transfer& transfer, double dt) {
  const double x = transfer.damping * dt;
  return x / (1.0 + x);
}

}  // namespace poreshock
