#pragma once
// Reading, checking and writing of scenes. Also in write_scene.cpp.

#include <string>
#include <string_view>
#include <vector>

#include "poreshock/scene/scene.hpp"

namespace poreshock {

/// Reads a scene file and applies overrides such as "time.end=2e-7" (TOML values). Throws
/// InputError whose text lists every problem found, one per line, as file:line:column: message. Not
/// collective: call on rank 0 and broadcast the resolved text, or on all ranks when all see the
/// file.
Scene read_scene(const std::string& path, const std::vector<std::string>& overrides = {});

/// The same from a text already in memory; `name` stands for the file in messages.
Scene parse_scene(const std::string& text, const std::string& name,
                  const std::vector<std::string>& overrides = {});

/// How the text of write_scene begins: a file that does not was written by somebody.
inline constexpr std::string_view resolved_scene_mark = "# A complete scene of poreshock";

/// The complete scene as TOML with every key written out; parse_scene(write_scene(s)) == s exactly
/// (numbers in shortest round-trip form).
std::string write_scene(const Scene& scene);

}  // namespace poreshock
