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

/// True where a particle sits in the middle of three jumps between nodes along every axis, from
/// which the artificial viscosity can be limited.
template <class Spline>
inline constexpr bool shows_jumps = Spline::width == 4;

/// Moments over a stencil: values of all nodal lanes, of the velocities gradients (per m) and
/// moments (cells, squared cells), and along each axis the velocity across the lines of nodes.
template <int Dim, Modes M, bool Jumps>
struct Moments {
  Lanes value;
  std::array<VelocityLanes<Dim>, Dim> gradient;
  std::array<VelocityLanes<Dim>, higher_modes<Dim, M>> mode;
  std::array<Lanes, Jumps ? Dim - 1 : 0> across;  ///< end velocity a at the nodes of axis a
  std::array<double, Dim> local;                  ///< in the stencil cell, cells
};

/// Weights of one particle along its axes, times `scale` each: value, slope, value times offset and
/// its square.
template <int Dim>
struct PointWeights {
  static constexpr std::size_t size = Dim == 2 ? lane_count : 2 * lane_count;
  alignas(64) double value[size], slope[size], moment[size], square[size];
  std::array<double, Dim> local;
};

template <int Dim, class Spline>
inline void set_point_weights(const Spline& spline, const Particles<Dim>& particles,
                              std::uint32_t p, const std::array<int, Dim>& base,
                              double inverse_cell, PointWeights<Dim>& w) {
  const auto store = [&w](const AxisLanes& lanes, int first) {
    const Lanes moment = lanes.value * lanes.offset;
    *reinterpret_cast<Lanes*>(w.value + first) = lanes.value;
    *reinterpret_cast<Lanes*>(w.slope + first) = lanes.slope;
    *reinterpret_cast<Lanes*>(w.moment + first) = moment;
    *reinterpret_cast<Lanes*>(w.square + first) = moment * lanes.offset;
  };
  for_each_axis_pair<Dim>(spline, particles, p, base, inverse_cell, store);
  for (int a = 0; a < Dim; ++a) {
    w.local[a] = local_place<Spline>(particles.position[a][p] * inverse_cell, base[a]);
  }
}

/// Velocities of a stencil summed with the weights of all axes but one: what a particle sees along
/// each axis.
template <int Dim, class Spline>
using AxisProfiles = std::array<std::array<VelocityLanes<Dim>, Spline::width>, Dim>;

/// sum of weights times a profile.
template <int Dim, std::size_t Width>
inline VelocityLanes<Dim> along(const double* weights,
                                const std::array<VelocityLanes<Dim>, Width>& profile) {
  VelocityLanes<Dim> sum = weights[0] * profile[0];
  for (std::size_t n = 1; n < Width; ++n) sum = fused(weights[n], profile[n], sum);
  return sum;
}

/// Profiles, values and mixed moments in the plane.
template <class Spline, Modes M, bool Jumps>
inline void gather_lines(const PointWeights<2>& w, const Lanes* nodes,
                         AxisProfiles<2, Spline>& profile, Moments<2, M, Jumps>& m) {
  constexpr int width = Spline::width;
  const double* const y = w.value + 4;
  HalfLanes mixed{};
  m.value = Lanes{};
  profile[0] = {};
#pragma GCC unroll 4
  for (int j = 0; j < width; ++j) {
    const Lanes* const line = nodes + j * width;
    Lanes value = w.value[0] * line[0];
    HalfLanes moment{};
    if constexpr (M == Modes::quadratic) moment = w.moment[0] * low_half(line[0]);
    profile[0][0] = fused(y[j], low_half(line[0]), profile[0][0]);
#pragma GCC unroll 4
    for (int i = 1; i < width; ++i) {
      value = fused(w.value[i], line[i], value);
      profile[0][i] = fused(y[j], low_half(line[i]), profile[0][i]);
      if constexpr (M == Modes::quadratic) moment = fused(w.moment[i], low_half(line[i]), moment);
    }
    m.value = fused(y[j], value, m.value);
    profile[1][j] = low_half(value);
    if constexpr (M == Modes::quadratic) mixed = fused(w.moment[4 + j], moment, mixed);
  }
  if constexpr (M == Modes::quadratic) m.mode[2 + 2] = mixed;
}

