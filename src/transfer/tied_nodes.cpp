#include "poreshock/transfer/tied_nodes.hpp"

#include <cmath>

namespace poreshock {

namespace {

template <int Dim>
double dot(const FieldNumbers<Dim>& a, const FieldNumbers<Dim>& b, int count) {
  double sum = 0.0;
  for (int f = 0; f < count; ++f) {
    for (int k = 0; k < Dim; ++k) sum += a[f][k] * b[f][k];
  }
  return sum;
}

template <int Dim>
void subtract(double share, const FieldNumbers<Dim>& b, int count, FieldNumbers<Dim>& a) {
  for (int f = 0; f < count; ++f) a[f] -= b[f] * share;
}

/// Adds what (v_b - v_a) . along = 0 takes beyond the directions that the node already has.
template <int Dim>
void add_direction(const Tie<Dim>& tie, const Vector<Dim>& along, TiedNode<Dim>& node,
                   TiedNodes<Dim>& tied) {
  constexpr double dependent = 1e-8;
  FieldNumbers<Dim> direction;
  direction.fill(Vector<Dim>::Zero());
  const double wa = node.weight[tie.a], wb = node.weight[tie.b];
  const double both = std::sqrt(wa * wa + wb * wb);
  direction[tie.a] = along * (-wb / both);
  direction[tie.b] = along * (wa / both);
  double length = 1.0;
  // The second pass makes up for the rounding of the first.
  for (int pass = 0; pass < 2; ++pass) {
    for (std::uint32_t k = node.first; k < node.last; ++k) {
      const FieldNumbers<Dim>& known = tied.directions[k];
      subtract<Dim>(dot<Dim>(direction, known, node.count), known, node.count, direction);
    }
    length = std::sqrt(dot<Dim>(direction, direction, node.count));
    if (!(length > dependent)) return;
    for (Vector<Dim>& part : direction) part /= length;
  }
  tied.directions.push_back(direction);
  ++node.last;
}

}  // namespace

template <int Dim>
void tie_node(TiedNode<Dim> node, std::span<const double> masses, std::span<const Tie<Dim>> ties,
              TiedNodes<Dim>& tied) {
  double mass = 0.0;
  for (const double m : masses) mass += m;
  for (int f = 0; f < node.count; ++f) node.weight[f] = std::sqrt(masses[f] / mass);
  node.first = node.last = static_cast<std::uint32_t>(tied.directions.size());
  for (const Tie<Dim>& tie : ties) {
    if (!tie.stuck) {
      add_direction<Dim>(tie, tie.normal, node, tied);
      continue;
    }
    for (int k = 0; k < Dim; ++k) {
      Vector<Dim> along = Vector<Dim>::Zero();
      along[k] = 1.0;
      add_direction<Dim>(tie, along, node, tied);
    }
  }
  if (node.last > node.first) tied.nodes.push_back(node);
}

template <int Dim>
FieldNumbers<Dim> tie_velocities(const TiedNodes<Dim>& tied, const TiedNode<Dim>& node,
                                 const FieldNumbers<Dim>& velocities) {
  Vector<Dim> mean = Vector<Dim>::Zero();
  for (int f = 0; f < node.count; ++f) {
    mean += velocities[f] * (node.weight[f] * node.weight[f]);
  }
  FieldNumbers<Dim> weighted;
  for (int f = 0; f < node.count; ++f) weighted[f] = (velocities[f] - mean) * node.weight[f];
  const FieldNumbers<Dim> before = weighted;
  for (std::uint32_t k = node.first; k < node.last; ++k) {
    const FieldNumbers<Dim>& direction = tied.directions[k];
    subtract<Dim>(dot<Dim>(weighted, direction, node.count), direction, node.count, weighted);
  }
  FieldNumbers<Dim> result = velocities;
  for (int f = 0; f < node.count; ++f) result[f] += (weighted[f] - before[f]) / node.weight[f];
  return result;
}

template void tie_node<2>(TiedNode<2>, std::span<const double>, std::span<const Tie<2>>,
                          TiedNodes<2>&);
template void tie_node<3>(TiedNode<3>, std::span<const double>, std::span<const Tie<3>>,
                          TiedNodes<3>&);
template FieldNumbers<2> tie_velocities<2>(const TiedNodes<2>&, const TiedNode<2>&,
                                           const FieldNumbers<2>&);
template FieldNumbers<3> tie_velocities<3>(const TiedNodes<3>&, const TiedNode<3>&,
                                           const FieldNumbers<3>&);

}  // namespace poreshock
