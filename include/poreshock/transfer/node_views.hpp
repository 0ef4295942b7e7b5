#pragma once
// What the numbers of one node mean in a step, for code that takes a node at a time: a view whose
// names hold now. Kernels take all lanes at once (node_lanes.hpp).

#include "poreshock/core/lanes.hpp"
#include "poreshock/transfer/node_lanes.hpp"

namespace poreshock {

/// Sums over the particles, from particles_to_grid to integrate_momentum.
template <int Dim>
struct SumNode {
  const Lanes& lanes;

  double mass() const { return lanes[SumLane<Dim>::mass]; }
  double momentum(int a) const { return lanes[SumLane<Dim>::momentum + a]; }
  double force(int a) const { return lanes[SumLane<Dim>::force + a]; }
};

/// Motion over the step, from integrate_momentum to prepare_gather.
/// @tparam Node Lanes, const where the motion stays as it is
template <int Dim, class Node = Lanes>
struct MotionNode {
  Node& lanes;

  double mass() const { return lanes[MotionLane<Dim>::mass]; }
  double start(int a) const { return lanes[MotionLane<Dim>::start_velocity + a]; }
  double end(int a) const { return lanes[MotionLane<Dim>::end_velocity + a]; }
  double middle(int a) const { return 0.5 * (start(a) + end(a)); }
  void set_mass(double mass) const { lanes[MotionLane<Dim>::mass] = mass; }
  void set_start(int a, double velocity) const {
    lanes[MotionLane<Dim>::start_velocity + a] = velocity;
  }
  void set_end(int a, double velocity) const {
    lanes[MotionLane<Dim>::end_velocity + a] = velocity;
  }
  void add_heat(double per_mass) const { lanes[MotionLane<Dim>::heat] += per_mass; }
};

}  // namespace poreshock
