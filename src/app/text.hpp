#pragma once
// Numbers on the command line. Private to the app.

#include <charconv>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>

#include "poreshock/core/error.hpp"

namespace poreshock {

/// A finite number that fills the whole text; nothing otherwise.
inline std::optional<double> parse_number(std::string_view text) {
  double value = 0.0;
  const auto result = std::from_chars(text.data(), text.data() + text.size(), value);
  const bool whole = result.ec == std::errc{} && result.ptr == text.data() + text.size();
  return whole && std::isfinite(value) ? std::optional<double>(value) : std::nullopt;
}

/// Throws InputError unless the length, where one is given, is positive and finite.
inline void require_length(const char* option, std::optional<double> metres) {
  if (!metres || (*metres > 0.0 && std::isfinite(*metres))) return;
  char text[32];
  std::snprintf(text, sizeof(text), "%g", *metres);
  throw InputError(std::string(option) + ": found " + text + ", allowed a finite number > 0 (m)");
}

}  // namespace poreshock
