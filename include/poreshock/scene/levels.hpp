#pragma once
// Ascending numbers given by their ends and their distance.

#include <optional>
#include <vector>

namespace poreshock {

/// Most thresholds of one field: more would not fit the 16-bit ranks of the pixel counts.
inline constexpr double most_thresholds = 65534.0;

/// from, from + step, ... up to `to`, each as the number of at most 15 digits that is meant: 0.3
/// and not 0.1 + 2 x 0.1, which is a little more. Nothing when step <= 0, to < from or there are
/// more than most_thresholds.
std::optional<std::vector<double>> levels_between(double from, double to, double step);

}  // namespace poreshock
