#pragma once
// Every key of a scene as the reader knows it: for tables of keys and for completion.

#include <string>
#include <vector>

#include "poreshock/material/material.hpp"

namespace poreshock {

/// One key.
struct SceneKey {
  std::string table;      ///< as it stands in a file, "domain" or "material.johnson_cook"; "" = top
  bool repeated = false;  ///< the table is one of several, [[...]]
  std::string key;
  std::string standard;  ///< default as TOML, "required", or empty where it follows from other keys
  std::string allowed;   ///< in words, with its unit
  std::string about;
};

/// All keys in the order of a written scene; those that depend on a shape, a dimension or a
/// strength model are listed together.
std::vector<SceneKey> scene_keys();

/// The table [[material]] of a material with every key written out.
std::string write_material(const MaterialParameters& material);

}  // namespace poreshock
