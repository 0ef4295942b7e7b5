#pragma once
// Numbers on the command line. Private to the app.

#include <charconv>
#include <cmath>
#include <optional>
#include <string_view>

namespace poreshock {

/// A finite number that fills the whole text; nothing otherwise.
inline std::optional<double> parse_number(std::string_view text) {
  double value = 0.0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = result.ec == std::errc{} && result.ptr == text.data() + text.size();
  return whole && std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
}

}  // namespace poreshock
