#pragma once
// The transfer between particles and nodes in the formulas of the textbooks: plain loops over
// particles and nodes, nothing shared with the kernels. The oracle of the transfer tests.

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <vector>

#include "support/scalar_shape.hpp"

namespace poreshock::reference {

/// What a transfer carries besides the velocity (order 1: affine, 2: all products of offsets), and
/// which modes keep the share of the residual that is not lost.
struct TransferKind {
  int order;
  bool velocity_keeps, others_keep;
};

inline TransferKind kind_of(VelocityTransfer transfer) {
  switch (transfer) {
    case VelocityTransfer::pic:
      return {0, false, false};
    case VelocityTransfer::flip:
      return {0, true, true};
    case VelocityTransfer::apic:
      return {1, false, false};
    case VelocityTransfer::aflip:
      return {1, true, false};
    case VelocityTransfer::iapic:
      return {1, true, true};
    case VelocityTransfer::polypic:
      return {2, false, false};
    case VelocityTransfer::polyflip:
      return {2, true, false};
    case VelocityTransfer::ipolypic:
      break;
  }
  return {2, true, true};
}

/// Coefficients of the modes of a velocity, m/s, a column each.
template <int Dim>
using ModeColumns = Eigen::Matrix<double, Dim, Eigen::Dynamic>;

/// What a particle sees: nodes, weights, gradients, and the modes phi at each node (rows) with
/// their norms sum of N phi^2. Modes: 1, r_a, r_a^2 less its mean, then xy (yz zx), r = (x_i -
/// x)/cell.
template <int Dim>
struct Surroundings {
  std::vector<int> node;
  std::vector<double> weight;
  std::vector<Vector<Dim>> gradient;
  Eigen::MatrixXd phi;
  Eigen::VectorXd norm;
};

template <int Dim>
Surroundings<Dim> surroundings(const GridShape& shape, int order, const Vector<Dim>& x) {
  Surroundings<Dim> s;
  std::vector<Vector<Dim>> offset;
  Vector<Dim> mean = Vector<Dim>::Zero();
  for_each_node<Dim>(shape, x, [&](int i, double n, const auto& grad, const auto& d) {
    s.node.push_back(i);
    s.weight.push_back(n);
    s.gradient.push_back(grad);
    offset.push_back(d / shape.cell);
    mean += n * offset.back().cwiseAbs2();
  });
  constexpr int second = Dim * (Dim + 1) / 2;
  const int modes = 1 + (order > 0 ? Dim : 0) + (order > 1 ? second : 0);
  const auto seen = static_cast<int>(s.node.size());
  s.phi = Eigen::MatrixXd::Ones(seen, modes);
  s.norm = Eigen::VectorXd::Zero(modes);
  for (int i = 0; i < seen; ++i) {
    const Vector<Dim>& r = offset[static_cast<std::size_t>(i)];
    for (int a = 0; a < Dim && order > 0; ++a) s.phi(i, 1 + a) = r[a];
    for (int a = 0; a < Dim && order > 1; ++a) {
      s.phi(i, 1 + Dim + a) = r[a] * r[a] - mean[a];
      if (Dim == 3 || a == 0) s.phi(i, 1 + 2 * Dim + a) = r[a] * r[(a + 1) % Dim];
    }
    s.norm += s.weight[static_cast<std::size_t>(i)] * s.phi.row(i).cwiseAbs2().transpose();
  }
  return s;
}

/// The modes a particle carries.
template <int Dim>
ModeColumns<Dim> modes_of(const GridShape& shape, const Surroundings<Dim>& s,
                          const Particles<Dim>& particles, std::size_t p) {
  ModeColumns<Dim> c(Dim, s.norm.size());
  c.col(0) = velocity(particles, p);
  if (c.cols() > 1) c.middleCols(1, Dim) = shape.cell * affine(particles, p);
  const int second = static_cast<int>(c.cols()) - 1 - Dim;
  for (int k = 0; k < second; ++k) {
    for (int a = 0; a < Dim; ++a) {
      c(a, 1 + Dim + k) = particles.quadratic[a * second + k][p] / std::sqrt(s.norm[1 + Dim + k]);
    }
  }
  return c;
}

/// What a node collects: kg, kg m/s, N.
template <int Dim>
struct NodeSums {
  double mass = 0.0;
  Vector<Dim> momentum = Vector<Dim>::Zero();
  Vector<Dim> force = Vector<Dim>::Zero();
};

/// m_i = sum m N, p_i = sum m N (sum of modes), f_i = - sum V (s - P 1) grad N.
template <int Dim>
std::vector<NodeSums<Dim>> particles_to_grid(const GridShape& shape, VelocityTransfer transfer,
                                             const Particles<Dim>& particles) {
  std::vector<NodeSums<Dim>> nodes(static_cast<std::size_t>(shape.row_size) * shape.rows);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double m = particles.mass[p];
    const double pressure = particles.pressure[p] + particles.viscous_pressure[p];
    const Matrix<Dim> stress = deviator(particles, p) - pressure * Matrix<Dim>::Identity();
    const auto s = surroundings<Dim>(shape, kind_of(transfer).order, position(particles, p));
    const ModeColumns<Dim> c = modes_of<Dim>(shape, s, particles, p);
    for (std::size_t i = 0; i < s.node.size(); ++i) {
      NodeSums<Dim>& node = nodes[static_cast<std::size_t>(s.node[i])];
      const Vector<Dim> v = c * s.phi.row(static_cast<int>(i)).transpose();
      node.mass += m * s.weight[i];
      node.momentum += m * s.weight[i] * v;
      node.force -= m / particles.density[p] * (stress * s.gradient[i]);
    }
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
  ModeColumns<Dim> modes;     ///< m/s, after the step
  Eigen::VectorXd norm;       ///< of the modes
  Vector<Dim> transport;      ///< m/s, moves the particle: sum N v'
  Matrix<Dim> gradient;       ///< 1/s, of v'
  Matrix<Dim> middle_rate;    ///< 1/s, symmetric part of the gradient of (v + v')/2
  double node_heat = 0.0;     ///< J/kg, interpolated from the nodes
  double lost = 0.0;          ///< J/kg, kinetic energy this transfer turns into heat
  double shortened_to = 1.0;  ///< factor on all modes but the velocity
};

/// Heat of a transfer by its definition. e is what modes cannot hold of the velocities of the
/// nodes, R what the nodes do not see of the old modes, k the shares that stay; twice the heat is
/// sum K ((1 - k^2) R^2 + 2 (k0 - k) R.M') + sum N (|e' - k0 e|^2 + (1 - k0^2) |e|^2).
template <int Dim>
double lost_energy(const Surroundings<Dim>& s, const ModeColumns<Dim>& old,
                   const ModeColumns<Dim>& start, const ModeColumns<Dim>& end,
                   const std::vector<NodeMotion<Dim>>& nodes, const Eigen::VectorXd& kept) {
  double twice = 0.0;
  for (int k = 0; k < kept.size(); ++k) {
    const Vector<Dim> residual = old.col(k) - start.col(k);
    twice += s.norm[k] * ((1.0 - kept[k] * kept[k]) * residual.squaredNorm() +
                          2.0 * (kept[0] - kept[k]) * residual.dot(end.col(k)));
  }
  for (std::size_t i = 0; i < s.node.size(); ++i) {
    const NodeMotion<Dim>& node = nodes[static_cast<std::size_t>(s.node[i])];
    const Eigen::VectorXd phi = s.phi.row(static_cast<int>(i)).transpose();
    const Vector<Dim> e0 = node.start - start * phi, e1 = node.end - end * phi;
    twice += s.weight[i] *
             ((e1 - kept[0] * e0).squaredNorm() + (1.0 - kept[0] * kept[0]) * e0.squaredNorm());
  }
  return 0.5 * twice;
}

/// Moments of the start or end velocities: the modes that come nearest to them.
template <int Dim>
ModeColumns<Dim> moments(const Surroundings<Dim>& s, const std::vector<NodeMotion<Dim>>& nodes,
                         Vector<Dim> NodeMotion<Dim>::*when) {
  ModeColumns<Dim> m = ModeColumns<Dim>::Zero(Dim, s.norm.size());
  for (std::size_t i = 0; i < s.node.size(); ++i) {
    m += s.weight[i] * (nodes[static_cast<std::size_t>(s.node[i])].*when) *
         s.phi.row(static_cast<int>(i));
  }
  return m * s.norm.cwiseInverse().asDiagonal();
}

/// Rotation over dt by the spin of a gradient, in Cayley's form.
template <int Dim>
Matrix<Dim> turn(const Matrix<Dim>& gradient, double dt) {
  const Matrix<Dim> half = 0.25 * dt * (gradient - gradient.transpose());
  const Matrix<Dim> one = Matrix<Dim>::Identity();
  return (one - half).inverse() * (one + half);
}

/// Gradients and heat of the nodes.
template <int Dim>
void interpolate(const Surroundings<Dim>& s, const std::vector<NodeMotion<Dim>>& nodes,
                 Gathered<Dim>& g) {
  Matrix<Dim> middle = Matrix<Dim>::Zero();
  g.gradient.setZero();
  for (std::size_t i = 0; i < s.node.size(); ++i) {
    const NodeMotion<Dim>& node = nodes[static_cast<std::size_t>(s.node[i])];
    g.gradient += node.end * s.gradient[i].transpose();
    middle += 0.5 * (node.start + node.end) * s.gradient[i].transpose();
    g.node_heat += s.weight[i] * node.heat;
  }
  g.middle_rate = 0.5 * (middle + middle.transpose());
}

/// A transfer that loses the share `lost` of the residual in a step of dt.
template <int Dim>
Gathered<Dim> grid_to_particle(const GridShape& shape, const std::vector<NodeMotion<Dim>>& nodes,
                               const Particles<Dim>& particles, std::size_t p,
                               VelocityTransfer transfer, double lost, double dt) {
  const TransferKind kind = kind_of(transfer);
  const auto s = surroundings<Dim>(shape, kind.order, position(particles, p));
  const ModeColumns<Dim> old = modes_of<Dim>(shape, s, particles, p);
  const ModeColumns<Dim> start = moments<Dim>(s, nodes, &NodeMotion<Dim>::start);
  const ModeColumns<Dim> end = moments<Dim>(s, nodes, &NodeMotion<Dim>::end);
  Eigen::VectorXd kept =
      Eigen::VectorXd::Constant(s.norm.size(), kind.others_keep ? 1.0 - lost : 0.0);
  kept[0] = kind.velocity_keeps ? 1.0 - lost : 0.0;
  Gathered<Dim> g;
  g.norm = s.norm;
  g.transport = end.col(0);
  g.modes = end + (old - start) * kept.asDiagonal();
  interpolate<Dim>(s, nodes, g);
  g.lost = lost_energy<Dim>(s, old, start, end, nodes, kept);
  const auto others = s.norm.size() - 1;
  if (kind.velocity_keeps && !kind.others_keep && g.lost < 0.0) {
    const double energy =
        (g.modes.rightCols(others) * s.norm.tail(others).cwiseSqrt().asDiagonal()).squaredNorm();
    g.shortened_to = std::sqrt(std::max(0.0, 1.0 + 2.0 * g.lost / energy));
    g.modes.rightCols(others) *= g.shortened_to;
    g.lost = 0.0;
  }
  if (kind.others_keep && kind.order > 0) {
    g.modes.middleCols(1, Dim) *= turn<Dim>(g.gradient, dt).transpose();
  }
  return g;
}

}  // namespace poreshock::reference
