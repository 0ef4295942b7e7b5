#pragma once

/// What a transfer does with the modes of the velocity of eight particles, and the one formula of
/// its heat. Pair space: a velocity u_pi for every particle p and node i of its stencil, with the
/// product <a, b> = sum_p m_p sum_i N_ip a_pi . b_pi. Fields of the nodes (u_pi = u_i) and of the
/// modes of a particle (u_pi = sum_k c_pk phi_k(r_pi), phi orthogonal under N with norms K_k) are
/// two of its subspaces, P_G and P_A the projections on them. A step takes the modes c of the
/// particles to u = P_G c, forces make it u', and the particles get
///   c'_k = M'_k + kappa_k (c_k - M_k),  M and M' the moments of u and u'.
/// Kinetic energy that is lost on the way stays on each particle as heat, per mass
///   q = sum_i N s_i - sum_k K_k (|M'_k - M_k|^2/2 + lambda M_k . M'_k)
///       + sum_k K_k ((1 - kappa_k^2)/2 |R_k|^2 + (kappa_0 - kappa_k) R_k . M'_k)
/// with R = c - M, lambda = 1 - kappa_0 and s_i = |u'_i - u_i|^2/2 + lambda u_i . u'_i. It closes
/// the energy for any shares, and is not negative where all kappa_k are equal.

#include <bit>

#include "mode_norms.hpp"
#include "moments.hpp"

