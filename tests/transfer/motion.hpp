#pragma once
// Motion of the nodes: given ones, and the momentum balance in its shortest form.

#include <vector>

#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/transfer/node_lanes.hpp"
#include "support/random_numbers.hpp"
#include "support/scalar_transfer.hpp"

namespace poreshock::test {

/// Random velocities before and after (+-500 m/s) and heats of all nodes.
template <int Dim>
std::vector<reference::NodeMotion<Dim>> random_motion(const GridShape& shape, std::uint64_t seed) {
  reference::Random random{seed};
  std::vector<reference::NodeMotion<Dim>> nodes(static_cast<std::size_t>(shape.row_size) *
                                                shape.rows);
  for (auto& node : nodes) {
    for (int a = 0; a < Dim; ++a) {
      node.start[a] = 1000.0 * random.uniform() - 500.0;
      node.end[a] = 1000.0 * random.uniform() - 500.0;
    }
    node.heat = 1e5 * random.uniform();
  }
  return nodes;
}

/// Writes a motion into the complete rows of this rank, as the momentum balance would.
template <int Dim>
void set_motion(const std::vector<reference::NodeMotion<Dim>>& nodes, SlabGrid& grid) {
  using Lane = MotionLane<Dim>;
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    for (int i = 0; i < grid.shape().row_size; ++i) {
      const auto& node = nodes[row * grid.shape().row_size + i];
      Lanes& lanes = grid.row(row)[i];
      for (int a = 0; a < Dim; ++a) {
        lanes[Lane::start_velocity + a] = node.start[a];
        lanes[Lane::end_velocity + a] = node.end[a];
      }
      lanes[Lane::heat] = node.heat;
      lanes[Lane::mass] = 1.0;
    }
  }
}

/// What the nodes gain by kicks: J, kg m/s.
template <int Dim>
struct NodeGain {
  double work = 0.0;
  Vector<Dim> impulse = Vector<Dim>::Zero();
};

/// From nodal sums to motion: v = p/m, v' = v + kick of the node. Returns the gain of the nodes
/// this rank owns.
template <int Dim, class Kick>
NodeGain<Dim> kick_nodes(Kick&& kick, SlabGrid& grid) {
  using Sum = SumLane<Dim>;
  using Lane = MotionLane<Dim>;
  NodeGain<Dim> gain;
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    for (int i = 0; i < grid.shape().row_size; ++i) {
      Lanes& lanes = grid.row(row)[i];
      const Lanes sums = lanes;
      lanes = Lanes{};
      const double mass = sums[Sum::mass];
      if (mass == 0.0) continue;
      const Vector<Dim> change = kick(row * grid.shape().row_size + i);
      double power = 0.0;
      for (int a = 0; a < Dim; ++a) {
        const double start = sums[Sum::momentum + a] / mass;
        lanes[Lane::start_velocity + a] = start;
        lanes[Lane::end_velocity + a] = start + change[a];
        power += change[a] * (start + 0.5 * change[a]);
      }
      lanes[Lane::mass] = mass;
      if (row >= grid.last_row()) continue;
      gain.work += mass * power;
      gain.impulse += mass * change;
    }
  }
  return gain;
}

}  // namespace poreshock::test
