#pragma once
// What the program knows, as text: materials and keys.

#include <string>

namespace poreshock {

/// The materials of the library with their sources; or, by name, the [[material]] table of one with
/// every key. Throws InputError for a name that is not in the library.
std::string describe_materials(const std::string& name);

/// All keys of a scene as Markdown tables, in the order of a written scene.
std::string describe_keys();

}  // namespace poreshock
