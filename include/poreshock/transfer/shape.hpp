#pragma once
// B-spline shape functions on a uniform grid, and the one definition of a particle's stencil cell.
// s is a coordinate in cells from the domain's low side; node index i lies at s = i - 1.

#include <array>
#include <cmath>

namespace poreshock {

/// Weights of one axis: value, slope per cell, and offset from the particle in cells.
template <int Width>
struct AxisWeights {
  std::array<double, Width> value, slope, offset;
};

/// Quadratic B-spline: 3 nodes, sum of N (x_i - x)^2 = cell^2 / 4.
struct QuadraticSpline {
  static constexpr int width = 3;
  static constexpr double inverse_inertia = 4.0;

  /// Lowest node of the stencil; it also names the stencil cell.
  static int base(double s) { return static_cast<int>(std::floor(s - 0.5)) + 1; }

  static AxisWeights<3> weights(double s, int base) {
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

  static AxisWeights<4> weights(double s, int base) {
    const double f = s - static_cast<double>(base);  // 0 ... 1
    const double g = 1.0 - f;
    const double f2 = f * f, g2 = g * g;
    constexpr double sixth = 1.0 / 6.0;
    return {{sixth * (g2 * g), sixth * (4.0 + f2 * (3.0 * f - 6.0)),
             sixth * (4.0 + g2 * (3.0 * g - 6.0)), sixth * (f2 * f)},
            {-0.5 * g2, f * (1.5 * f - 2.0), g * (2.0 - 1.5 * g), 0.5 * f2},
            {-1.0 - f, -f, g, 1.0 + g}};
  }
};

}  // namespace poreshock
