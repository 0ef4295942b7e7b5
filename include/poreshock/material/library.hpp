#pragma once
// Named materials with their sources. A scene takes one by `material.name` and overrides by key.

#include <string>
#include <string_view>
#include <vector>

#include "poreshock/material/material.hpp"

namespace poreshock {

/// A material of the library. Where it has no constants of a strength model, these keep their
/// defaults, and the scene must give them.
struct LibraryMaterial {
  MaterialParameters parameters;
  std::string about;   ///< what it is, in a line
  std::string source;  ///< of the constants
};

/// All materials, each with a name of its own. Not collective.
const std::vector<LibraryMaterial>& material_library();

/// The material of that name, null when there is none. Not collective.
const LibraryMaterial* library_material(std::string_view name);

/// Whether the material has constants of the strength model. Not collective.
bool has_strength(const MaterialParameters& material, StrengthModel model);

}  // namespace poreshock
