// Rows are shared out completely, never too thin, and as evenly as any search could do it.
#include <gtest/gtest.h>

#include <cmath>
#include <numeric>
#include <string>

#include "grid/partitions.hpp"
#include "poreshock/core/error.hpp"
#include "poreshock/grid/partition.hpp"
#include "support/random_numbers.hpp"

namespace poreshock {
namespace {

using test::all_partitions;
using test::least_rows;

constexpr SlabLimits quadratic{3, 2, 5}, cubic{3, 3, 6};

void expect_valid(const std::vector<int>& starts, int rows, int parts, SlabLimits limits) {
  ASSERT_EQ(starts.size(), static_cast<std::size_t>(parts) + 1);
  EXPECT_EQ(starts.front(), 0);
  EXPECT_EQ(starts.back(), rows);
  for (int p = 0; p < parts; ++p) {
    EXPECT_GE(starts[p + 1] - starts[p], least_rows(p, parts, limits));
  }
}

std::vector<double> random_weights(int rows, std::uint64_t seed) {
  reference::Random random{seed};
  std::vector<double> weights;
  for (int row = 0; row < rows; ++row) {
    // Particle counts: many empty rows, full ones and a few that weigh much more.
    const int kind = random.below(4);
    weights.push_back(kind == 0 ? 0.0 : (kind == 1 ? 100.0 : 1.0) * random.below(20));
  }
  return weights;
}

double least_bottleneck(const std::vector<double>& weights, int parts, SlabLimits limits) {
  double best = std::accumulate(weights.begin(), weights.end(), 0.0);
  for (const auto& starts : all_partitions(static_cast<int>(weights.size()), parts, limits)) {
    best = std::min(best, heaviest(weights, starts));
  }
  return best;
}

TEST(Heaviest, IsTheLargestSumOfASlab) {
  EXPECT_EQ(heaviest({1.0, 2.0, 4.0, 8.0}, {0, 2, 3, 4}), 8.0);
  EXPECT_EQ(heaviest({1.0, 2.0, 4.0, 8.0}, {0, 1, 3, 4}), 8.0);
  EXPECT_EQ(heaviest({5.0, 2.0, 4.0, 1.0}, {0, 2, 4}), 7.0);
  EXPECT_EQ(heaviest({0.0, 0.0}, {0, 1, 2}), 0.0);
}

TEST(Partition, BottleneckIsThatOfTheBestOfAll) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    for (const SlabLimits limits : {quadratic, cubic, SlabLimits{1, 1, 1}}) {
      const int parts = 2 + static_cast<int>(seed % 3);
      const int rows = 15 + static_cast<int>(seed % 5);
      const std::vector<double> weights = random_weights(rows, seed);
      const std::vector<int> starts = partition_rows(weights, parts, limits);
      expect_valid(starts, rows, parts, limits);
      EXPECT_EQ(heaviest(weights, starts), least_bottleneck(weights, parts, limits))
          << "seed " << seed << ", " << parts << " parts";
    }
  }
}

TEST(Partition, FullSlabBelowMayHaveToGiveUpARow) {
  // Filling the first slab to the brim would leave both rows of 9 to the second.
  const std::vector<double> weights = {1.0, 1.0, 9.0, 9.0, 0.0};
  EXPECT_EQ(heaviest(weights, partition_rows(weights, 3, {1, 2, 1})), 10.0);
}

TEST(Partition, ThinnestSlabsThatFitAreFound) {
  // Exactly as many rows as needed: one partition is left, whatever the weights.
  for (int parts = 2; parts < 7; ++parts) {
    const int rows = cubic.first + (parts - 2) * cubic.inner + cubic.last;
    const std::vector<double> weights = random_weights(rows, 17);
    const std::vector<int> starts = partition_rows(weights, parts, cubic);
    expect_valid(starts, rows, parts, cubic);
    EXPECT_EQ(all_partitions(rows, parts, cubic), std::vector<std::vector<int>>{starts});
  }
}

TEST(Partition, OfEmptyOrOneSidedRowsRespectsTheLimits) {
  expect_valid(partition_rows(std::vector<double>(20, 0.0), 4, cubic), 20, 4, cubic);
  std::vector<double> low(40, 0.0);
  low[0] = low[1] = 1000.0;
  expect_valid(partition_rows(low, 5, quadratic), 40, 5, quadratic);
  std::vector<double> high(40, 0.0);
  high[38] = high[39] = 1e9;
  expect_valid(partition_rows(high, 5, quadratic), 40, 5, quadratic);
}

TEST(Partition, OfEqualRowsIsEven) {
  const std::vector<double> weights(640, 104.0);
  for (const int parts : {2, 4, 8, 64}) {
    const std::vector<int> starts = partition_rows(weights, parts, cubic);
    expect_valid(starts, 640, parts, cubic);
    EXPECT_EQ(heaviest(weights, starts), 104.0 * 640 / parts);
  }
}

TEST(Partition, OfManyRowsStaysWithinOneRowOfTheMean) {
  std::vector<double> weights;
  for (int row = 0; row < 5000; ++row) weights.push_back(100.0 + 50.0 * std::sin(0.01 * row));
  const double mean = std::accumulate(weights.begin(), weights.end(), 0.0) / 48;
  const std::vector<int> starts = partition_rows(weights, 48, cubic);
  expect_valid(starts, 5000, 48, cubic);
  EXPECT_LE(heaviest(weights, starts), mean + 150.0);
}

TEST(Partition, OfOneRankIsTheWholeDomain) {
  EXPECT_EQ(partition_rows({1.0, 2.0}, 1, cubic), (std::vector<int>{0, 2}));
}

TEST(Partition, SaysWhatToDoWhenRowsDoNotSuffice) {
  std::string text;
  try {
    partition_rows(std::vector<double>(11, 1.0), 3, cubic);
  } catch (const InputError& error) {
    text = error.what();
  }
  EXPECT_EQ(text,
            "the domain has 11 rows of nodes along the shock axis, 3 ranks need at least 12: use "
            "fewer ranks or smaller cells");
}

}  // namespace
}  // namespace poreshock
