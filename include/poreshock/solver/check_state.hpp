#pragma once
// Whether a stored state can be gone on from.

#include <string>

#include "poreshock/output/checkpoint.hpp"
#include "poreshock/solver/simulation.hpp"

namespace poreshock {

/// Throws InputError on all ranks when the particles and the state read from `path` cannot come
/// from a run of the scene: numbers that are not finite, particles outside the domain, without mass
/// or of a material that does not exist, a clock before zero, columns that the scene does not have.
/// Any rank may hold any particles. Collective.
template <int Dim>
void require_sound_state(const std::string& path, const Simulation<Dim>& sim,
                         const ParticleOptions& expected, const RunState& state);

}  // namespace poreshock
