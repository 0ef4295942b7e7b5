#pragma once
// Energy and momentum that nodes gain or lose in one step, as exact sums.

#include <array>

#include "poreshock/core/fixed_point.hpp"

namespace poreshock {

/// Sums over owned nodes in quanta of energy (J) and momentum (kg m/s).
struct NodeLedger {
  double inverse_energy_quantum = 1.0;
  double inverse_momentum_quantum = 1.0;
  Int128 wall_heat = 0;
  Int128 contact_heat = 0;   ///< of the normal impulses between grains
  Int128 friction_heat = 0;  ///< of the tangential impulses between grains and at walls
  Int128 wall_work = 0;      ///< work done by moving walls on the material
  Int128 body_work = 0;
  std::array<Int128, 3> body_impulse{};
  std::array<Int128, 3> wall_impulse{};  ///< given to the material by walls and symmetry planes
};

}  // namespace poreshock
