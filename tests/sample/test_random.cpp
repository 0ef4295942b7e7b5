#include <gtest/gtest.h>

#include "sample/random.hpp"

namespace poreshock {
namespace {

using Words = std::array<std::uint32_t, 4>;

// Known answers published with the Random123 library.
TEST(Random, PhiloxGivesThePublishedWords) {
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}), (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Random, UniformsFillTheOpenInterval) {
  constexpr int blocks = 100000;
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < blocks; ++i) {
    for (const double u : uniforms(5, RandomStream::position, static_cast<std::uint64_t>(i), 0)) {
      ASSERT_GT(u, 0.0);
      ASSERT_LT(u, 1.0);
      sum += u;
      squares += u * u;
    }
  }
  const double n = 4.0 * blocks;
  // Four standard errors of the mean and of the mean square.
  EXPECT_NEAR(sum / n, 0.5, 4.0 * std::sqrt(1.0 / 12.0 / n));
  EXPECT_NEAR(squares / n, 1.0 / 3.0, 4.0 * std::sqrt(4.0 / 45.0 / n));
}

TEST(Random, TruncatedNormalHasItsMoments) {
  constexpr int n = 200000;
  constexpr double cut = 2.5;
  double sum = 0.0, squares = 0.0;
  for (int i = 0; i < n; ++i) {
    const double z = truncated_normal(3, RandomStream::radius, static_cast<std::uint64_t>(i), cut);
    ASSERT_LE(std::fabs(z), cut);
    sum += z;
    squares += z * z;
  }
  // Variance 1 - 2 cut phi(cut) / (2 Phi(cut) - 1).
  const double density = std::exp(-0.5 * cut * cut) / std::sqrt(2.0 * 3.141592653589793);
  const double variance = 1.0 - 2.0 * cut * density / std::erf(cut / std::sqrt(2.0));
  EXPECT_NEAR(sum / n, 0.0, 4.0 * std::sqrt(variance / n));
  EXPECT_NEAR(squares / n, variance, 4.0 * std::sqrt(2.0 / n));
}

}  // namespace
}  // namespace poreshock
