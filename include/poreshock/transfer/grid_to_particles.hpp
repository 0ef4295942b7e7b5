#pragma once
// Nodes to particles: modes of the velocity, position, velocity gradients and heat.

#include "poreshock/core/fixed_point.hpp"
#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/particles/cell_order.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/transfer/step_data.hpp"

namespace poreshock {

/// What the sweep needs besides nodes and particles.
template <int Dim>
struct ParticleMotion {
  double dt = 0.0;
  double lost = 1.0;  ///< share of the residual that the step takes, of lost_share
  Vector<Dim> grid_velocity = Vector<Dim>::Zero();
  bool limited = false;  ///< artificial viscosity
  double inverse_energy_quantum = 1.0;
  double least_heat = 0.0;  ///< J/kg; less is rounding, which shortens nothing
  /// Share of what grains overfill that the step takes, of squeezed_share; 0 with one field.
  double squeezed = 0.0;
  double stiffness = 0.0;  ///< J/kg, square of the sound speed: a strain adds it to p/rho
};

/// What the transfer of a step did, on this rank.
struct TransferReport {
  Int128 heat = 0;             ///< quanta
  Int128 squeezing = 0;        ///< quanta of heat that compressed particles of overfull nodes
  std::int64_t negative = 0;   ///< particles whose heat was negative beyond rounding
  std::int64_t shortened = 0;  ///< particles whose modes beyond the velocity lost a tenth

  TransferReport& operator+=(const TransferReport& other);
};

/// Replaces the mass lane of every node by |u' - u|^2/2 + lost u.u', the node's part of the heat of
/// the transfer, and fills the periodic images. Not collective.
template <int Dim>
void prepare_gather(double lost, SlabGrid& grid);

/// Updates the modes of the velocity and the position of the particles of `rows` and sets
/// step.gradient, step.rate and step.heat, in canonical order from the first of them. Positions
/// advance relative to the grid. With the limited artificial viscosity step.viscous_linear and
/// viscous_quadratic are set. What the transfer loses of the kinetic energy of a particle is its
/// heat.
///
/// Where grains overfill its nodes (the lane `overfill`, how.squeezed > 0), a particle that bears a
/// pressure is compressed towards the space there is, as far as its heat of this step pays for the
/// work: no particle gets cold, and momentum stays. The strain is in step.gradient, not in
/// step.rate. Not collective.
template <int Dim>
TransferReport grid_to_particles(const SlabGrid& grid, const CellOrder& cells, RowRange rows,
                                 const Transfer& transfer, const ParticleMotion<Dim>& how,
                                 Particles<Dim>& particles, StepData<Dim>& step);

/// Share of its residual that a particle loses in a step: lambda = 1 - 1/(1 + beta c dt/cell), c
/// the sound speed; 1 with the transfers that keep none.
double lost_share(const Transfer& transfer, double sound_speed, double cell, double dt);

/// Share of what grains overfill that a step takes: a half while sound crosses a cell.
double squeezed_share(double sound_speed, double cell, double dt);

}  // namespace poreshock
