#pragma once
// Whether a stored state can be gone on from.

#include <string>

#include "poreshock/output/checkpoint.hpp"
#include "poreshock/solver/simulation.hpp"

namespace poreshock {

/// What no particle of a run of the scene has, and how many have it: numbers that are not finite,
/// places outside the domain, no mass, or a material that does not exist; empty where all are
/// sound. The same text on all ranks. Collective.
template <int Dim>
std::string unsound_particles(const Simulation<Dim>& sim);

/// Throws InputError on all ranks when the particles and the state read from `path` cannot come
/// from a run of the scene: unsound particles, a clock before zero, columns that the scene does not
/// have.
/// Any rank may hold any particles. Collective.
template <int Dim>
void require_sound_state(const std::string& path, const Simulation<Dim>& sim,
                         const ParticleOptions& expected, const RunState& state);

}  // namespace poreshock
