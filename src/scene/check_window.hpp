#pragma once
// What must hold in a scene whose domain follows the front.

#include "poreshock/scene/scene.hpp"
#include "report.hpp"

namespace poreshock::scene_text {

/// Adds all that keeps a domain from following the front to the report.
void check_window(const Scene& scene, Report& report);

}  // namespace poreshock::scene_text
