#pragma once
// J2 plasticity with linear isotropic and kinematic hardening: exact radial return (paper eqs 1-3;
// Simo & Hughes, Computational Inelasticity, 1998, box 3.2).

#include <cmath>

#include "poreshock/core/tensor.hpp"

namespace poreshock {

/// Constants of the plastic law, Pa.
struct J2Plasticity {
  double shear = 0.0;
  double yield = 0.0;
  double isotropic = 0.0;  ///< isotropic hardening modulus
  double kinematic = 0.0;  ///< kinematic hardening modulus
};

/// Result of one return mapping; work terms per volume (J/m^3).
template <int Dim>
struct ReturnMapping {
  SymmetricTensor<Dim> deviator;
  SymmetricTensor<Dim> back_stress;
  double plastic_strain_increment;
  double plastic_work;  ///< all of it
  double dissipation;   ///< without what the back stress stores; its sum is Y ep + Hi ep^2/2
};

/// Returns the trial deviator to the yield surface. `start` is the deviator at the start of the
/// step, rotated to its end, `back_stress` likewise; only with Kinematic is the back stress used,
/// and a law with a kinematic modulus needs it.
template <int Dim, bool Kinematic>
inline ReturnMapping<Dim> radial_return(const J2Plasticity& law, const SymmetricTensor<Dim>& start,
                                        const SymmetricTensor<Dim>& trial,
                                        const SymmetricTensor<Dim>& back_stress,
                                        double plastic_strain) {
  constexpr int size = symmetric_size<Dim>;
  ReturnMapping<Dim> result;
  SymmetricTensor<Dim> xi = trial;
  if constexpr (Kinematic) {
    for (int c = 0; c < size; ++c) xi[c] -= back_stress[c];
  }
  const double norm2 = contract<Dim>(xi, xi);
  const double norm = std::sqrt(norm2);
  const double flow_stress = law.yield + law.isotropic * plastic_strain;
  const double excess = std::sqrt(1.5) * norm - flow_stress;
  // The same for all particles of a loop, so it is no division there.
  const double compliance = 1.0 / (3.0 * law.shear + law.isotropic + law.kinematic);
  // The selects keep 0/0 of a fluid (no shear modulus, no yield stress) out of the state.
  const double step = excess > 0.0 ? excess * compliance : 0.0;
  const double inverse_norm = excess > 0.0 ? 1.0 / norm : 0.0;
  const double back = std::sqrt(6.0) * law.shear * step * inverse_norm;
  const double shift = std::sqrt(2.0 / 3.0) * law.kinematic * step * inverse_norm;
  result.back_stress = back_stress;
  SymmetricTensor<Dim> middle;
  for (int c = 0; c < size; ++c) {
    result.deviator[c] = trial[c] - back * xi[c];
    if constexpr (Kinematic) result.back_stress[c] += shift * xi[c];
    middle[c] = 0.5 * (start[c] + result.deviator[c]);
  }
  result.plastic_strain_increment = step;
  result.plastic_work = std::sqrt(1.5) * step * (contract<Dim>(middle, xi) * inverse_norm);
  result.dissipation = (flow_stress + 0.5 * law.isotropic * step) * step;
  return result;
}

}  // namespace poreshock