/// Profiles, values and mixed moments in space.
template <class Spline, Modes M, bool Jumps>
inline void gather_lines(const PointWeights<3>& w, const Lanes* nodes,
                         AxisProfiles<3, Spline>& profile, Moments<3, M, Jumps>& m) {
  constexpr int width = Spline::width;
  constexpr bool mixed = M == Modes::quadratic;
  const double* const y = w.value + 4;
  Lanes xy{}, yz{}, zx{};
  profile[0] = profile[1] = {};
  for (int k = 0; k < width; ++k) {
    std::array<Lanes, width> column{};
    Lanes plane{}, plane_x{}, plane_y{}, plane_xy{};
    const double z = w.value[8 + k];
    for (int j = 0; j < width; ++j) {
      const Lanes* const line = nodes + (k * width + j) * width;
      Lanes value = w.value[0] * line[0], moment{};
      if constexpr (mixed) moment = w.moment[0] * line[0];
      column[0] = fused(y[j], line[0], column[0]);
      for (int i = 1; i < width; ++i) {
        value = fused(w.value[i], line[i], value);
        column[i] = fused(y[j], line[i], column[i]);
        if constexpr (mixed) moment = fused(w.moment[i], line[i], moment);
      }
      plane = fused(y[j], value, plane);
      profile[1][j] = fused(z, value, profile[1][j]);
      if constexpr (mixed) {
        plane_x = fused(y[j], moment, plane_x);
        plane_y = fused(w.moment[4 + j], value, plane_y);
        plane_xy = fused(w.moment[4 + j], moment, plane_xy);
      }
    }
    for (int i = 0; i < width; ++i) profile[0][i] = fused(z, column[i], profile[0][i]);
    profile[2][k] = plane;
    if constexpr (mixed) {
      xy = fused(z, plane_xy, xy);
      yz = fused(w.moment[8 + k], plane_y, yz);
      zx = fused(w.moment[8 + k], plane_x, zx);
    }
  }
  m.value = along<3>(w.value + 8, profile[2]);
  if constexpr (mixed) m.mode[6] = xy, m.mode[7] = yz, m.mode[8] = zx;
}

/// Component a of the end velocities at the four nodes of a profile; they lie in the low half.
template <int Component, class Number>
inline HalfLanes lane_of(const std::array<Number, 4>& profile) {
  const auto half = [&](int n) {
    if constexpr (std::is_same_v<Number, HalfLanes>) {
      return profile[n];
    } else {
      return low_half(profile[n]);
    }
  };
  HalfLanes a, b;
  if constexpr (Component == 1) {
    a = __builtin_shufflevector(half(0), half(1), 1, 5, 3, 7);
    b = __builtin_shufflevector(half(2), half(3), 1, 5, 3, 7);
  } else {
    a = __builtin_shufflevector(half(0), half(1), 0, 4, 2, 6);
    b = __builtin_shufflevector(half(2), half(3), 0, 4, 2, 6);
  }
  if constexpr (Component == 2) {
    return __builtin_shufflevector(a, b, 2, 3, 6, 7);
  } else {
    return __builtin_shufflevector(a, b, 0, 1, 4, 5);
  }
}

/// Filled in place: a copy would wait for its stores.
template <int Dim, class Spline, Modes M>
inline void take_moments(const PointWeights<Dim>& w, const Lanes* nodes,
                         Moments<Dim, M, shows_jumps<Spline>>& m) {
  AxisProfiles<Dim, Spline> profile;
  gather_lines<Spline, M>(w, nodes, profile, m);
  for (int a = 0; a < Dim; ++a) {
    m.gradient[a] = along<Dim>(w.slope + 4 * a, profile[a]);
    if constexpr (M != Modes::constant) m.mode[a] = along<Dim>(w.moment + 4 * a, profile[a]);
    if constexpr (M == Modes::quadratic) {
      m.mode[Dim + a] = along<Dim>(w.square + 4 * a, profile[a]);
    }
  }
  if constexpr (shows_jumps<Spline>) {
    constexpr int end = MotionLane<Dim>::end_velocity;
    m.across[0] = join(lane_of<end>(profile[0]), lane_of<end + 1>(profile[1]));
    if constexpr (Dim == 3) {
      const HalfLanes z = lane_of<end + 2>(profile[2]);
      m.across[1] = join(z, z);
    }
  }
  m.local = w.local;
}

