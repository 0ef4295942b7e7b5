// Deposit of particles into maps: overlaps worked out by hand, sums, wrapping, and what is refused.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "cloud.hpp"
#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/morphology/analysis.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::reference;

const MPI_Comm world = MPI_COMM_WORLD;

/// A serial grid on every rank.
PixelGrid<2> serial_grid(int width, int height, bool periodic) {
  return PixelGrid<2>(MPI_COMM_SELF, {{width, height}, pixel, {periodic}});
}

TEST(Deposit, SharesASquareAmongFourPixels) {
  const PixelGrid<2> grid = serial_grid(3, 3, false);
  Cloud<2> cloud;
  cloud.add({1.25 * pixel, 1.5 * pixel}, pixel, 1024.0, 3.0, 500.0);
  const PixelField<2> map = deposit_cloud(cloud, exact_scales, grid);
  const std::int64_t quarter = full_coverage / 4;
  EXPECT_EQ(map.coverage, (std::vector<std::int64_t>{0, 0, 0, quarter, 3 * quarter, 0, 0, 0, 0}));
  const std::vector<std::uint8_t> solid = {0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0};
  EXPECT_EQ(map.solid, solid);
  EXPECT_EQ(map.values[0][4], 3.0);
  EXPECT_EQ(map.values[1][4], 500.0);
  EXPECT_TRUE(std::isnan(map.values[0][3]));
  EXPECT_EQ(map.capped, 0);
  EXPECT_EQ(map.clamped, 0);
  EXPECT_EQ(map.skipped, 0);
}

TEST(Deposit, HalfCoveredPixelIsSolid) {
  const PixelGrid<2> grid = serial_grid(2, 1, false);
  Cloud<2> cloud;
  // Two squares of half a pixel's side fill half of pixel 0, one fills a quarter of pixel 1.
  cloud.add({0.25 * pixel, 0.25 * pixel}, 0.5 * pixel, 1024.0, 1.0, 0.0);
  cloud.add({0.75 * pixel, 0.25 * pixel}, 0.5 * pixel, 3072.0, 2.0, 0.0);
  cloud.add({1.25 * pixel, 0.25 * pixel}, 0.5 * pixel, 1024.0, 2.0, 0.0);
  const PixelField<2> map = deposit_cloud(cloud, exact_scales, grid);
  EXPECT_EQ(map.coverage, (std::vector<std::int64_t>{full_coverage / 2, full_coverage / 4}));
  EXPECT_EQ(map.solid[0], 1);
  EXPECT_EQ(map.solid[1], 0);
  // Weighted with mass: (1024 x 1 + 3072 x 2) / 4096.
  EXPECT_EQ(map.values[0][0], 1.75);
}

TEST(Deposit, WrapsAroundPeriodicSidesAndDropsTheRest) {
  Cloud<2> cloud;
  cloud.add({0.0, 0.0}, pixel, 1024.0, 1.0, 0.0);
  cloud.add({7.5 * pixel, 2.5 * pixel}, 2.0 * pixel, 1024.0, 1.0, 0.0);
  const std::int64_t quarter = full_coverage / 4;
  const PixelField<2> wrapped = deposit_cloud(cloud, exact_scales, serial_grid(3, 2, true));
  // The second square spans x pixels 6.5 to 8.5, that is half of 0, all of 1, half of 2.
  EXPECT_EQ(wrapped.coverage,
            (std::vector<std::int64_t>{quarter, 0, quarter, quarter, 2 * quarter, quarter}));
  const PixelField<2> framed = deposit_cloud(cloud, exact_scales, serial_grid(3, 2, false));
  EXPECT_EQ(framed.coverage, (std::vector<std::int64_t>{quarter, 0, 0, 0, 0, 0}));
}

TEST(Deposit, SquareWiderThanThePeriodCoversPixelsTwice) {
  Cloud<2> cloud;
  cloud.add({0.5 * pixel, 1.5 * pixel}, 3.0 * pixel, 1024.0, 1.0, 0.0);
  const PixelField<2> map = deposit_cloud(cloud, exact_scales, serial_grid(2, 3, true));
  const std::int64_t one = full_coverage;
  EXPECT_EQ(map.coverage, (std::vector<std::int64_t>{one, 2 * one, one, 2 * one, one, 2 * one}));
}

