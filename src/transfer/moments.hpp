#pragma once

/// Moments of nodal lanes over the stencil of a particle, and of eight particles at once.

#include "poreshock/transfer/node_lanes.hpp"
#include "poreshock/transfer/sweep.hpp"

namespace poreshock {

/// The velocities among the lanes of a node, start and end: in 2-D they are the low half.
template <int Dim>
using VelocityLanes = std::conditional_t<Dim == 2, HalfLanes, Lanes>;

template <int Dim>
inline VelocityLanes<Dim> velocities(const Lanes& node) {
  if constexpr (Dim == 2) {
    return low_half(node);
  } else {
    return node;
  }
}

/// Moments over a stencil: values of all nodal lanes, gradients (per m) and first moments (cells)
/// of the velocities along the first `Axes` axes.
template <int Dim, int Axes = Dim>
struct Moments {
  Lanes value;
  std::array<VelocityLanes<Dim>, Axes> gradient;
  std::array<VelocityLanes<Dim>, Axes> moment;
};

/// Weights of one particle along its axes, times `scale` each: value, slope, value times offset.
template <int Dim>
struct PointWeights {
  alignas(64) double value[2 * lane_count], slope[2 * lane_count], moment[2 * lane_count];
  const Lanes* averages = nullptr;  ///< node of the averages at the base of the stencil, 3-D only
};

template <int Dim, class Spline>
inline PointWeights<Dim> point_weights(const Spline& spline, const Particles<Dim>& particles,
                                       std::uint32_t p, const std::array<int, Dim>& base,
                                       double inverse_cell) {
  PointWeights<Dim> w;
  const auto store = [&w](const AxisLanes& lanes, int first) {
    *reinterpret_cast<Lanes*>(w.value + first) = lanes.value;
    *reinterpret_cast<Lanes*>(w.slope + first) = lanes.slope;
    *reinterpret_cast<Lanes*>(w.moment + first) = lanes.value * lanes.offset;
  };
  for_each_axis_pair<Dim>(spline, particles, p, base, inverse_cell, store);
  return w;
}

/// Scaled averages of the dilatation at one particle, 3-D.
template <class Spline>
inline Lanes averages_at(const PointWeights<3>& w, const GridShape& shape) {
  Lanes sum{};
  for (int n = 0; n < stencil_nodes<3, Spline>; ++n) {
    constexpr int width = Spline::width;
    const double plane = w.value[n % width] * w.value[4 + (n / width) % width];
    sum = fused(plane * w.value[8 + n / (width * width)],
                w.averages[node_offset<3, Spline>(shape, n)], sum);
  }
  return sum;
}

/// Moments in one plane of nodes.
template <int Dim, class Spline, bool Affine>
inline Moments<Dim, 2> plane_moments(const PointWeights<Dim>& w, const Lanes* nodes) {
  constexpr int width = Spline::width;
  using Velocities = VelocityLanes<Dim>;
  const double* const y = w.value + 4;
  Moments<Dim, 2> m{};
#pragma GCC unroll 4
  for (int j = 0; j < width; ++j) {
    const Lanes* const line = nodes + j * width;
    Lanes value = w.value[0] * line[0];
    Velocities slope = w.slope[0] * velocities<Dim>(line[0]), moment{};
    if constexpr (Affine) moment = w.moment[0] * velocities<Dim>(line[0]);
#pragma GCC unroll 4
    for (int i = 1; i < width; ++i) {
      value = fused(w.value[i], line[i], value);
      slope = fused(w.slope[i], velocities<Dim>(line[i]), slope);
      if constexpr (Affine) moment = fused(w.moment[i], velocities<Dim>(line[i]), moment);
    }
    m.value = fused(y[j], value, m.value);
    m.gradient[0] = fused(y[j], slope, m.gradient[0]);
    m.gradient[1] = fused(w.slope[4 + j], velocities<Dim>(value), m.gradient[1]);
    if constexpr (Affine) {
      m.moment[0] = fused(y[j], moment, m.moment[0]);
      m.moment[1] = fused(w.moment[4 + j], velocities<Dim>(value), m.moment[1]);
    }
  }
  return m;
}

template <int Dim, class Spline, bool Affine>
inline Moments<Dim> scaled_moments(const PointWeights<Dim>& w, const Lanes* nodes) {
  if constexpr (Dim == 2) {
    return plane_moments<2, Spline, Affine>(w, nodes);
  } else {
    constexpr int width = Spline::width;
    Moments<3> m{};
    for (int k = 0; k < width; ++k) {
      const Moments<3, 2> p = plane_moments<3, Spline, Affine>(w, nodes + k * width * width);
      const double z = w.value[8 + k];
      m.value = fused(z, p.value, m.value);
      m.gradient[0] = fused(z, p.gradient[0], m.gradient[0]);
      m.gradient[1] = fused(z, p.gradient[1], m.gradient[1]);
      m.gradient[2] = fused(w.slope[8 + k], p.value, m.gradient[2]);
      if constexpr (Affine) {
        m.moment[0] = fused(z, p.moment[0], m.moment[0]);
        m.moment[1] = fused(z, p.moment[1], m.moment[1]);
        m.moment[2] = fused(w.moment[8 + k], p.value, m.moment[2]);
      }
    }
    return m;
  }
}

/// Moments of up to eight particles, a particle a lane.
template <int Dim>
struct GroupMoments {
  std::array<Lanes, lane_count> value;                      ///< [lane of the nodes]
  std::array<std::array<Lanes, lane_count>, Dim> gradient;  ///< [direction][lane], per m
  std::array<std::array<Lanes, lane_count>, Dim> moment;    ///< [direction][lane], cells
  Lanes dilatation_end, dilatation_mid;                     ///< averaged, 1/s
};

/// Turns the scaled moments of a group into true ones, a particle a lane.
template <int Dim, class Spline, bool Affine>
inline GroupMoments<Dim> group_moments(const Moments<Dim>* particles, double inverse_cell) {
  GroupMoments<Dim> g;
  const auto turn = [](auto&& part, std::array<Lanes, lane_count>& result) {
    for (int n = 0; n < lane_count; ++n) result[n] = part(n);
    transpose(result.data());
  };
  turn([&](int n) { return particles[n].value; }, g.value);
  if constexpr (Dim == 2) {
    // Only velocities have gradients and moments: four lanes of each vector, so two share one.
    std::array<Lanes, lane_count> pair;
    turn([&](int n) { return join(particles[n].gradient[0], particles[n].gradient[1]); }, pair);
    for (int k = 0; k < 4; ++k) g.gradient[0][k] = pair[k], g.gradient[1][k] = pair[4 + k];
    if constexpr (Affine) {
      turn([&](int n) { return join(particles[n].moment[0], particles[n].moment[1]); }, pair);
      for (int k = 0; k < 4; ++k) g.moment[0][k] = pair[k], g.moment[1][k] = pair[4 + k];
    }
  } else {
    for (int k = 0; k < Dim; ++k) {
      turn([&](int n) { return particles[n].gradient[k]; }, g.gradient[k]);
      if constexpr (Affine) turn([&](int n) { return particles[n].moment[k]; }, g.moment[k]);
    }
  }
  constexpr double inverse_scale = 1.0 / total_scale<Dim, Spline>;
  for (Lanes& x : g.value) x = unscaled<Dim, Spline>(x);
  for (int k = 0; k < Dim; ++k) {
    for (int a = 0; a < 2 * Dim; ++a) g.gradient[k][a] *= inverse_scale * inverse_cell;
    if constexpr (Affine) {
      for (int a = 0; a < Dim; ++a) g.moment[k][a] *= inverse_scale;
    }
  }
  return g;
}

/// Averaged dilatation of a group: in 2-D two lanes of the motion, in 3-D gathered apart.
template <int Dim, class Spline>
inline void take_averages(std::array<Lanes, lane_count>& averages, GroupMoments<Dim>& m) {
  if constexpr (Dim == 2) {
    m.dilatation_end = m.value[MotionLane<2>::dilatation_end];
    m.dilatation_mid = m.value[MotionLane<2>::dilatation_mid];
  } else {
    transpose(averages.data());
    m.dilatation_end = unscaled<Dim, Spline>(averages[AverageLane::end]);
    m.dilatation_mid = unscaled<Dim, Spline>(averages[AverageLane::mid]);
  }
}

}  // namespace poreshock
