#pragma once
// Contact between grains at one node. Each grain has its own velocity field; where two or more of
// them have mass, they push each other apart and rub (Bardenhagen, Brackbill & Sulsky, CMAME 187
// (2000) 529; normals from volume gradients: Lemiale, Nairn & Hurmane, CMES 70 (2010) 41).

#include <span>

#include "poreshock/physics/gap.hpp"

namespace poreshock {

/// What happened at a node.
struct ContactReport {
  int pairs = 0;               ///< pairs that pushed each other
  double least_gap = 0.0;      ///< m, of all pairs; infinite without a pair
  double excess = 0.0;         ///< volume by which grains overfill the node, over that of a cell
  double friction_heat = 0.0;  ///< J >= 0
  double impact_heat = 0.0;    ///< J, of normal impulses beside a wall
};

/// A node where grains may collide.
template <int Dim>
struct ContactNode {
  std::span<NodeGrain<Dim>> grains;
  ContactSettings settings;
  /// From the first to the second of two grains; null: from their gradients.
  const Vector<Dim>* normal = nullptr;
  ContactReport report;  ///< set by contact
};

/// Lets the grains of a node collide: a pair that touches and closes is tied. Start
/// and end velocities are projected on those of one normal velocity in every tied pair, orthogonal
/// in sum m u . v. So the impulses do no work with the mean of both, and what the start velocities
/// lose stays in the residuals of the particles, where the transfer keeps or heats it. Two grains
/// alone at a node that is not overfull part once the tie would pull their particles, though these
/// residuals still close. Which pairs of a crowded node push each other is found by projected
/// Gauss-Seidel; the projection is exact.
///
/// Friction is Coulomb's with the impulse that the particles of a grain get: a pair that it holds
/// is tied in all directions, another one slips, with the heat -J . (start + end)/2 of the relative
/// velocity, half to each side, never negative at a node.
///
/// Beside a wall, which has yet to change the end velocities, the start velocities stay, and so all
/// impulses take -J . (start + end)/2 as heat, alike per mass in all grains.
///
/// `normal`: from the first to the second of two grains; null: from their gradients. Pure function.
template <int Dim>
ContactReport resolve_contact(std::span<NodeGrain<Dim>> grains, const ContactSettings& settings,
                              const FaceTable& faces, const Vector<Dim>* normal = nullptr);

/// Most nodes that collide together.
inline constexpr int most_contact_nodes = 64;

/// The same for 1 ... most_contact_nodes nodes with one number of grains and one friction; none
/// feels the others.
template <int Dim>
void resolve_contacts(std::span<ContactNode<Dim>> nodes, const FaceTable& faces);

}  // namespace poreshock
