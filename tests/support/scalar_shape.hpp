#pragma once
// Shape functions in the formulas of the textbooks, the nodes that a point sees, and particles as
// vectors and matrices: plain loops, nothing shared with the kernels.

#include <algorithm>
#include <cmath>

#include "poreshock/core/tensor.hpp"
#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/particles/particles.hpp"

namespace poreshock::reference {

/// Hat function at distance r (cells) from its node.
inline double hat(double r) {
  return std::max(0.0, 1.0 - std::abs(r));
}

/// Integral of the hat function up to r.
inline double hat_integral(double r) {
  if (r <= -1.0) return 0.0;
  if (r >= 1.0) return 1.0;
  return r < 0.0 ? 0.5 * (1.0 + r) * (1.0 + r) : 1.0 - 0.5 * (1.0 - r) * (1.0 - r);
}

/// Shape function at distance r (cells) from its node; uniform GIMP as the mean of the hat over the
/// particle.
inline double spline(const GridShape& shape, double r) {
  const double a = std::abs(r), l = shape.half_length;
  switch (shape.function) {
    case ShapeFunction::linear:
      return hat(r);
    case ShapeFunction::gimp:
      return (hat_integral(r + l) - hat_integral(r - l)) / (2.0 * l);
    case ShapeFunction::quadratic:
      if (a < 0.5) return 0.75 - a * a;
      return a < 1.5 ? 0.5 * (1.5 - a) * (1.5 - a) : 0.0;
    case ShapeFunction::cubic:
      break;
  }
  if (a < 1.0) return 2.0 / 3.0 - a * a + 0.5 * a * a * a;
  return a < 2.0 ? (2.0 - a) * (2.0 - a) * (2.0 - a) / 6.0 : 0.0;
}

/// Its derivative by r, per cell; a hat has none at its node.
inline double spline_slope(const GridShape& shape, double r) {
  const double a = std::abs(r), sign = r < 0.0 ? -1.0 : 1.0, l = shape.half_length;
  switch (shape.function) {
    case ShapeFunction::linear:
      return r >= 1.0 || r < -1.0 ? 0.0 : -sign;
    case ShapeFunction::gimp:
      return (hat(r + l) - hat(r - l)) / (2.0 * l);
    case ShapeFunction::quadratic:
      if (a < 0.5) return -2.0 * r;
      return a < 1.5 ? -sign * (1.5 - a) : 0.0;
    case ShapeFunction::cubic:
      break;
  }
  if (a < 1.0) return sign * (1.5 * a * a - 2.0 * a);
  return a < 2.0 ? -0.5 * sign * (2.0 - a) * (2.0 - a) : 0.0;
}

/// D: sum over the nodes of N (x_i - x)^2 along one axis, m^2.
inline double inertia(const GridShape& shape) {
  return shape.cell * shape.cell / (shape.function == ShapeFunction::cubic ? 3.0 : 4.0);
}

/// Calls visit(node, N, grad N, x_i - x) for every node that a point x sees, in SI units. A
/// periodic axis has the nodes 1 ... cells, each seen where its image nearest to x lies (5 cells or
/// more).
template <int Dim, class Visit>
void for_each_node(const GridShape& shape, const Vector<Dim>& x, Visit&& visit) {
  for (int node = 0; node < shape.row_size * shape.rows; ++node) {
    Vector<Dim> r;  // cells, from node to point
    bool image = false;
    int rest = node;
    for (int a = 0; a < Dim; ++a) {
      const int index = rest % shape.nodes[a];
      rest /= shape.nodes[a];
      r[a] = x[a] / shape.cell - (index - 1);
      if (a + 1 < Dim && shape.periodic[a]) {
        const int cells = shape.nodes[a] - 3;
        image = image || index < 1 || index > cells;
        r[a] -= cells * std::round(r[a] / cells);
      }
    }
    if (image || r.template lpNorm<Eigen::Infinity>() >= 2.0) continue;
    double value = 1.0;
    Vector<Dim> gradient = Vector<Dim>::Constant(1.0 / shape.cell);
    for (int a = 0; a < Dim; ++a) {
      value *= spline(shape, r[a]);
      for (int b = 0; b < Dim; ++b) {
        gradient[a] *= a == b ? spline_slope(shape, r[b]) : spline(shape, r[b]);
      }
    }
    visit(node, value, gradient, Vector<Dim>(-shape.cell * r));
  }
}

template <int Dim>
Vector<Dim> position(const Particles<Dim>& particles, std::size_t p) {
  Vector<Dim> x;
  for (int a = 0; a < Dim; ++a) x[a] = particles.position[a][p];
  return x;
}

template <int Dim>
Vector<Dim> velocity(const Particles<Dim>& particles, std::size_t p) {
  Vector<Dim> v;
  for (int a = 0; a < Dim; ++a) v[a] = particles.velocity[a][p];
  return v;
}

/// The affine velocity, zero for particles without one, 1/s.
template <int Dim>
Matrix<Dim> affine(const Particles<Dim>& particles, std::size_t p) {
  Matrix<Dim> c = Matrix<Dim>::Zero();
  for (int k = 0; k < Dim * Dim && particles.options.affine; ++k) {
    c(k / Dim, k % Dim) = particles.affine[k][p];
  }
  return c;
}

/// Deviator as a matrix in the plane or in space, Pa.
template <int Dim>
Matrix<Dim> deviator(const Particles<Dim>& particles, std::size_t p) {
  const auto s = [&](int component) { return particles.deviator[component][p]; };
  Matrix<Dim> m;
  if constexpr (Dim == 2) {
    m << s(0), s(3), s(3), s(1);
  } else {
    m << s(0), s(3), s(5), s(3), s(1), s(4), s(5), s(4), s(2);
  }
  return m;
}

}  // namespace poreshock::reference
