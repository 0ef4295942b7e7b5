// Vectors of eight: what they do lane by lane, at any address of a double.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstring>

#include "poreshock/core/lanes.hpp"

namespace poreshock {
namespace {

/// Eight vectors of eight that start `shift` doubles behind a cache line.
struct Block {
  alignas(64) double numbers[(lane_count + 1) * lane_count] = {};
  std::size_t shift;

  explicit Block(std::size_t s) : shift(s) {
    for (int k = 0; k < lane_count * lane_count; ++k) numbers[shift + k] = k;
  }
  Lanes* lanes() { return reinterpret_cast<Lanes*>(numbers + shift); }
};

TEST(Lanes, TransposeAtAnyAddress) {
  for (std::size_t shift = 0; shift < lane_count; ++shift) {
    Block block(shift);
    transpose(block.lanes());
    for (int k = 0; k < lane_count; ++k) {
      for (int j = 0; j < lane_count; ++j) {
        EXPECT_EQ(block.numbers[shift + k * lane_count + j], j * lane_count + k) << shift;
      }
    }
    transpose(block.lanes());
    EXPECT_EQ(std::memcmp(block.numbers, Block(shift).numbers, sizeof block.numbers), 0) << shift;
  }
}

TEST(Lanes, FusedRoundsOnce) {
  // (1 + e)(1 - e) - 1 = -e^2, which a rounded product would lose.
  const double e = 0x1p-30;
  const Lanes a = (1.0 + e) - Lanes{}, b = (1.0 - e) - Lanes{}, c = -1.0 - Lanes{};
  const Lanes whole = fused(a, b, c), one_factor = fused(1.0 + e, b, c);
  const HalfLanes half = fused(1.0 + e, low_half(b), low_half(c));
  for (int k = 0; k < lane_count; ++k) {
    EXPECT_EQ(whole[k], -0x1p-60);
    EXPECT_EQ(one_factor[k], -0x1p-60);
  }
  for (int k = 0; k < lane_count / 2; ++k) EXPECT_EQ(half[k], -0x1p-60);
}

TEST(Lanes, ChooseLaneByLane) {
  const Lanes a = {1.0, -2.0, 3.0, 0.0, 5.0, -6.0, 7.0, -8.0};
  const Lanes b = {1.0, 2.0, -3.0, -0.0, 5.5, -6.0, -7.0, 8.0};
  const Lanes most = larger(a, b), chosen = where_differ(a, b, a + a, b);
  const Lanes less = where_less(a, b, a, a + b);
  EXPECT_EQ(bits_less(a, b), 0b10010010u);
  EXPECT_EQ(bits_less(b, a), 0b01000100u);
  EXPECT_EQ(first_bits(3), 0b111u);
  for (int k = 0; k < lane_count; ++k) {
    EXPECT_EQ(most[k], std::max(a[k], b[k]));
    EXPECT_EQ(chosen[k], a[k] != b[k] ? 2.0 * a[k] : b[k]);
    EXPECT_EQ(less[k], a[k] < b[k] ? a[k] : a[k] + b[k]);
  }
  EXPECT_TRUE(std::signbit(chosen[3]));
}

TEST(Lanes, SquareRoot) {
  const Lanes x = {0.0, 1.0, 2.0, 3.0, 1e-300, 1e300, 0.25, 7.0};
  const Lanes root = square_root(x);
  for (int k = 0; k < lane_count; ++k) EXPECT_EQ(root[k], std::sqrt(x[k]));
}

TEST(Lanes, Halves) {
  const Lanes x = {1.0, 2.0, 4.0, 8.0, 16.0, 32.0, 64.0, 128.0};
  const Lanes turned = join(high_half(x), low_half(x));
  for (int k = 0; k < lane_count; ++k) EXPECT_EQ(turned[k], x[(k + 4) % lane_count]);
}

}  // namespace
}  // namespace poreshock
