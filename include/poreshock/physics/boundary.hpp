#pragma once
// Walls and symmetry planes. Both lie on a line of nodes; the nodes beyond mirror those inside.

#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/physics/node_ledger.hpp"

namespace poreshock {

/// Projects the end velocities (MotionLane) near walls and symmetry planes onto fields that are
/// mirror symmetric about them, by the mass-weighted mean of each set of mirror nodes. A wall does
/// so only where that pushes the material; a symmetry plane always. Planes move with grid_velocity.
/// Each set keeps the kinetic energy the projection takes, as heat per mass; work and impulse go to
/// the ledger (owned nodes). Not collective.
template <int Dim>
void apply_boundaries(const Boundary& boundary, const Vector<Dim>& grid_velocity, SlabGrid& grid,
                      NodeLedger& ledger);

/// True at nodes whose velocities apply_boundaries may change. `lateral` is the index of the node
/// in its row. Pure function.
bool is_mirrored(const Boundary& boundary, const GridShape& shape, int row, int lateral);

}  // namespace poreshock
