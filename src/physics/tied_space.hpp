#pragma once
// Private to physics: the velocities of the grains of a node that keep some of them together.

#include <array>
#include <cmath>
#include <span>

#include "poreshock/physics/gap.hpp"

namespace poreshock {

/// Velocities of all grains of a node.
template <int Dim>
using NodeVelocities = std::array<Vector<Dim>, most_grains_at_node>;

/// Velocities t with n . (t_b - t_a) = 0 for some pairs a, b of the grains of a node, by an
/// orthonormal basis of what is not among them in the product sum of m u . v.
template <int Dim>
class TiedSpace {
 public:
  explicit TiedSpace(std::span<const NodeGrain<Dim>> grains) : grains_(grains) {}

  /// Ties a and b along n, a unit vector. What follows from earlier ties changes nothing.
  void tie(int a, int b, const Vector<Dim>& n) {
    constexpr double dependent = 1e-4;
    NodeVelocities<Dim>& e = basis_[static_cast<std::size_t>(count_)];
    for (std::size_t g = 0; g < grains_.size(); ++g) e[g].setZero();
    const double ma = grains_[static_cast<std::size_t>(a)].mass;
    const double mb = grains_[static_cast<std::size_t>(b)].mass;
    const double scale = std::sqrt(ma * (mb / (ma + mb)));  // to the length 1
    e[static_cast<std::size_t>(a)] = n * (-scale / ma);
    e[static_cast<std::size_t>(b)] = n * (scale / mb);
    if (count_ > 0) {
      // Twice, as the first time leaves rounding over the length of the rest.
      project(e);
      const double length = std::sqrt(product(e, e));
      if (!(length > dependent)) return;
      for (std::size_t g = 0; g < grains_.size(); ++g) e[g] /= length;
      project(e);
      remove_momentum(e);
    }
    ++count_;
  }

  /// The nearest velocities of the space. Keeps sum m u up to rounding.
  void project(NodeVelocities<Dim>& u) const {
    for (int k = 0; k < count_; ++k) {
      const NodeVelocities<Dim>& e = basis_[static_cast<std::size_t>(k)];
      const double share = product(u, e);
      for (std::size_t g = 0; g < grains_.size(); ++g) u[g] -= e[g] * share;
    }
  }

  /// Sum of m u . v.
  double product(const NodeVelocities<Dim>& u, const NodeVelocities<Dim>& v) const {
    double sum = 0.0;
    for (std::size_t g = 0; g < grains_.size(); ++g) sum += grains_[g].mass * dot<Dim>(u[g], v[g]);
    return sum;
  }

 private:
  /// What rounding left of it, which a short rest makes large.
  void remove_momentum(NodeVelocities<Dim>& u) const {
    Vector<Dim> momentum = Vector<Dim>::Zero();
    double mass = 0.0;
    for (std::size_t g = 0; g < grains_.size(); ++g) {
      momentum += u[g] * grains_[g].mass;
      mass += grains_[g].mass;
    }
    for (std::size_t g = 0; g < grains_.size(); ++g) u[g] -= momentum / mass;
  }

  std::span<const NodeGrain<Dim>> grains_;
  int count_ = 0;
  /// One more than there can be, for a tie that turns out to follow from the others.
  std::array<NodeVelocities<Dim>, Dim*(most_grains_at_node - 1) + 1> basis_;
};

}  // namespace poreshock
