#pragma once
// One number for the state of all particles.

#include <cstdint>

#include "poreshock/solver/simulation.hpp"

namespace poreshock {

/// One 64-bit checksum of all particle columns in id order, the same on any number of ranks.
/// Collective.
template <int Dim>
std::uint64_t checksum(const Simulation<Dim>& sim);

}  // namespace poreshock
