#pragma once

/// Norms of the modes of the velocity around eight particles.

#include <array>
#include <cmath>

#include "poreshock/core/lanes.hpp"
#include "poreshock/scene/transfer_scheme.hpp"

namespace poreshock {

/// Norms K of the modes under N.
template <int Dim, Modes M>
struct ModeNorms {
  std::array<Lanes, 1 + higher_modes<Dim, M>> value;
  /// Of the modes of second order: 1/K, and the root that turns coefficients into amplitudes.
  std::array<Lanes, M == Modes::quadratic ? Dim : 0> inverse, root, inverse_root;
};

/// Square root of one number where the lanes are written as one.
inline double square_root(double x) {
  return std::sqrt(x);
}

/// Norm of r_a^2 - D under the cubic B-spline at the place f in the cell: the fourth moment less
/// D^2.
template <class Number>
inline Number second_norm(const Number& f) {
  const Number product = f * (1.0 - f);
  return 2.0 / 9.0 - product * product;
}

/// Norms of a B-spline of inertia D (squared cells).
template <int Dim, Modes M>
inline ModeNorms<Dim, M> mode_norms(double inertia, const std::array<Lanes, Dim>& local) {
  ModeNorms<Dim, M> norm;
  norm.value[0] = 1.0 - Lanes{};
  if constexpr (M != Modes::constant) {
    for (int a = 0; a < Dim; ++a) norm.value[1 + a] = inertia - Lanes{};
  }
  if constexpr (M == Modes::quadratic) {
    for (int a = 0; a < Dim; ++a) {
      const Lanes square = second_norm(local[a]);
      norm.value[1 + Dim + a] = square;
      norm.inverse[a] = (1.0 - Lanes{}) / square;
      norm.root[a] = square_root(square);
      norm.inverse_root[a] = norm.root[a] * norm.inverse[a];
    }
    for (int n = Dim; n < second_modes<Dim>; ++n) {
      norm.value[1 + Dim + n] = inertia * inertia - Lanes{};
    }
  }
  return norm;
}

}  // namespace poreshock
