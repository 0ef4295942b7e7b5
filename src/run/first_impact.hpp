#pragma once
// When anything of a scene first hits something, as far as its boxes tell.

#include "poreshock/sample/fill.hpp"
#include "poreshock/scene/scene.hpp"

namespace poreshock {

/// Time (s) at which the box around the sample or a body first meets a wall, a symmetry plane or
/// another box with a different velocity; infinite when none does.
double first_impact(const Scene& scene, const SampleReport& report);

/// True when something goes on without any impact: a body force, a spin, heat between materials of
/// different temperatures.
bool moves_by_itself(const Scene& scene);

}  // namespace poreshock
