// Freed memory goes back to the system.

#include <gtest/gtest.h>

#include <vector>

#include "poreshock/core/memory.hpp"
#include "support/sanitizer.hpp"

namespace poreshock {
namespace {

TEST(Memory, OfALargeBlockGoesBackAtOnceThoughAnotherLiesAboveIt) {
  constexpr std::int64_t block = std::int64_t{64} << 20, slack = std::int64_t{4} << 20;
  if (test::allocator_of_the_sanitizer) GTEST_SKIP() << "the sanitizer keeps what is freed";
  if (own_memory() == 0) GTEST_SKIP() << "the system does not say what a process holds";
  std::vector<char> low(block, 1), high(block, 1);
  const std::int64_t with_both = own_memory();
  std::vector<char>().swap(low);
  EXPECT_LT(own_memory(), with_both - block + slack);
  EXPECT_EQ(high.back(), 1);
  EXPECT_GE(peak_memory(), 2 * block);
}

}  // namespace
}  // namespace poreshock
