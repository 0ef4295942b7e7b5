#pragma once
// The transfer between particles and nodes in the formulas of the textbooks: plain loops over
// particles and nodes, nothing shared with the kernels. The oracle of the transfer tests.

#include <algorithm>
#include <cmath>
#include <vector>

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

/// What a node collects: kg, kg m/s, N, and J of the affine particles (APIC only).
template <int Dim>
struct NodeSums {
  double mass = 0.0;
  Vector<Dim> momentum = Vector<Dim>::Zero();
  Vector<Dim> force = Vector<Dim>::Zero();
  double kinetic = 0.0;
};

/// m_i = sum m N, p_i = sum m N (v + C d), f_i = - sum V (s - P 1) grad N, kinetic energy
/// sum m N |v + C d|^2 / 2 with d = x_i - x_p where `projected` (APIC, PIC). `pressure` per
/// particle, Pa.
template <int Dim>
std::vector<NodeSums<Dim>> particles_to_grid(const GridShape& shape,
                                             const Particles<Dim>& particles,
                                             const std::vector<double>& pressure, bool projected) {
  std::vector<NodeSums<Dim>> nodes(static_cast<std::size_t>(shape.row_size) * shape.rows);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double m = particles.mass[p];
    const Matrix<Dim> stress = deviator(particles, p) - pressure[p] * Matrix<Dim>::Identity();
    for_each_node<Dim>(shape, position(particles, p),
                       [&](int i, double n, const auto& grad, const auto& d) {
                         const Vector<Dim> v = velocity(particles, p) + affine(particles, p) * d;
                         nodes[i].mass += m * n;
                         nodes[i].momentum += m * n * v;
                         nodes[i].force -= m / particles.density[p] * (stress * grad);
                         if (projected) nodes[i].kinetic += 0.5 * m * n * v.squaredNorm();
                       });
  }
  return nodes;
}

/// Motion of a node over one step: velocities before and after, heat left at the node (J/kg).
template <int Dim>
struct NodeMotion {
  Vector<Dim> start = Vector<Dim>::Zero();
  Vector<Dim> end = Vector<Dim>::Zero();
  double heat = 0.0;
};

/// What a particle takes from the nodes.
template <int Dim>
struct Gathered {
  Vector<Dim> velocity;     ///< m/s, after the step
  Matrix<Dim> affine;       ///< 1/s, APIC
  Vector<Dim> transport;    ///< m/s, moves the particle: sum N v'
  Matrix<Dim> gradient;     ///< 1/s, of v'
  Matrix<Dim> middle_rate;  ///< 1/s, symmetric part of the gradient of (v + v')/2
  double node_heat;         ///< J/kg, interpolated from the nodes
  double lost;              ///< J/kg, kinetic energy this transfer turns into heat
};

/// APIC, PIC, or FLIP with the share `damped` of the velocity noise removed.
template <int Dim>
Gathered<Dim> grid_to_particle(const GridShape& shape, const std::vector<NodeMotion<Dim>>& nodes,
                               const Particles<Dim>& particles, std::size_t p,
                               VelocityTransfer transfer, double damped) {
  Vector<Dim> start = Vector<Dim>::Zero(), end = start;
  Matrix<Dim> moment = Matrix<Dim>::Zero(), start_gradient = moment, end_gradient = moment;
  double heat = 0.0, end2 = 0.0, increment2 = 0.0, product = 0.0;
  for_each_node<Dim>(shape, position(particles, p),
                     [&](int i, double n, const auto& grad, const auto& d) {
                       const NodeMotion<Dim>& node = nodes[i];
                       start += n * node.start;
                       end += n * node.end;
                       moment += n * node.end * d.transpose();
                       start_gradient += node.start * grad.transpose();
                       end_gradient += node.end * grad.transpose();
                       heat += n * node.heat;
                       end2 += n * node.end.squaredNorm();
                       increment2 += n * (node.end - node.start).squaredNorm();
                       product += n * node.start.dot(node.end);
                     });
  Gathered<Dim> g;
  g.transport = end;
  g.gradient = end_gradient;
  const Matrix<Dim> middle = 0.5 * (start_gradient + end_gradient);
  g.middle_rate = 0.5 * (middle + middle.transpose());
  g.node_heat = heat;
  g.affine.setZero();
  if (transfer == VelocityTransfer::pic) {
    g.velocity = end;
    g.lost = 0.5 * (end2 - end.squaredNorm());
    return g;
  }
  if (transfer == VelocityTransfer::apic) {
    const double d = inertia(shape);
    g.velocity = end;
    g.affine = moment / d;
    g.lost = 0.5 * (end2 - end.squaredNorm() - d * g.affine.squaredNorm());
    return g;
  }
  const Vector<Dim> old = velocity(particles, p);
  g.velocity = (1.0 - damped) * (old + (end - start)) + damped * end;
  g.lost = 0.5 * (increment2 - (end - start).squaredNorm()) +
           damped * ((1.0 - 0.5 * damped) * (old - start).squaredNorm() + product - start.dot(end));
  return g;
}

/// Volume-weighted average to the nodes and back of one number per particle.
template <int Dim>
std::vector<double> average(const GridShape& shape, const Particles<Dim>& particles,
                            const std::vector<double>& values) {
  std::vector<double> volume(static_cast<std::size_t>(shape.row_size) * shape.rows, 0.0);
  std::vector<double> sum = volume, result(particles.size(), 0.0);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double v = particles.mass[p] / particles.density[p];
    for_each_node<Dim>(shape, position(particles, p),
                       [&](int i, double n, const auto&, const auto&) {
                         volume[i] += v * n;
                         sum[i] += v * n * values[p];
                       });
  }
  for (std::size_t p = 0; p < particles.size(); ++p) {
    for_each_node<Dim>(shape, position(particles, p),
                       [&](int i, double n, const auto&, const auto&) {
                         if (volume[i] > 0.0) result[p] += n * sum[i] / volume[i];
                       });
  }
  return result;
}

}  // namespace poreshock::reference
