#pragma once
// MUSL: density and rotation follow the velocity that the updated particles give the nodes
// (modified update stress last; Sulsky, Zhou & Schreyer, CPC 87 (1995) 236).

#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/particles/cell_order.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/transfer/step_data.hpp"

namespace poreshock {

/// Sums mass and momentum (SumLane) of the updated velocities at the nodes, particles still at
/// their places of the start of the step. After it the grid awaits exchange(). Not collective.
template <int Dim>
void remap_velocity(const Particles<Dim>& particles, const CellOrder& cells,
                    const Transfer& transfer, SlabGrid& grid);

/// Replaces step.gradient and step.rate by those of the remapped velocity (MotionLane, periodic
/// images filled) and moves the particles by step.transport, relative to the grid. The stress power
/// is then not that of the forces at the nodes: the energy does not close, and the drift of the
/// ledger's total is the loss of the scheme. (With the rate of the grid's own motion it would
/// close, but the short modes that the remap hides from the density then grow without bound.) Not
/// collective.
template <int Dim>
void gather_remapped(const SlabGrid& grid, const CellOrder& cells, const Transfer& transfer,
                     const Vector<Dim>& grid_velocity, double dt, Particles<Dim>& particles,
                     StepData<Dim>& step);

}  // namespace poreshock