TEST(Deposit, CountsWhatItCutsHoldsAndSkips) {
  const PixelGrid<2> grid = serial_grid(8, 8, false);
  Cloud<2> cloud;
  const double x = 4.0 * pixel;
  cloud.add({x, x}, 4.0 * pixel, 1024.0, 1.0, 0.0);  // cut to two pixels
  cloud.add({x, x}, pixel, 1024.0, infinity, -infinity);
  cloud.add({x, x}, pixel, 1024.0, nan_value, 1e300);  // a large value is one like any other
  cloud.add({x, x}, pixel, 65.0 * 1024.0, 1.0, 0.0);   // density out of range
  cloud.add({nan_value, x}, pixel, 1024.0, 1.0, 0.0);
  cloud.add({x, 1e300}, pixel, 1024.0, 1.0, 0.0);
  cloud.add({x, x}, 0.0, 1024.0, 1.0, 0.0);
  cloud.add({x, x}, pixel, -1024.0, 1.0, 0.0);
  const PixelField<2> map = deposit_cloud(cloud, {1024.0, 2.0 * pixel}, grid);
  EXPECT_EQ(map.capped, 1);
  EXPECT_EQ(map.clamped, 4);
  EXPECT_EQ(map.skipped, 4);
  EXPECT_EQ(std::accumulate(map.coverage.begin(), map.coverage.end(), std::int64_t{0}),
            (4 + 3) * full_coverage);
}

TEST(Deposit, ValuesThatAreNotFiniteAreHeld) {
  Cloud<2> cloud;
  cloud.add({0.5 * pixel, 0.5 * pixel}, pixel, 1024.0, infinity, -infinity);
  cloud.add({1.5 * pixel, 0.5 * pixel}, pixel, 1024.0, nan_value, -1.25);
  cloud.add({2.5 * pixel, 0.5 * pixel}, pixel, 1024.0, -4096.1, 0.0);
  const PixelField<2> map = deposit_cloud(cloud, exact_scales, serial_grid(3, 1, false));
  EXPECT_EQ(map.values[0][0], 4096.1);
  EXPECT_EQ(map.values[1][0], -1.25);
  EXPECT_EQ(map.values[0][1], 0.0);
  EXPECT_EQ(map.values[0][2], -4096.1);
  EXPECT_EQ(map.clamped, 3);
}

TEST(Deposit, TotalCoverageIsTheTotalArea) {
  Random random{31};
  Cloud<2> cloud;
  double area = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const double side = 0.2 + 2.0 * random.uniform();
    area += side * side;
    cloud.add({20.0 * random.uniform() * pixel, (2.0 + 16.0 * random.uniform()) * pixel},
              side * pixel, 2000.0, 1.0, 1.0);
  }
  const PixelField<2> map = deposit_cloud(cloud, {2000.0, 3.0 * pixel}, serial_grid(20, 20, true));
  const std::int64_t total =
      std::accumulate(map.coverage.begin(), map.coverage.end(), std::int64_t{0});
  // A square of side 2.2 touches at most 16 pixels, each rounded by at most half a unit.
  EXPECT_NEAR(static_cast<double>(total), area * static_cast<double>(full_coverage), 8.0 * 1000.0);
}

/// Fills all material with one value each of the two fields and expects them in every pixel; a
/// particle in the last row holds other ones.
void expect_uniform(double value, double other, double far_value) {
  Random random{32};
  Cloud<2> cloud = random_cloud<2>({16, 16}, 1500, random);
  std::fill(cloud.value.begin(), cloud.value.end(), value);
  std::fill(cloud.other.begin(), cloud.other.end(), other);
  cloud.add({8.0 * pixel, 19.5 * pixel}, pixel, 1024.0, far_value, -far_value);
  const PixelField<2> map = deposit_cloud(cloud, exact_scales, serial_grid(16, 20, false));
  std::int64_t solid = 0;
  for (std::size_t p = 0; p < 16 * 16; ++p) {
    if (map.solid[p] == 0) continue;
    ++solid;
    ASSERT_EQ(map.values[0][p], value);
    ASSERT_EQ(map.values[1][p], other);
  }
  EXPECT_GT(solid, 200);
}

TEST(Deposit, UniformFieldKeepsItsValueToTheLastBit) {
  expect_uniform(1.5, 875.0, 0.0);
  expect_uniform(300.0, 298.15, 1e9);
  expect_uniform(-1.0 / 3.0, 47.3e9, 1e-5);
  expect_uniform(1e-300, -5e-324, 0.0);
  expect_uniform(-1.7e308, 1.7976931348623157e308, 1.0);
  expect_uniform(0.1, -7.7e-13, 1e200);
}

TEST(Deposit, MeanLiesAmongTheValuesInThePixel) {
  Random random{37};
  Cloud<2> cloud = random_cloud<2>({16, 16}, 1500, random);
  for (std::size_t i = 0; i < cloud.size(); ++i) {
    cloud.value[i] = 298.15 + 1e-13 * random.uniform();
    cloud.other[i] = i % 2 == 0 ? 1e6 : 1.0000001e6;
  }
  // Far hotter than all the rest, in a corner: it may not drag the others with it.
  cloud.add({16.5 * pixel, 16.5 * pixel}, pixel, 1024.0, 1e20, 1e20);
  const PixelField<2> map = deposit_cloud(cloud, exact_scales, serial_grid(17, 17, false));
  for (std::size_t row = 0; row < 15; ++row) {
    for (std::size_t p = 17 * row; p < 17 * row + 15; ++p) {
      if (map.solid[p] == 0) continue;
      ASSERT_GE(map.values[0][p], 298.15);
      ASSERT_LE(map.values[0][p], 298.15 + 1e-13);
      ASSERT_GE(map.values[1][p], 1e6);
      ASSERT_LE(map.values[1][p], 1.0000001e6);
    }
  }
}

