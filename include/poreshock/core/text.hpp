#pragma once
// Numbers in messages.

#include <cstdio>
#include <string>

namespace poreshock {

/// A number with so many significant digits.
template <int Digits>
std::string significant(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*g", Digits, value);
  return text;
}

}  // namespace poreshock
