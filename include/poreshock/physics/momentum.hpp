#pragma once
// Momentum balance at the nodes.

#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/physics/node_ledger.hpp"

namespace poreshock {

/// From nodal sums (SumLane) to motion (MotionLane): v = p/m, v' = v + dt (f/m + b) (paper eq 13).
/// Empty nodes stay zero. Not collective.
template <int Dim>
void integrate_momentum(const Vector<Dim>& body_force, double dt, SlabGrid& grid);

/// Adds the work and impulse of the body force over this step on owned nodes. Call after the
/// boundaries. Not collective.
template <int Dim>
void add_body_work(const Vector<Dim>& body_force, double dt, const SlabGrid& grid,
                   NodeLedger& ledger);

}  // namespace poreshock