TEST(Deposit, MeanAgreesWithFloatingPointSums) {
  Random random{33};
  const Cloud<2> cloud = random_cloud<2>({6, 6}, 200, random);
  const PixelField<2> map = deposit_cloud(cloud, exact_scales, serial_grid(6, 6, false));
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      double weights = 0.0, sum = 0.0, covered = 0.0, parts = 0.0;
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        const double side = std::sqrt(cloud.mass[i] / cloud.density[i]) / pixel;
        const auto overlap = [&](double centre, int at) {
          return std::max(0.0, std::min(centre + 0.5 * side, at + 1.0) -
                                   std::max(centre - 0.5 * side, static_cast<double>(at)));
        };
        const double area = overlap(cloud.position[0][i] / pixel, column) *
                            overlap(cloud.position[1][i] / pixel, row);
        parts += area > 0.0 ? 1.0 : 0.0;
        covered += area;
        weights += area * cloud.density[i];
        sum += area * cloud.density[i] * cloud.value[i];
      }
      const auto p = static_cast<std::size_t>(row * 6 + column);
      // Every part is rounded by at most 2^-19, and a wrong weight moves the mean of values that
      // differ by at most 4; values themselves are rounded down to 2 x 2^-31.
      const double rounding = parts * 0x1p-19;
      EXPECT_NEAR(static_cast<double>(map.coverage[p]) / full_coverage, covered, rounding);
      if (map.solid[p] == 0) continue;
      const double tolerance = 4.0 * rounding / (weights / 1024.0) + 0x1p-30;
      EXPECT_NEAR(map.values[0][p], sum / weights, tolerance);
    }
  }
}

TEST(Deposit, OneRowPerRankAndNoParticles) {
  const int ranks = size(world);
  const PixelGrid<2> grid(world, {{4, ranks}, pixel, {false}});
  const PixelField<2> map = deposit_cloud(Cloud<2>{}, exact_scales, grid);
  EXPECT_EQ(std::count(map.solid.begin(), map.solid.end(), 0), 8);
  const double threshold[] = {0.0};
  EXPECT_EQ(count(map, 0, threshold, world).pixels, 0);
}

TEST(Deposit, CubeSharesItselfAmongVoxels) {
  const PixelGrid<3> grid(MPI_COMM_SELF, {{2, 3, 2}, pixel, {true, false}});
  Cloud<3> cloud;
  // x from 1.75 to 2.75 wraps, y is centred on the frame, z from 0.5 to 1.5.
  cloud.add({2.25 * pixel, 0.0, pixel}, pixel, 1024.0, 1.0, 2.0);
  const PixelField<3> map = deposit_cloud(cloud, exact_scales, grid);
  const std::int64_t part = full_coverage / 16;
  EXPECT_EQ(map.coverage,
            (std::vector<std::int64_t>{3 * part, part, 0, 0, 0, 0, 3 * part, part, 0, 0, 0, 0}));
}

TEST(Deposit, PiledUpParticlesStopEveryRank) {
  const PixelGrid<2> grid(world, {{2, size(world)}, pixel, {false}});
  Cloud<2> cloud;
  const double row = rank(world) == size(world) - 1 ? 0.5 : 1e6;
  for (int i = 0; i < 257; ++i) {
    cloud.add({0.5 * pixel, row * pixel}, pixel, 64.0 * 1024.0, 1.0, 1.0);
  }
  try {
    deposit_cloud(cloud, exact_scales, grid);
    FAIL() << "accepted";
  } catch (const StateError& error) {
    EXPECT_STREQ(error.what(),
                 "particles pile up in 1 pixels of the map: more than 16384 typical densities in "
                 "one pixel. Check the positions and densities of the particles, and the density "
                 "scale.");
  }
}

TEST(Deposit, RefusesColumnsAndScalesThatDoNotFit) {
  const PixelGrid<2> grid = serial_grid(2, 2, false);
  Cloud<2> cloud;
  cloud.add({pixel, pixel}, pixel, 1024.0, 1.0, 1.0);
  EXPECT_THROW(deposit_cloud(cloud, {0.0, pixel}, grid), InputError);
  EXPECT_THROW(deposit_cloud(cloud, {1024.0, -pixel}, grid), InputError);
  cloud.density.push_back(1024.0);
  EXPECT_THROW(deposit_cloud(cloud, exact_scales, grid), InputError);
}

}  // namespace
