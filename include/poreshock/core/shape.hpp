#pragma once
// Shape functions on a uniform grid, and the one definition of a particle's stencil cell. s is a
// coordinate in cells from the domain's low side; node index i lies at s = i - 1. A shape function
// is a struct that tells all there is to know about one: its names, the nodes of an axis that it
// reaches, its moments, what of it lies beyond a wall, and its weights. Weights come times `scale`,
// a whole number, so that their sum is exact: unscaled() takes the power of it out again.

#include <algorithm>
#include <array>
#include <cmath>
#include <string_view>
#include <tuple>

#include "poreshock/core/lanes.hpp"

namespace poreshock {

enum class ShapeFunction { linear, gimp, quadratic, cubic };

/// Weights of one axis, a node a lane: `scale` times value and slope per cell, and offset from the
/// particle in cells. Lanes that stand for no node of the stencil have value and slope 0.
struct AxisLanes {
  Lanes value, slope, offset;
};

/// get(node) in every lane: the four nodes of a line of an axis, 0 ... 3 above the base, twice.
template <class Get>
constexpr Lanes by_node(Get&& get) {
  return Lanes{get(0), get(1), get(2), get(3), get(0), get(1), get(2), get(3)};
}

/// A weight as a polynomial: constant + u^2 (square + cube u) with u = origin + sign f.
struct WeightPolynomial {
  double origin, sign, constant, square, cube;
};

/// What stands for the slope of a B-spline: its derivative, or its first moment over the second, N
/// (x_i - x)/D, which tells the gradient of linear fields exactly too (Hu et al., TOG 37 (2018)
/// 150). Where N vanishes the derivative is large beside it, the moment is not.
enum class Gradient { slopes, moments };

/// Weights of a B-spline at f: its lanes may hold the coordinates of different axes.
template <class Spline>
inline AxisLanes spline_lanes(const Lanes& f, Gradient gradient) {
  constexpr auto& node = Spline::polynomial;
  constexpr Lanes origin = by_node([](int n) { return node[n].origin; });
  constexpr Lanes sign = by_node([](int n) { return node[n].sign; });
  constexpr Lanes constant = by_node([](int n) { return node[n].constant; });
  constexpr Lanes square = by_node([](int n) { return node[n].square; });
  constexpr Lanes cube = by_node([](int n) { return node[n].cube; });
  constexpr Lanes place = by_node([](int n) { return static_cast<double>(n - Spline::lowest); });
  const Lanes u = fused(sign, f, origin);
  const Lanes value = fused(u * u, fused(cube, u, square), constant), offset = place - f;
  const Lanes slope = gradient == Gradient::moments
                          ? Spline::inverse_inertia * (value * offset)
                          : u * fused((3.0 * sign) * cube, u, (2.0 * sign) * square);
  return {value, slope, offset};
}

/// Weights of a hat.
template <int Width>
inline AxisLanes hat_lanes(const std::array<double, Width>& value,
                           const std::array<double, Width>& slope, double f) {
  const auto of = [](const auto& numbers) {
    return by_node([&](int n) { return n < Width ? numbers[n] : 0.0; });
  };
  return {of(value), of(slope), by_node([&](int n) { return n - f; })};
}

/// Hat function.
struct LinearHat {
  static constexpr ShapeFunction kind = ShapeFunction::linear;
  static constexpr std::string_view name = "linear";
  static constexpr int width = 2;   ///< nodes of an axis that it reaches, 4 at most
  static constexpr int lowest = 0;  ///< place of the lowest of them where f is 0
  static constexpr double scale = 1.0;
  static constexpr int smoothness = 0;  ///< derivatives that are continuous
  /// Order up to which the moments sum N (x_i - x)^k are the same everywhere in a cell.
  static constexpr int constant_moments = 1;
  static constexpr double closing_cells = 1.5;  ///< surfaces nearer to each other feel each other

