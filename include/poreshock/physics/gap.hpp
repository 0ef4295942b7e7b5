#pragma once
// Grains at one node, and the gap between two of them.

#include <span>

#include "poreshock/core/tensor.hpp"
#include "poreshock/grid/grain_colours.hpp"
#include "poreshock/scene/scene.hpp"

namespace poreshock {

/// Most grains that may share a node.
inline constexpr int most_grains_at_node = most_colours;

/// One grain at a node. The order of several is that of their numbers.
template <int Dim>
struct NodeGrain {
  double mass = 0.0;                           ///< kg
  Vector<Dim> start = Vector<Dim>::Zero();     ///< m/s, before the momentum update
  Vector<Dim> end = Vector<Dim>::Zero();       ///< m/s, after it; contact changes it
  double volume = 0.0;                         ///< m^Dim, sum of V_p N
  Vector<Dim> gradient = Vector<Dim>::Zero();  ///< m^(Dim-1), sum of V_p dN/dx_p: points outwards
  Vector<Dim> place = Vector<Dim>::Zero();     ///< m, volume-weighted mean place of its particles
  double strain = 0.0;                         ///< plastic, volume-weighted mean of its particles
  double heat = 0.0;                           ///< J, set by contact
};

/// Slope of the filled share of a node against the place of a flat face, by that share: the shape
/// function along one axis as a function of its own integral. From it follow gaps.
class FaceTable {
 public:
  explicit FaceTable(const Transfer& transfer);

  /// Weight per cell at the face that fills `share` (0 ... 1) of a node.
  double density(double share) const;

 private:
  static constexpr int intervals = 64;
  static constexpr double greatest_root = 0.8408964152537145;  // 0.5^(1/4)
  std::array<double, intervals + 1> density_{};
};

/// What contact needs to know at a node.
struct ContactSettings {
  double friction = 0.0;
  bool gap_test = true;
  double cell = 0.0;      ///< m
  double kept = 0.0;      ///< share of its residual that a particle keeps in the step
  bool mirrored = false;  ///< a wall or plane of symmetry changes the end velocities once more
  double capacity = 0.0;  ///< m^Dim, volume that fills the node: cell^Dim, less beyond the domain
};

/// Gap in cells that counts as none, for two grains of this mean plastic strain, whose faces stand
/// at an angle of this tangent: the volume that particles fill at a node is known the worse the
/// more they are deformed, and where a wedge closes, particles half a cell ahead, where the faces
/// touch, move with the node too. Pure function.
double touching_gap(double strain, double wedge);

/// What all grains of a node fill.
template <int Dim>
struct NodeFill {
  double volume = 0.0;                         ///< m^Dim
  Vector<Dim> gradient = Vector<Dim>::Zero();  ///< m^(Dim-1): away from the void
};

template <int Dim>
NodeFill<Dim> fill_of(std::span<const NodeGrain<Dim>> grains);

/// Gap between two grains at a node along their normal, m: from the volume that is missing, either
/// in the node or between the two fields, whichever is less, less touching_gap; 0 when they touch.
/// Between curved faces it is the mean over the shape function. Pure function.
template <int Dim>
double pair_gap(const NodeGrain<Dim>& a, const NodeGrain<Dim>& b, const Vector<Dim>& normal,
                const NodeFill<Dim>& node, const ContactSettings& settings, const FaceTable& faces);

}  // namespace poreshock
