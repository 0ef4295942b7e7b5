#pragma once

/// Which share of the artificial viscosity acts: none where the velocity of the nodes is smooth.

#include "moments.hpp"

namespace poreshock {

/// Limiters of the two viscosities of one axis: 0 at a shock, 1 where nothing acts.
struct JumpLimiters {
  double linear, quadratic;
};

/// Limiters from three neighbouring velocity jumps between nodes, 1 where all are equal, 0 where
/// one is alone. For the linear viscosity the mean of both ratios of neighbours, at most three
/// times the lesser (Christensen, UCRL-JC-105269 (1990); LULESH has twice), which leaves a
/// precursor sharp. For the quadratic one the lesser ratio to the fourth power: it acts over the
/// whole width of a strong front and so keeps the state behind it quiet. Where the middle jump
/// vanishes beside its neighbours, ratios fall to 0 instead of jumping from one infinity to the
/// other: at the foot of a front rounding alone would decide between all and nothing.
inline JumpLimiters jump_limiters(double before, double own, double after) {
  constexpr double smallest = 1e-6;
  const auto size = [](double x) { return x < 0.0 ? -x : x; };
  const double floor = smallest * (size(before) + size(own) + size(after));
  const double divisor = own * own + floor * floor;
  const bool still = divisor == 0.0;
  const double inverse = own / (still ? 1.0 : divisor);
  const double r = before * inverse, s = after * inverse;
  const double lesser = r < s ? r : s;
  const double less = lesser > 0.0 ? lesser : 0.0;
  const double mean = 0.5 * (r + s);
  const double most = 3.0 * less;
  const double steep = mean < most ? mean : most;
  const double floored = steep > 0.0 ? steep : 0.0;
  const double linear = floored < 1.0 ? floored : 1.0;
  const double least = less < 1.0 ? less : 1.0;
  const double square = least * least;
  return {still ? 1.0 : linear, still ? 1.0 : square * square};
}

/// Shares of the linear and the quadratic artificial viscosity of eight particles.
struct ViscousShares {
  Lanes linear, quadratic;
};

/// 1 - limiter, a mean over the axes along which the material closes, weighted with how fast it
/// does. Uniform stretching and turning give 0.
template <int Dim, Modes M>
inline ViscousShares viscous_shares(const GroupMoments<Dim, M>& m) {
  double linear[lane_count] = {}, quadratic[lane_count] = {}, closing[lane_count] = {};
  for (int a = 0; a < Dim; ++a) {
    double node[4][lane_count], slope[lane_count];
    for (int k = 0; k < 4; ++k) *reinterpret_cast<Lanes*>(node[k]) = m.across[a][k];
    *reinterpret_cast<Lanes*>(slope) = m.gradient[a][MotionLane<Dim>::end_velocity + a];
    for (int n = 0; n < lane_count; ++n) {
      const JumpLimiters limiter =
          jump_limiters(node[1][n] - node[0][n], node[2][n] - node[1][n], node[3][n] - node[2][n]);
      const double w = slope[n] < 0.0 ? -slope[n] : 0.0;
      linear[n] += w * (1.0 - limiter.linear);
      quadratic[n] += w * (1.0 - limiter.quadratic);
      closing[n] += w;
    }
  }
  const Lanes sum = *reinterpret_cast<const Lanes*>(closing);
  const Lanes all = where_less(Lanes{}, sum, sum, 1.0 - Lanes{});
  return {*reinterpret_cast<const Lanes*>(linear) / all,
          *reinterpret_cast<const Lanes*>(quadratic) / all};
}

}  // namespace poreshock
