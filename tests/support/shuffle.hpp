#pragma once
// Orders of things: as they come, and well mixed.

#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

#include "support/random_numbers.hpp"

namespace poreshock::test {

/// 0 ... count - 1.
inline std::vector<std::uint32_t> natural_order(std::size_t count) {
  std::vector<std::uint32_t> order(count);
  std::iota(order.begin(), order.end(), 0U);
  return order;
}

/// The same in an order that follows from the seed (Fisher and Yates).
inline std::vector<std::uint32_t> shuffled(std::size_t count, std::uint64_t seed) {
  std::vector<std::uint32_t> order = natural_order(count);
  reference::Random random{seed};
  for (std::size_t k = count; k > 1; --k) {
    std::swap(order[k - 1], order[static_cast<std::size_t>(random.below(static_cast<int>(k)))]);
  }
  return order;
}

}  // namespace poreshock::test
