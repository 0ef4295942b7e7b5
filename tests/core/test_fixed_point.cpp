// Integers stand for sums of doubles: rounding, exactness, no order, no rank count.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "poreshock/core/fixed_point.hpp"
#include "poreshock/core/parallel.hpp"
#include "support/random_numbers.hpp"

namespace poreshock {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;
constexpr Int128 one = 1;

TEST(Quantise, RoundsToTheNearestMultipleAndTiesToEven) {
  EXPECT_EQ(quantise(0.74, 4.0), 3);
  EXPECT_EQ(quantise(-0.74, 4.0), -3);
  EXPECT_EQ(quantise(2.5, 1.0), 2);
  EXPECT_EQ(quantise(3.5, 1.0), 4);
  EXPECT_EQ(quantise(-2.5, 1.0), -2);
  EXPECT_EQ(quantise(0.0, 1e300), 0);
}

TEST(Quantise, IsExactForMultiplesOfTheQuantum) {
  const double quantum = std::ldexp(1.0, -40);
  for (const std::int64_t n : {1L, -7L, (1L << 52) + 1, -(1L << 53) + 1}) {
    EXPECT_EQ(quantise(static_cast<double>(n) * quantum, 1.0 / quantum), n);
  }
}

TEST(Quantise, StopsAtTheEndOfItsRange) {
  const std::int64_t end = std::int64_t{1} << 62;
  EXPECT_EQ(quantise(1e30, 1.0), end);
  EXPECT_EQ(quantise(-1e30, 1.0), -end);
  EXPECT_EQ(quantise(std::numeric_limits<double>::infinity(), 1.0), end);
  EXPECT_EQ(quantise(std::ldexp(1.0, 62), 1.0), end);
  EXPECT_EQ(quantise(std::nextafter(std::ldexp(1.0, 62), 0.0), 1.0), end - 512);
}

TEST(Quantise, OfLanesIsTheSumOfEach) {
  // Ties, both signs, and numbers beside and beyond the range in which doubles add exactly.
  const Lanes plain = {2.5, -2.5, 3.5, 0x1p40 + 0.25, -0.74, 0x1p48 + 0.5, 0.0, -7.0};
  Lanes large = plain, huge = plain;
  large[6] = 0x1p50 + 1.0;
  huge[1] = -1e30;
  huge[7] = std::numeric_limits<double>::infinity();
  for (const Lanes& values : {plain, large, huge}) {
    for (const double per_quantum : {0.25, 1.0, 0x1p20}) {
      for (int count = 1; count <= lane_count; ++count) {
        Int128 sum = 0;
        for (int k = 0; k < count; ++k) sum += quantise(values[k], per_quantum);
        EXPECT_TRUE(sum_of_quanta(values, count, per_quantum) == sum) << count << per_quantum;
      }
    }
  }
}

TEST(PowerOfTwo, IsTheLargestNotAbove) {
  EXPECT_EQ(power_of_two_below(1.0), 1.0);
  EXPECT_EQ(power_of_two_below(std::nextafter(1.0, 0.0)), 0.5);
  EXPECT_EQ(power_of_two_below(std::nextafter(1.0, 2.0)), 1.0);
  EXPECT_EQ(power_of_two_below(1000.0), 512.0);
  reference::Random random{1};
  for (int k = 0; k < 1000; ++k) {
    const double value = std::ldexp(1.0 + random.uniform(), random.below(2000) - 1000);
    const double power = power_of_two_below(value);
    EXPECT_LE(power, value);
    EXPECT_GT(2.0 * power, value);
    int exponent = 0;
    EXPECT_EQ(std::frexp(power, &exponent), 0.5);
  }
}

TEST(ExactSum, AddsNumbersOfEverySignAndSizeOverRanks) {
  const Int128 ranks = size(world), me = rank(world);
  // One value per place where the two parts of a sum could lose a carry or a sign.
  std::vector<Int128> values = {me + 1,
                                -(me + 1),
                                (one << 40) - 1 + me,
                                -(one << 40) - me,
                                (one << 100) + 3 * me,
                                -(one << 100) - 5 * me,
                                me % 2 == 0 ? (one << 90) : -(one << 90) - 1,
                                0};
  const Int128 triangle = ranks * (ranks - 1) / 2, odd = ranks / 2, even = ranks - odd;
  const std::vector<Int128> expected = {triangle + ranks,
                                        -triangle - ranks,
                                        ranks * ((one << 40) - 1) + triangle,
                                        -ranks * (one << 40) - triangle,
                                        ranks * (one << 100) + 3 * triangle,
                                        -ranks * (one << 100) - 5 * triangle,
                                        even * (one << 90) - odd * ((one << 90) + 1),
                                        0};
  sum(values, world);
  ASSERT_EQ(values.size(), expected.size());
  for (std::size_t k = 0; k < values.size(); ++k) EXPECT_TRUE(values[k] == expected[k]) << k;
}

TEST(ExactSum, DoesNotDependOnHowTermsAreSharedOut) {
  reference::Random random{7};
  std::vector<double> terms;
  for (int k = 0; k < 1000; ++k) {
    terms.push_back(std::ldexp(random.uniform() - 0.5, random.below(60) - 30));
  }
  const double inverse_quantum = std::ldexp(1.0, 30);
  Int128 serial = 0;
  for (const double term : terms) serial += quantise(term, inverse_quantum);
  std::vector<Int128> shared = {0};
  for (std::size_t k = terms.size(); k-- > 0;) {
    if (static_cast<int>(k % 7) % size(world) == rank(world)) {
      shared[0] += quantise(terms[k], inverse_quantum);
    }
  }
  sum(shared, world);
  EXPECT_TRUE(shared[0] == serial);
}

TEST(Words, BringEveryValueBack) {
  const Int128 least = -(((one << 126) - 1) * 2 + 1) - 1;
  const std::vector<Int128> values = {
      0,           1, -1, one << 64, -(one << 64), (one << 63), -(one << 63), least, -(least + 1),
      -12345678901};
  const std::vector<std::int64_t> words = to_words(values);
  ASSERT_EQ(words.size(), 2 * values.size());
  const std::vector<Int128> back = from_words(words);
  ASSERT_EQ(back.size(), values.size());
  for (std::size_t k = 0; k < values.size(); ++k) EXPECT_TRUE(back[k] == values[k]) << k;
}

TEST(Words, AreTheHighAndTheLowHalf) {
  EXPECT_EQ(to_words({-1}), (std::vector<std::int64_t>{-1, -1}));
  EXPECT_EQ(to_words({5}), (std::vector<std::int64_t>{0, 5}));
  EXPECT_EQ(to_words({(one << 64) * 3 - 2}), (std::vector<std::int64_t>{2, -2}));
  EXPECT_EQ(to_words({}), std::vector<std::int64_t>{});
}

}  // namespace
}  // namespace poreshock
