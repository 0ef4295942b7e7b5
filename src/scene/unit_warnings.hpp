#pragma once
// Numbers of a scene that look like other units than SI.

#include <string>
#include <vector>

#include "poreshock/scene/scene.hpp"

namespace poreshock::scene_text {

/// Adds a plain sentence for each such number: of materials against the library and their own bulk
/// modulus, of velocities against the sound speed, of cell, size and time against each other.
void warn_units(const Scene& scene, std::vector<std::string>& warnings);

}  // namespace poreshock::scene_text
