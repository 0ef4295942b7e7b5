#pragma once
// Ranges of numbers that a user may give.

#include <limits>

namespace poreshock {

inline constexpr double unlimited = std::numeric_limits<double>::infinity();

/// Allowed numbers, always finite.
struct Range {
  double low = -unlimited;
  double high = unlimited;
  bool above_low = false;   ///< low itself is not allowed
  bool below_high = false;  ///< high itself is not allowed
};

inline constexpr Range positive{.low = 0.0, .above_low = true};
inline constexpr Range not_negative{.low = 0.0};

}  // namespace poreshock
