#pragma once
// Moving particles between ranks.

#include <mpi.h>

#include <span>
#include <vector>

#include "poreshock/particles/particles.hpp"

namespace poreshock {

/// Sends every particle to the rank destination[p] and drops those with destination -1. Any rank to
/// any rank; used at start, restart and rebalance. Collective.
template <int Dim>
void redistribute(const std::vector<int>& destination, Particles<Dim>& particles,
                  MPI_Comm communicator);

/// Sends the particles at `down` and `up` (ascending indices) to the ranks below and above, drops
/// those at `gone`, and appends what arrives. Holes are filled from the end. Collective
/// (neighbours).
template <int Dim>
void exchange_with_neighbours(const std::vector<std::uint32_t>& down,
                              const std::vector<std::uint32_t>& up,
                              const std::vector<std::uint32_t>& gone, Particles<Dim>& particles,
                              MPI_Comm communicator);

}  // namespace poreshock
