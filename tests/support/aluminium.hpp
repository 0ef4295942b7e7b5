#pragma once
// The aluminium of the paper as a scene states it, and the same solid as the reference solutions
// take it.

#include "poreshock/material/material.hpp"
#include "support/reference_eos.hpp"

namespace poreshock::reference {

/// Aluminium of the paper, isotropic hardening.
inline MaterialParameters aluminium() {
  MaterialParameters p;
  p.name = "aluminium";
  p.density = 2700.0;
  p.young = 69.0e9;
  p.poisson = 0.33;
  p.yield = 120.0e6;
  p.hardening = 384.0e6;
  p.c0 = 5350.0;
  p.lambda = 1.34;
  p.gamma = 2.0;
  p.cv = 880.0;
  p.conductivity = 237.0;
  p.T0 = 300.0;
  return p;
}

/// The reference solid of a material's parameters.
inline Solid solid(const MaterialParameters& p) {
  return {p.density,
          p.c0,
          p.lambda,
          p.gamma,
          p.cv,
          p.T0,
          p.young / (2.0 + 2.0 * p.poisson),
          p.yield,
          p.hardening,
          p.kinematic_share};
}

}  // namespace poreshock::reference
