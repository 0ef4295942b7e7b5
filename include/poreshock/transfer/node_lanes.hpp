#pragma once
// Meaning of the eight numbers of a node, before and after the grid update.

#include "poreshock/core/lanes.hpp"

namespace poreshock {

/// Nodal sums, from particles_to_grid to integrate_momentum.
template <int Dim>
struct SumLane {
  static constexpr int mass = 0;
  static constexpr int momentum = 1;     ///< Dim numbers
  static constexpr int force = 1 + Dim;  ///< Dim numbers
  static constexpr int count = 1 + 2 * Dim;
};

/// Nodal motion, from integrate_momentum to grid_to_particles.
template <int Dim>
struct MotionLane {
  static constexpr int end_velocity = 0;      ///< Dim numbers
  static constexpr int start_velocity = Dim;  ///< Dim numbers
  static constexpr int heat = 2 * Dim;        ///< J/kg
  static constexpr int mass = 2 * Dim + 1;    ///< until prepare_gather
  static constexpr int kinetic =
      2 * Dim + 1;  ///< J/kg, its part of the heat of the transfer, after
  /// Volume by which grains overfill the node, over that of a cell; 3-D has no lane left for it.
  static constexpr int overfill = 2 * Dim + 2;
};

template <int Dim>
inline constexpr bool shows_overfill = MotionLane<Dim>::overfill < lane_count;

/// Surface of the grain of one velocity field at a node, for contact.
template <int Dim>
struct SurfaceLane {
  static constexpr int volume = 0;            ///< m^Dim, sum of V N
  static constexpr int gradient = 1;          ///< m^(Dim-1), sum of V dN/dx_p; Dim numbers
  static constexpr int place = 1 + Dim;       ///< m^(Dim+1), sum of V N (x_p - x_i); Dim numbers
  static constexpr int strain = 1 + 2 * Dim;  ///< m^Dim, sum of V N times the plastic strain
  static constexpr int facing = 2 + 2 * Dim;  ///< m^Dim, sum of V N times facing; plane strain only
};

/// What contact did to the grain of one velocity field at a shared node beside a wall.
template <int Dim>
struct CollisionLane {
  static constexpr int change = 0;  ///< m/s, of the end velocity; Dim numbers
  static constexpr int end = Dim;   ///< m/s, end velocity after it; Dim numbers
};

}  // namespace poreshock