/// Moments of eight particles, a particle a lane.
template <int Dim, Modes M>
struct GroupMoments {
  std::array<Lanes, lane_count> value;                      ///< [lane of the nodes]
  std::array<std::array<Lanes, lane_count>, Dim> gradient;  ///< [direction][lane], per m
  /// [mode][lane], moments in cells and squared cells
  std::array<std::array<Lanes, lane_count>, higher_modes<Dim, M>> mode;
  std::array<std::array<Lanes, 4>, Dim> across;  ///< [axis][node], times a power of scale
  std::array<Lanes, Dim> local;
};

/// Turns vectors of eight particles, part(particle), into a particle a lane.
template <class Part>
inline void turn(Part&& part, std::array<Lanes, lane_count>& result) {
  for (int n = 0; n < lane_count; ++n) result[n] = part(n);
  transpose(result.data());
}

/// Turns velocities of eight particles: in 2-D they fill half a vector, so two kinds share one.
template <int Dim, std::size_t Count, class Part>
inline void turn_velocities(Part&& part, std::array<std::array<Lanes, lane_count>, Count>& result) {
  if constexpr (Dim == 3) {
    for (std::size_t k = 0; k < Count; ++k) turn([&](int n) { return part(n, k); }, result[k]);
  } else {
    for (std::size_t k = 0; k < Count; k += 2) {
      const std::size_t next = k + 1 < Count ? k + 1 : k;
      std::array<Lanes, lane_count> pair;
      turn([&](int n) { return join(part(n, k), part(n, next)); }, pair);
      for (int l = 0; l < 4; ++l) result[k][l] = pair[l], result[next][l] = pair[4 + l];
    }
  }
}

/// Turns the scaled moments of a group into true ones, a particle a lane.
template <int Dim, class Spline, Modes M>
inline void group_moments(const Moments<Dim, M, shows_jumps<Spline>>* particles,
                          double inverse_cell, GroupMoments<Dim, M>& g) {
  turn([&](int n) { return particles[n].value; }, g.value);
  turn_velocities<Dim>([&](int n, std::size_t k) { return particles[n].gradient[k]; }, g.gradient);
  constexpr double inverse_scale = 1.0 / total_scale<Dim, Spline>;
  for (Lanes& x : g.value) x = unscaled<Dim, Spline>(x);
  for (auto& gradient : g.gradient) {
    for (int a = 0; a < 2 * Dim; ++a) gradient[a] *= inverse_scale * inverse_cell;
  }
  if constexpr (M != Modes::constant) {
    turn_velocities<Dim>([&](int n, std::size_t k) { return particles[n].mode[k]; }, g.mode);
    for (auto& mode : g.mode) {
      for (int a = 0; a < 2 * Dim; ++a) mode[a] *= inverse_scale;
    }
  }
  if constexpr (shows_jumps<Spline>) {
    std::array<Lanes, lane_count> axes;
    turn([&](int n) { return particles[n].across[0]; }, axes);
    for (int k = 0; k < 4; ++k) g.across[0][k] = axes[k], g.across[1][k] = axes[4 + k];
    if constexpr (Dim == 3) {
      turn([&](int n) { return particles[n].across[1]; }, axes);
      for (int k = 0; k < 4; ++k) g.across[2][k] = axes[k];
    }
  }
  for (int a = 0; a < Dim; ++a) {
    double local[lane_count];
    for (int n = 0; n < lane_count; ++n) local[n] = particles[n].local[a];
    g.local[a] = *reinterpret_cast<const Lanes*>(local);
  }
}

}  // namespace poreshock
