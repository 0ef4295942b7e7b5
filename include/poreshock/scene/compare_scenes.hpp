#pragma once
// What two scenes differ in.

#include <string>
#include <vector>

#include "poreshock/scene/scene.hpp"

namespace poreshock {

/// Keys in which two scenes differ, for example "loading.velocity" or "material.0.density", in the
/// order of their names; a table or list that only one of them has is named as a whole.
std::vector<std::string> different_keys(const Scene& a, const Scene& b);

}  // namespace poreshock
