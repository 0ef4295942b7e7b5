#pragma once
// What of a scene's numbers can hardly be meant.

#include <string>
#include <vector>

#include "poreshock/scene/scene.hpp"

namespace poreshock {

/// Plain sentences about numbers that look like other units than SI, against each other and
/// against the library of materials, and about thresholds that all material exceeds from the start.
std::vector<std::string> scene_warnings(const Scene& scene);

}  // namespace poreshock
