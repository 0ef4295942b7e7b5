#pragma once
// The text of a scene as TOML, with the overrides of the command line put in.

#include <toml++/toml.h>

#include <optional>
#include <string>
#include <vector>

#include "report.hpp"

namespace poreshock::scene_text {

/// Parses a text and puts overrides such as "time.end=2e-7" in; `name` stands for the file. Empty
/// when the text is not TOML. Problems of the text and of the overrides go to the report.
std::optional<toml::table> parse_document(const std::string& text, const std::string& name,
                                          const std::vector<std::string>& overrides,
                                          Report& report);

}  // namespace poreshock::scene_text
