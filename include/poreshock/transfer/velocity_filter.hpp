#pragma once
// The filter of FMPM: particle velocities lose the noise that nodes cannot represent.

#include <span>

#include "poreshock/core/fixed_point.hpp"
#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/particles/cell_order.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/transfer/step_data.hpp"
#include "poreshock/transfer/tied_nodes.hpp"

namespace poreshock {

/// Particles of one velocity field, and their grid: scratch.
struct FilterField {
  const CellOrder* cells = nullptr;
  SlabGrid* grid = nullptr;
};

/// Replaces v by v - (1 - P)^k v with k = transfer.order, where P is the mass-weighted average to
/// the nodes and back (XPIC(k): Hammerquist & Nairn, CMAME 318 (2017) 724; order 1 would be PIC).
/// With A = 1 - P, r_l = A^l v and R_l the nodal mean of r_l the kinetic energy lost is
/// <v, (A^k - A^2k / 2) v> in the mass-weighted product, which is half of <v, A^k v> plus the sum
/// of <v, P A^n v> over n = k to 2 k - 1. <v, P A^2s v> is the sum of m_i |R_s|^2,
/// <v, P A^(2s+1) v> that of m_p (sum N |R_s|^2 - |sum N R_s|^2), <v, A^2s v> that of m_p |r_s|^2
/// and <v, A^(2s+1) v> that of m_i times the variance of r_s at the node: every particle's share is
/// >= 0 and does not see the frame. It goes to the internal energy of the particles and to
/// filter_heat (quanta), so that the energy closes.
///
/// Where fields are tied P takes the ties into account at the nodes, so that the increment of each
/// order keeps to them: P stays symmetric with eigenvalues from 0 to 1, hence the sums above hold
/// as they are once the variance at a node is that about the tied velocity. Contact in the
/// increments is due to Nairn & Hammerquist, CMAME 377 (2021) 113667; here it is linear, as ties
/// stand while the filter works. Collective (k exchanges per field).
template <int Dim>
void filter_velocity(std::span<const FilterField> fields, const TiedNodes<Dim>& tied,
                     const Transfer& transfer, double inverse_quantum, Particles<Dim>& particles,
                     StepData<Dim>& step, Int128& filter_heat);

}  // namespace poreshock