namespace poreshock {

/// Modes of eight particles, the velocity first: [mode][component], m/s.
template <int Dim, Modes M>
using ModeLanes = std::array<std::array<Lanes, Dim>, 1 + higher_modes<Dim, M>>;

/// Moments of the start (`first` = Dim) or end velocities (0): coefficients of their modes.
template <int Dim, Modes M>
inline ModeLanes<Dim, M> mode_moments(const GroupMoments<Dim, M>& m, double inertia,
                                      const ModeNorms<Dim, M>& norm, int first) {
  ModeLanes<Dim, M> c;
  for (int a = 0; a < Dim; ++a) {
    c[0][a] = m.value[first + a];
    if constexpr (M != Modes::constant) {
      for (int k = 0; k < Dim; ++k) c[1 + k][a] = (1.0 / inertia) * m.mode[k][first + a];
    }
    if constexpr (M == Modes::quadratic) {
      for (int k = 0; k < second_modes<Dim>; ++k) {
        const Lanes moment = m.mode[Dim + k][first + a];
        c[1 + Dim + k][a] = k < Dim ? (moment - inertia * c[0][a]) * norm.inverse[k]
                                    : (1.0 / (inertia * inertia)) * moment;
      }
    }
  }
  return c;
}

/// Share of its residual that mode k keeps where the velocity keeps `kept`.
template <Keeps Kept>
constexpr bool keeps_mode(std::size_t k) {
  return Kept == Keeps::all || (Kept == Keeps::velocity && k == 0);
}

/// Heat q of the transfer, J/kg; `kinetic` is sum N s_i, `lost` is lambda.
template <int Dim, Modes M, Keeps Kept>
inline Lanes transfer_heat(const ModeLanes<Dim, M>& old, const ModeLanes<Dim, M>& start,
                           const ModeLanes<Dim, M>& end, const ModeNorms<Dim, M>& norm,
                           const Lanes& kinetic, double lost) {
  const double kept = 1.0 - lost;
  Lanes heat = kinetic;
  for (std::size_t k = 0; k < norm.value.size(); ++k) {
    Lanes sum{};
    for (int a = 0; a < Dim; ++a) {
      const Lanes change = end[k][a] - start[k][a];
      const Lanes residual = old[k][a] - start[k][a];
      const bool keeps = keeps_mode<Kept>(k);
      // (1 - kappa^2)/2 without cancellation
      const double decay = keeps ? lost * (1.0 - 0.5 * lost) : 0.5;
      sum += residual * (decay * residual) - change * (0.5 * change) -
             start[k][a] * (lost * end[k][a]);
      if (!keeps && Kept != Keeps::nothing) sum += residual * (kept * end[k][a]);
    }
    heat += norm.value[k] * sum;
  }
  return heat;
}

/// Modes after the step.
template <int Dim, Modes M, Keeps Kept>
inline ModeLanes<Dim, M> new_modes(const ModeLanes<Dim, M>& old, const ModeLanes<Dim, M>& start,
                                   const ModeLanes<Dim, M>& end, double lost) {
  ModeLanes<Dim, M> result = end;
  for (std::size_t k = 0; k < end.size(); ++k) {
    if (!keeps_mode<Kept>(k)) continue;
    for (int a = 0; a < Dim; ++a) {
      // The old value comes first: where nothing happens not a bit of it changes.
      result[k][a] = (old[k][a] + (end[k][a] - start[k][a])) - lost * (old[k][a] - start[k][a]);
    }
  }
  return result;
}

/// Where the heat would be negative, shortens the modes beyond the velocity just so far that it is
/// zero, up to `rounding` (J/kg), so that rounding alone never shortens. A velocity that keeps its
/// residual beside modes that do not may gain energy by the cross term; the modes, which follow the
/// grid, are long enough to pay for it, since |R|^2 + 2 kappa R.M' >= -kappa^2 |M'|^2. Returns how
/// many of the first `count` were shortened by more than a tenth.
template <int Dim, Modes M>
inline int shorten(const ModeNorms<Dim, M>& norm, int count, ModeLanes<Dim, M>& modes,
                   const Lanes& rounding, Lanes& heat) {
  Lanes energy{};
  for (std::size_t k = 1; k < modes.size(); ++k) {
    Lanes square{};
    for (int a = 0; a < Dim; ++a) square += modes[k][a] * modes[k][a];
    energy += norm.value[k] * square;
  }
  const Lanes zero{}, one = 1.0 - zero, low = heat + rounding;
  const Lanes missing = where_less(low, zero, low, zero);
  const Lanes square = one + (2.0 * missing) / where_less(zero, energy, energy, one);
  const Lanes factor = square_root(larger(zero, square));
  heat = heat - missing;
  for (std::size_t k = 1; k < modes.size(); ++k) {
    for (int a = 0; a < Dim; ++a) modes[k][a] = factor * modes[k][a];
  }
  return std::popcount(bits_less(factor, 0.9 - zero) & first_bits(count));
}

/// Turns the affine part with the material over a step, A <- A R^T: a gradient that is carried
/// along changes by -dt C C, of which this is the part that does not change its size. R is the
/// Cayley form of the spin of the gradient.
template <int Dim, Modes M>
inline void turn_affine(const std::array<std::array<Lanes, lane_count>, Dim>& gradient, double dt,
                        ModeLanes<Dim, M>& modes) {
  // Half the angle of the turn about each axis; of xy in the plane.
  const auto spin = [&](int a, int b) { return (0.25 * dt) * (gradient[a][b] - gradient[b][a]); };
  if constexpr (Dim == 2) {
    const Lanes t = spin(0, 1);
    const Lanes scale = (1.0 - Lanes{}) / (1.0 - (Lanes{} - t * t));
    const Lanes cosine = scale * (1.0 - t * t), sine = scale * (t + t);
    for (int a = 0; a < 2; ++a) {
      const Lanes x = modes[1][a], y = modes[2][a];
      modes[1][a] = cosine * x - sine * y;
      modes[2][a] = sine * x + cosine * y;
    }
  } else {
    const std::array<Lanes, 3> t = {spin(1, 2), spin(2, 0), spin(0, 1)};
    const Lanes square = t[0] * t[0] + t[1] * t[1] + t[2] * t[2];
    const Lanes scale = (2.0 - Lanes{}) / (1.0 - (Lanes{} - square));
    const auto cross = [&](const std::array<Lanes, 3>& x) {
      return std::array<Lanes, 3>{t[1] * x[2] - t[2] * x[1], t[2] * x[0] - t[0] * x[2],
                                  t[0] * x[1] - t[1] * x[0]};
    };
    for (int a = 0; a < 3; ++a) {
      const std::array<Lanes, 3> x = {modes[1][a], modes[2][a], modes[3][a]};
      const std::array<Lanes, 3> once = cross(x), twice = cross(once);
      for (int k = 0; k < 3; ++k) modes[1 + k][a] = x[k] + scale * (once[k] + twice[k]);
    }
  }
}

}  // namespace poreshock
