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
  double penetration = 0.0;    ///< m, by which grains overfill the node
  double impact_heat = 0.0;    ///< J, of normal impulses
  double friction_heat = 0.0;  ///< J, of tangential impulses
  double loss = 0.0;           ///< J >= 0, kinetic energy the impulses took from the end velocities
};

/// Lets the grains of a node collide: a pair acts when it would close its gap within closing_time,
/// and then ends at a relative velocity that closes the gap in that time; friction is Coulomb's.
/// Two grains are solved exactly; more by projected Gauss-Seidel over ordered pairs. Every impulse
/// acts on two grains, so momentum stays to rounding; the kinetic energy of the end velocities
/// never grows. The heat of an impulse J is -J . (start + end)/2 of the relative velocity, half to
/// each side: with the internal forces' work at mid-step the energy of the step then closes.
/// `normal`: from the first to the second of two grains; null: from their gradients. Pure function.
template <int Dim>
ContactReport resolve_contact(std::span<NodeGrain<Dim>> grains, const ContactSettings& settings,
                              const FaceTable& faces, const Vector<Dim>* normal = nullptr);

}  // namespace poreshock
