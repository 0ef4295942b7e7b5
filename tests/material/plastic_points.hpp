#pragma once
// Points of plastic material that are strained in steps.

#include <cmath>
#include <cstdint>

#include "poreshock/material/j2_plasticity.hpp"

namespace poreshock::test {

inline constexpr double yield = 120e6;
inline constexpr double hardening = 384e6;
inline constexpr double shear = 69e9 / 2.66;

inline J2Plasticity law_with(double kinematic_share) {
  return {shear, yield, (1.0 - kinematic_share) * hardening, kinematic_share * hardening};
}

template <int Dim>
double von_mises(const SymmetricTensor<Dim>& s) {
  return std::sqrt(1.5 * contract<Dim>(s, s));
}

/// A material point that adds up what its steps report.
template <int Dim>
struct Point {
  SymmetricTensor<Dim> deviator{};
  SymmetricTensor<Dim> back_stress{};
  double plastic_strain = 0.0;
  double plastic_work = 0.0;
  double dissipation = 0.0;
};

/// One strain increment (a deviator); returns the plastic strain increment.
template <int Dim>
double strain_by(const J2Plasticity& law, const SymmetricTensor<Dim>& de, Point<Dim>& p) {
  SymmetricTensor<Dim> trial = p.deviator;
  for (int c = 0; c < symmetric_size<Dim>; ++c) trial[c] += 2.0 * law.shear * de[c];
  const ReturnMapping<Dim> r =
      radial_return<Dim, true>(law, p.deviator, trial, p.back_stress, p.plastic_strain);
  p.deviator = r.deviator;
  p.back_stress = r.back_stress;
  p.plastic_strain += r.plastic_strain_increment;
  p.plastic_work += r.plastic_work;
  p.dissipation += r.dissipation;
  return r.plastic_strain_increment;
}

/// Deviator of a uniaxial logarithmic compression along y.
inline SymmetricTensor<2> uniaxial(double strain) {
  return {strain / 3.0, -2.0 / 3.0 * strain, strain / 3.0, 0.0};
}

/// Numbers in [-1, 1), the same everywhere.
struct Sequence {
  std::uint64_t state = 20240607;
  double next() {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state >> 11) * 0x1p-52 - 1.0;
  }
};

template <int Dim>
SymmetricTensor<Dim> random_deviator(Sequence& random, double size) {
  SymmetricTensor<Dim> e;
  for (double& x : e) x = size * random.next();
  e[2] = -(e[0] + e[1]);
  return e;
}

}  // namespace poreshock::test
