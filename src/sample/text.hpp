#pragma once
// Numbers in messages.

#include <cstdio>
#include <string>

namespace poreshock {

/// A number with four significant digits.
inline std::string short_number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// A length with four significant digits and its unit.
inline std::string length_text(double metres) {
  return short_number(metres) + " m";
}

}  // namespace poreshock
