#pragma once
// Values of --set as people write them first, and as TOML has them.

#include <string>

namespace poreshock::scene_text {

/// What is wrong with "table.key=value" and how to write it, when the value holds a range such as
/// 310:900:10, a text without quotes or a list without brackets; empty otherwise.
std::string override_hint(const std::string& text);

}  // namespace poreshock::scene_text