  /// Share of the shape function of a node one cell inside a plane that reaches beyond it.
  double share_beyond() const { return 0.0; }
  AxisLanes lanes(double f) const { return hat_lanes<2>({1.0 - f, f}, {-1.0, 1.0}, f); }
};

/// Uniform GIMP: the hat averaged over the particle's edge at the start (Bardenhagen & Kober, CMES
/// 5 (2004) 477).
struct UniformGimp {
  static constexpr ShapeFunction kind = ShapeFunction::gimp;
  static constexpr std::string_view name = "gimp";
  static constexpr int width = 3;
  static constexpr int lowest = 0;
  static constexpr double scale = 1.0;
  static constexpr int smoothness = 1;
  static constexpr int constant_moments = 1;
  static constexpr double closing_cells = 2.0;
  double half_length = 0.25;  ///< cells, at most 1/2

  double share_beyond() const { return half_length * half_length / 12.0; }
  AxisLanes lanes(double f) const {
    const double l = half_length;
    const double b = f - 1.0;  // from the middle node, -0.5 ... 0.5
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
    return hat_lanes<3>(
        {in_left ? -b : quarter * (left * left), middle, in_right ? b : quarter * (right * right)},
        {in_left ? -1.0 : -half * left, slope, in_right ? 1.0 : half * right}, f);
  }
};

/// Quadratic B-spline.
struct QuadraticSpline {
  static constexpr ShapeFunction kind = ShapeFunction::quadratic;
  static constexpr std::string_view name = "quadratic";
  static constexpr int width = 3;
  static constexpr int lowest = 0;
  static constexpr double scale = 2.0;
  static constexpr int smoothness = 1;
  static constexpr int constant_moments = 2;
  static constexpr double inverse_inertia = 4.0;  ///< cell^2 / sum of N (x_i - x)^2
  static constexpr double stiffness = 6.0;  ///< most that the nodes' slope^2 / weight add up to
  static constexpr double closing_cells = 2.5;
  static constexpr std::array<WeightPolynomial, 4> polynomial = {
      {{1.5, -1.0, 0.0, 1.0, 0.0}, {-1.0, 1.0, 1.5, -2.0, 0.0}, {-0.5, 1.0, 0.0, 1.0, 0.0}, {}}};

  Gradient gradient = Gradient::slopes;

  double share_beyond() const { return 1.0 / 48.0; }
  AxisLanes lanes(double f) const { return spline_lanes<QuadraticSpline>(f - Lanes{}, gradient); }
};

/// Cubic B-spline.
struct CubicSpline {
  static constexpr ShapeFunction kind = ShapeFunction::cubic;
  static constexpr std::string_view name = "cubic";
  static constexpr int width = 4;
  static constexpr int lowest = 1;
  static constexpr double scale = 6.0;
  static constexpr int smoothness = 2;
  static constexpr int constant_moments = 3;
  static constexpr double inverse_inertia = 3.0;
  static constexpr double stiffness = 3.14;
  static constexpr double closing_cells = 3.5;
  static constexpr std::array<WeightPolynomial, 4> polynomial = {{{1.0, -1.0, 0.0, 0.0, 1.0},
                                                                  {0.0, 1.0, 4.0, -6.0, 3.0},
                                                                  {1.0, -1.0, 4.0, -6.0, 3.0},
                                                                  {0.0, 1.0, 0.0, 0.0, 1.0}}};

  Gradient gradient = Gradient::slopes;

