#pragma once
// Contact between the velocity fields of a grid, node by node.

#include <cstdint>
#include <limits>
#include <vector>

#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/physics/contact.hpp"
#include "poreshock/physics/node_ledger.hpp"
#include "poreshock/transfer/node_points.hpp"

namespace poreshock {

/// Two grids of the same nodes: MotionLane, and SurfaceLane where there is contact.
struct ContactGrids {
  SlabGrid& motion;
  SlabGrid& surfaces;
};

/// What contact did in one step, over the owned nodes of this rank.
struct ContactSummary {
  std::int64_t nodes = 0;          ///< at which grains pushed each other
  std::int64_t crowded_nodes = 0;  ///< at which more than two grains met
  double least_gap = std::numeric_limits<double>::infinity();  ///< m, of all nodes two grains share
  double penetration = 0.0;                                    ///< m, largest
  double residual = 0.0;  ///< largest share of the impulses of a node that did not cancel
};

/// Volume that fills a node, m^Dim: cell^Dim, less beyond the sides of the domain. `lateral` is the
/// index of the node in its row. Pure function.
double node_capacity(const GridShape& shape, const Transfer& transfer, int row, int lateral);

/// The nodes in [first_row, node_end) where two fields or more have mass, with these fields; row
/// after row. Not collective.
std::vector<NodePlace> shared_nodes(const SlabGrid& motion, int mass_lane);

/// Lets the grains of all shared nodes collide: velocities and the heat lane change, the lane of
/// what they overfill is set, and SurfaceLane gives way to CollisionLane there. Before: motion and
/// surfaces complete, periodic images not yet filled. The same happens on every rank that holds a
/// node. Fields are taken in the order of their masses and velocities, so that the numbers of the
/// fields do not matter. settings.capacity and mirrored are set here. `points`: the particles
/// around the nodes, for normals from the planes that part them; without any they come from the
/// gradients. Not collective.
template <int Dim>
ContactSummary collide_grains(const ContactGrids& grids, const std::vector<NodePlace>& shared,
                              const Scene& scene, const ContactSettings& settings,
                              const FaceTable& faces, const NodePoints<Dim>& points,
                              NodeLedger& ledger);

/// After the boundaries: where they changed the velocities once more, contact impulses did other
/// work than collide_grains knew; the difference goes to the heat. Not collective.
template <int Dim>
void settle_contact_heat(const ContactGrids& grids, const std::vector<NodePlace>& shared,
                         const Boundary& boundary, NodeLedger& ledger);

}  // namespace poreshock
