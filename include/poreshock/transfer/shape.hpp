#pragma once
// Shape functions on a uniform grid, and the one definition of a particle's stencil cell. s is a
// coordinate in cells from the domain's low side; node index i lies at s = i - 1. A shape function
// is a struct with its width, the lowest node of a stencil (which also names the stencil cell) and
// the weights of one axis.

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

#include "poreshock/scene/scene.hpp"

namespace poreshock {

/// Weights of one axis: value, slope per cell, and offset from the particle in cells.
template <int Width>
struct AxisWeights {
  std::array<double, Width> value, slope, offset;
};

/// Hat function: 2 nodes.
struct LinearHat {
  static constexpr int width = 2;

  static int base(double s) { return static_cast<int>(std::floor(s)) + 1; }

  AxisWeights<2> weights(double s, int base) const {
    const double f = s - static_cast<double>(base - 1);  // 0 ... 1
    return {{1.0 - f, f}, {-1.0, 1.0}, {-f, 1.0 - f}};
  }
};

/// Uniform GIMP: the hat averaged over the particle's edge at the start (Bardenhagen & Kober, CMES
/// 5 (2004) 477), 3 nodes.
struct UniformGimp {
  static constexpr int width = 3;
  double half_length = 0.25;  ///< cells, at most 1/2

  static int base(double s) { return static_cast<int>(std::floor(s - 0.5)) + 1; }

  AxisWeights<3> weights(double s, int base) const {
    const double l = half_length;
    const double b = s - static_cast<double>(base);  // from the middle node, -0.5 ... 0.5
    const double distance = b < 0.0 ? -b : b;
    const double sign = b < 0.0 ? -1.0 : 1.0;
    const bool over = distance < l;  // the particle covers the middle node
    const double middle = over ? 1.0 - (b * b + l * l) / (2.0 * l) : 1.0 - distance;
    const double slope = over ? -b / l : -sign;
    // The outer nodes see the particle only as far as it reaches across the middle one.
    const auto outer = [l](double r) { return r + l > 0.0 ? r + l : 0.0; };
    const double left = outer(-b), right = outer(b);
    const bool in_left = -b >= l, in_right = b >= l;
    const double quarter = 1.0 / (4.0 * l), half = 1.0 / (2.0 * l);
    return {
        {in_left ? -b : quarter * (left * left), middle, in_right ? b : quarter * (right * right)},
        {in_left ? -1.0 : -half * left, slope, in_right ? 1.0 : half * right},
        {-1.0 - b, -b, 1.0 - b}};
  }
};

/// Quadratic B-spline: 3 nodes, sum of N (x_i - x)^2 = cell^2 / 4.
struct QuadraticSpline {
  static constexpr int width = 3;
  static constexpr double inverse_inertia = 4.0;

  static int base(double s) { return static_cast<int>(std::floor(s - 0.5)) + 1; }

  AxisWeights<3> weights(double s, int base) const {
    const double f = s - static_cast<double>(base - 1);  // 0.5 ... 1.5
    const double a = 1.5 - f, b = f - 1.0, c = f - 0.5;
    return {
        {0.5 * (a * a), 0.75 - b * b, 0.5 * (c * c)}, {-a, -2.0 * b, c}, {-f, 1.0 - f, 2.0 - f}};
  }
};

/// Cubic B-spline: 4 nodes, sum of N (x_i - x)^2 = cell^2 / 3.
struct CubicSpline {
  static constexpr int width = 4;
  static constexpr double inverse_inertia = 3.0;

  static int base(double s) { return static_cast<int>(std::floor(s)); }

  /// x / 6 without a division. The double nearest 1/6 is too small by 2^-54 of itself; with it
  /// alone the weights would sum to less than 1 on the average, and momentum would fade step by
  /// step.
  static double sixth_of(double x) {
    constexpr double sixth = 1.0 / 6.0, missing = sixth * 0x1p-54;
    return std::fma(x, sixth, x * missing);
  }

  AxisWeights<4> weights(double s, int base) const {
    const double f = s - static_cast<double>(base);  // 0 ... 1
    const double g = 1.0 - f;
    const double f2 = f * f, g2 = g * g;
    return {{sixth_of(g2 * g), sixth_of(4.0 + f2 * (3.0 * f - 6.0)),
             sixth_of(4.0 + g2 * (3.0 * g - 6.0)), sixth_of(f2 * f)},
            {-0.5 * g2, f * (1.5 * f - 2.0), g * (2.0 - 1.5 * g), 0.5 * f2},
            {-1.0 - f, -f, g, 1.0 + g}};
  }
};

/// B-splines: the shapes that APIC and PIC are made for.
template <class Shape>
inline constexpr bool is_spline =
    std::is_same_v<Shape, QuadraticSpline> || std::is_same_v<Shape, CubicSpline>;

/// True where particle velocities are replaced by the grid's, so that nodes lose kinetic energy.
inline bool projects(VelocityTransfer velocity) {
  return velocity == VelocityTransfer::apic || velocity == VelocityTransfer::pic;
}

/// Calls run(shape function) with the one the scene asks for: the run-time choice becomes a type.
template <class Run>
inline void with_shape(const Transfer& transfer, Run&& run) {
  switch (transfer.shape) {
    case ShapeFunction::linear:
      return run(LinearHat{});
    case ShapeFunction::gimp:
      return run(UniformGimp{transfer.half_length});
    case ShapeFunction::quadratic:
      return run(QuadraticSpline{});
    case ShapeFunction::cubic:
      return run(CubicSpline{});
  }
}

/// The same for the hat and its average over the particle, the shapes that MUSL is made for.
template <class Run>
inline void with_hat(const Transfer& transfer, Run&& run) {
  transfer.shape == ShapeFunction::linear ? run(LinearHat{})
                                          : run(UniformGimp{transfer.half_length});
}

/// Lowest node of the stencil at s along an axis of `nodes` nodes, for a stencil of `width` nodes.
/// A coordinate that rounds to the far end of the domain belongs to the last cell.
inline int stencil_base(int width, double s, int nodes) {
  if (width == 3) return QuadraticSpline::base(s);
  return std::min(width == 4 ? CubicSpline::base(s) : LinearHat::base(s), nodes - width);
}

}  // namespace poreshock