  double share_beyond() const { return 1.0 / 24.0; }
  AxisLanes lanes(double f) const { return spline_lanes<CubicSpline>(f - Lanes{}, gradient); }
};

/// All of them, in the order of their names in a message.
using ShapeFunctions = std::tuple<LinearHat, UniformGimp, QuadraticSpline, CubicSpline>;

inline constexpr std::array shape_functions =
    std::apply([](const auto&... shape) { return std::array{shape.kind...}; }, ShapeFunctions{});

/// Returns run(shape function) with the one of this kind: the run-time choice becomes a type.
/// @param half_length cells, half the edge of a particle; for shapes that have one
template <std::size_t Number = 0, class Run>
constexpr decltype(auto) with_shape(ShapeFunction kind, double half_length, Run&& run) {
  using Shape = std::tuple_element_t<Number, ShapeFunctions>;
  if constexpr (Number + 1 < std::tuple_size_v<ShapeFunctions>) {
    if (kind != Shape::kind) return with_shape<Number + 1>(kind, half_length, run);
  }
  if constexpr (requires { Shape{half_length}; }) {
    return run(Shape{half_length});
  } else {
    return run(Shape{});
  }
}

/// Returns get(shape function) of one whose particles' edge does not matter.
template <class Get>
constexpr auto of_shape(ShapeFunction kind, Get&& get) {
  return with_shape(kind, 0.0, get);
}

/// True for shapes whose second moment is constant, which B-splines have: the inertia of affine
/// motion and the spread of heat are then one number.
template <class Shape>
inline constexpr bool has_inertia = Shape::constant_moments >= 2;

/// scale^axes of a shape function.
template <int Axes, class Spline>
inline constexpr double total_scale = Axes == 1
                                          ? Spline::scale
                                          : (Axes == 2
                                                 ? Spline::scale * Spline::scale
                                                 : Spline::scale * Spline::scale * Spline::scale);

/// 1/scale^axes as a double and what that double misses.
template <int Axes, class Spline>
struct InverseScale {
  static constexpr double nearest = 1.0 / total_scale<Axes, Spline>;
  static constexpr double missing =
      static_cast<double>((1.0L - static_cast<long double>(nearest) * total_scale<Axes, Spline>) /
                          total_scale<Axes, Spline>);
};

/// x / scale^axes without a division. The double nearest the inverse alone would be off by the same
/// share every time, and momentum would fade step by step.
template <int Axes, class Spline>
inline double unscaled(double x) {
  using Inverse = InverseScale<Axes, Spline>;
  return std::fma(x, Inverse::nearest, x * Inverse::missing);
}
template <int Axes, class Spline>
inline Lanes unscaled(const Lanes& x) {
  using Inverse = InverseScale<Axes, Spline>;
  return fused(Inverse::nearest, x, x * Inverse::missing);
}

/// Weights of one axis, unscaled: value, slope per cell, and offset from the particle in cells.
template <int Width>
struct AxisWeights {
  std::array<double, Width> value, slope, offset;
};

/// Lowest node of the stencil of `width` nodes at s; it names the stencil cell.
inline int stencil_base(int width, double s) {
  return static_cast<int>(std::floor(s - (width % 2 == 0 ? 0.0 : 0.5))) + 2 - width / 2;
}

/// The same on an axis of `nodes` nodes: a coordinate that rounds to the far end of the domain
/// belongs to the last cell.
inline int stencil_base(int width, double s, int nodes) {
  return std::min(stencil_base(width, s), nodes - width);
}

/// f, the coordinate in the stencil cell of this base: 0 ... 1, or 1/2 ... 3/2 for odd widths.
template <class Shape>
inline double local_place(double s, int base) {
  return s - static_cast<double>(base - 1 + Shape::lowest);
}

/// Weights of the stencil with this base at s.
template <class Spline>
inline AxisWeights<Spline::width> axis_weights(const Spline& spline, double s, int base) {
  const AxisLanes lanes = spline.lanes(local_place<Spline>(s, base));
  AxisWeights<Spline::width> w;
  for (int n = 0; n < Spline::width; ++n) {
    w.value[n] = unscaled<1, Spline>(lanes.value[n]);
    w.slope[n] = unscaled<1, Spline>(lanes.slope[n]);
    w.offset[n] = lanes.offset[n];
  }
  return w;
}

/// Weights of two axes along their lines: the first in the low half, the second in the high one.
template <class Spline>
inline AxisLanes weights_of_two(const Spline& spline, double f, double g) {
  const AxisLanes a = spline.lanes(f), b = spline.lanes(g);
  return {join(low_half(a.value), high_half(b.value)), join(low_half(a.slope), high_half(b.slope)),
          join(low_half(a.offset), high_half(b.offset))};
}

/// Splines take both axes at once.
template <class Spline>
requires requires {
  Spline::polynomial;
}
inline AxisLanes weights_of_two(const Spline& spline, double f, double g) {
  return spline_lanes<Spline>(join(f - HalfLanes{}, g - HalfLanes{}), spline.gradient);
}

}  // namespace poreshock
