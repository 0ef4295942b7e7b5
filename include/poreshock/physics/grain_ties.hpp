#pragma once
// Ties of grains that touch and push each other, for the filter of FMPM.

#include <vector>

#include "poreshock/physics/grain_contact.hpp"
#include "poreshock/transfer/tied_nodes.hpp"

namespace poreshock {

/// Ties of the grains at all shared nodes: those of the pairs that collide_grains would find
/// touching and pushing. Before: as collide_grains. Nothing changes on the grids. Not collective.
template <int Dim>
TiedNodes<Dim> tie_grains(const std::vector<ContactField>& fields, const std::vector<bool>& shared,
                          const Scene& scene, ContactSettings settings, const FaceTable& faces,
                          const NodePoints<Dim>& points);

/// Between the nodal sums and the momentum update: momenta (SumLane) at tied nodes become those
/// that the ties allow, and the nodes remember what was taken. Not collective.
template <int Dim>
void tie_momenta(const std::vector<ContactField>& fields, TiedNodes<Dim>& tied);

/// After the boundaries: particles move on by end less start velocity, as FLIP has it; where ties
/// took something from the start velocities that does other work than the impulses know, and the
/// difference goes to the heat. Not collective.
template <int Dim>
void settle_tie_heat(const std::vector<ContactField>& fields, const TiedNodes<Dim>& tied,
                     NodeLedger& ledger);

}  // namespace poreshock
