#pragma once
// Nodes at which velocity fields are tied: there they move as one along some directions.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "poreshock/core/tensor.hpp"
#include "poreshock/grid/grain_colours.hpp"

namespace poreshock {

/// Two of the fields at a node that do not move relative to each other along a normal, or at all.
template <int Dim>
struct Tie {
  int a = 0, b = 0;                          ///< places among the fields of the node
  Vector<Dim> normal = Vector<Dim>::Zero();  ///< from a to b
  bool stuck = false;                        ///< across the normal too
};

/// Ties of all pairs of fields a node can have.
template <int Dim>
using NodeTies = std::array<Tie<Dim>, most_colours*(most_colours - 1) / 2>;

/// Numbers of all fields of a node, Dim for each.
template <int Dim>
using FieldNumbers = std::array<Vector<Dim>, most_colours>;

/// A node with ties. With w the square roots of the shares of mass, ties take the components of
/// w v (v relative to the mean) along some orthonormal directions: the projection is symmetric in
/// the product weighted by mass, keeps momentum to rounding, and never adds kinetic energy.
template <int Dim>
struct TiedNode {
  int row = 0, lateral = 0;
  int count = 0;                                  ///< fields
  std::array<std::int8_t, most_colours> field{};  ///< their numbers
  std::array<double, most_colours> weight{};      ///< w
  std::uint32_t first = 0, last = 0;              ///< directions
  FieldNumbers<Dim> taken{};                      ///< m/s, from the start velocities of the step
};

/// All of a slab.
template <int Dim>
struct TiedNodes {
  std::vector<TiedNode<Dim>> nodes;
  std::vector<FieldNumbers<Dim>> directions;
};

/// Adds a node with `masses` (kg) of its fields and their ties: `node` brings its place, its fields
/// and their count. Not collective.
template <int Dim>
void tie_node(TiedNode<Dim> node, std::span<const double> masses, std::span<const Tie<Dim>> ties,
              TiedNodes<Dim>& tied);

/// Velocities (m/s) of the fields of a node as the ties leave them. Pure function.
template <int Dim>
FieldNumbers<Dim> tie_velocities(const TiedNodes<Dim>& tied, const TiedNode<Dim>& node,
                                 const FieldNumbers<Dim>& velocities);

}  // namespace poreshock
