#pragma once
// Every way to give contiguous rows to ranks.

#include <vector>

#include "poreshock/grid/partition.hpp"

namespace poreshock::test {

/// Least rows of one of `parts` slabs.
inline int least_rows(int part, int parts, SlabLimits limits) {
  if (parts == 1) return 1;
  if (part == 0) return limits.first;
  return part + 1 == parts ? limits.last : limits.inner;
}

/// All row starts (parts + 1 entries) that respect the limits.
inline std::vector<std::vector<int>> all_partitions(int rows, int parts, SlabLimits limits) {
  std::vector<std::vector<int>> open = {{0}};
  for (int part = 0; part < parts; ++part) {
    std::vector<std::vector<int>> longer;
    for (const std::vector<int>& starts : open) {
      for (int end = starts.back() + least_rows(part, parts, limits); end <= rows; ++end) {
        if (part + 1 == parts && end != rows) continue;
        longer.push_back(starts);
        longer.back().push_back(end);
      }
    }
    open = std::move(longer);
  }
  return open;
}

}  // namespace poreshock::test
