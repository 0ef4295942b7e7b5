#pragma once
// Lengths in messages.

#include "poreshock/core/text.hpp"

namespace poreshock {

/// A length with four significant digits and its unit.
inline std::string length_text(double metres) {
  return significant<4>(metres) + " m";
}

}  // namespace poreshock
