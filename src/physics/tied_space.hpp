#pragma once
// Private to physics: the velocities of the grains of a node that keep some of them together.

#include <array>
#include <cmath>
#include <span>

#include "poreshock/physics/gap.hpp"

namespace poreshock {

/// Grains of a node. Where their number is known when the program is compiled, loops over them are
/// unrolled.
template <int Dim, std::size_t Count>
using NodeGrains = std::span<const NodeGrain<Dim>, Count>;

/// Most of them.
template <std::size_t Count>
inline constexpr std::size_t most_of = Count == std::dynamic_extent ? most_grains_at_node : Count;

/// Velocities of all grains of a node.
template <int Dim, std::size_t Count>
using NodeVelocities = std::array<Vector<Dim>, most_of<Count>>;

/// Velocities t with n . (t_b - t_a) = 0 for some pairs a, b of the grains of a node, by an
/// orthonormal basis of what is not among them in the product sum of m u . v.
template <int Dim, std::size_t Count>
class TiedSpace {
 public:
  using Velocities = NodeVelocities<Dim, Count>;

  explicit TiedSpace(NodeGrains<Dim, Count> grains) : grains_(grains) {}

  /// Ties a and b along n, a unit vector. What follows from earlier ties changes nothing, nor does
  /// anything where all move alike.
  void tie(int a, int b, const Vector<Dim>& n) {
    constexpr double dependent = 1e-4;
    if (count_ == Dim * (static_cast<int>(grains_.size()) - 1)) return;
    Velocities& e = basis_[static_cast<std::size_t>(count_)];
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
  void project(Velocities& u) const {
    for (int k = 0; k < count_; ++k) {
      const Velocities& e = basis_[static_cast<std::size_t>(k)];
      const double share = product(u, e);
      for (std::size_t g = 0; g < grains_.size(); ++g) u[g] -= e[g] * share;
    }
  }

  /// Sum of m u . v.
  double product(const Velocities& u, const Velocities& v) const {
    double sum = 0.0;
    for (std::size_t g = 0; g < grains_.size(); ++g) sum += grains_[g].mass * dot<Dim>(u[g], v[g]);
    return sum;
  }

 private:
  /// What rounding left of it, which a short rest makes large.
  void remove_momentum(Velocities& u) const {
    Vector<Dim> momentum = Vector<Dim>::Zero();
    double mass = 0.0;
    for (std::size_t g = 0; g < grains_.size(); ++g) {
      momentum += u[g] * grains_[g].mass;
      mass += grains_[g].mass;
    }
    for (std::size_t g = 0; g < grains_.size(); ++g) u[g] -= momentum / mass;
  }

  NodeGrains<Dim, Count> grains_;
  int count_ = 0;
  std::array<Velocities, Dim*(most_of<Count> - 1)> basis_;
};

}  // namespace poreshock
