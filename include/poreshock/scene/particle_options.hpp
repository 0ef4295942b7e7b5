#pragma once
// Which columns of particles a scene needs.

#include "poreshock/particles/particles.hpp"
#include "poreshock/scene/scene.hpp"

namespace poreshock {

/// The optional columns that a scene needs. Pure function.
ParticleOptions particle_options(const Scene& scene);

}  // namespace poreshock
