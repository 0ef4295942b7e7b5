// Deposit of particles into maps: overlaps worked out by hand, sums, wrapping, and the same bits on
// any number of ranks and in any order.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <numeric>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/morphology/analysis.hpp"
#include "poreshock/morphology/pixel_map.hpp"
#include "support/random_numbers.hpp"

namespace {

using namespace poreshock;
using reference::Random;

const MPI_Comm world = MPI_COMM_WORLD;

/// Columns of particles with two values.
template <int Dim>
struct Cloud {
  std::array<std::vector<double>, Dim> position;
  std::vector<double> mass, density, value, other;

  std::size_t size() const { return mass.size(); }

  /// Adds a particle by the side of its square in m.
  void add(const std::array<double, Dim>& centre, double side, double rho, double a, double b) {
    for (std::size_t axis = 0; axis < Dim; ++axis) position[axis].push_back(centre[axis]);
    mass.push_back(rho * std::pow(side, Dim));
    density.push_back(rho);
    value.push_back(a);
    other.push_back(b);
  }
  void add_from(const Cloud& from, std::size_t i) {
    for (std::size_t axis = 0; axis < Dim; ++axis) position[axis].push_back(from.position[axis][i]);
    mass.push_back(from.mass[i]);
    density.push_back(from.density[i]);
    value.push_back(from.value[i]);
    other.push_back(from.other[i]);
  }
};

template <int Dim>
PixelField<Dim> deposit_cloud(const Cloud<Dim>& cloud, const PixelScales& scales,
                              const PixelGrid<Dim>& grid) {
  PixelSources<Dim> sources;
  for (std::size_t axis = 0; axis < Dim; ++axis) sources.position[axis] = cloud.position[axis];
  sources.mass = cloud.mass;
  sources.density = cloud.density;
  const PixelValues values[] = {{cloud.value, 2.0}, {cloud.other, 1000.0}};
  return deposit<Dim>(sources, values, scales, grid);
}

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

/// Pixels of 1/4 m, so that all numbers are exact.
constexpr double pixel = 0.25;
constexpr PixelScales exact_scales = {1024.0, 8.0 * pixel};

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
  cloud.add({x, x}, 4.0 * pixel, 1024.0, 1.0, 0.0);   // cut to two pixels
  cloud.add({x, x}, pixel, 1024.0, 5000.0, -3e6);     // both values out of range
  cloud.add({x, x}, pixel, 1024.0, nan_value, 0.0);   // value becomes 0
  cloud.add({x, x}, pixel, 65.0 * 1024.0, 1.0, 0.0);  // density out of range
  cloud.add({nan_value, x}, pixel, 1024.0, 1.0, 0.0);
  cloud.add({x, 1e300}, pixel, 1024.0, 1.0, 0.0);
  cloud.add({x, x}, 0.0, 1024.0, 1.0, 0.0);
  cloud.add({x, x}, pixel, -1024.0, 1.0, 0.0);
  const PixelField<2> map = deposit_cloud(cloud, {1024.0, 2.0 * pixel}, grid);
  EXPECT_EQ(map.capped, 1);
  EXPECT_EQ(map.clamped, 4);
  EXPECT_EQ(map.skipped, 3);
  EXPECT_EQ(std::accumulate(map.coverage.begin(), map.coverage.end(), std::int64_t{0}),
            (4 + 3) * full_coverage);
}

TEST(Deposit, ValuesOutOfRangeAreHeldAtTheirLimit) {
  Cloud<2> cloud;
  cloud.add({0.5 * pixel, 0.5 * pixel}, pixel, 1024.0, 1e30, -1e30);
  const PixelField<2> map = deposit_cloud(cloud, exact_scales, serial_grid(1, 1, false));
  EXPECT_EQ(map.values[0][0], 2048.0 * 2.0);
  EXPECT_EQ(map.values[1][0], -2048.0 * 1000.0);
}

/// Irregular particles with sides of 0.3 to 1.6 pixels, some beyond the map.
template <int Dim>
Cloud<Dim> random_cloud(const std::array<int, Dim>& pixels, int count, Random& random) {
  Cloud<Dim> cloud;
  for (int i = 0; i < count; ++i) {
    std::array<double, Dim> centre{};
    for (std::size_t axis = 0; axis < Dim; ++axis) {
      centre[axis] = (random.uniform() * (pixels[axis] + 1.0) - 0.5) * pixel;
    }
    const double side = (0.3 + 1.3 * random.uniform()) * pixel;
    cloud.add(centre, side, 1000.0 + 3000.0 * random.uniform(), 4.0 * random.uniform() - 2.0,
              3000.0 * random.uniform());
  }
  return cloud;
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

TEST(Deposit, UniformFieldStaysUniformToTheLastBit) {
  Random random{32};
  Cloud<2> cloud = random_cloud<2>({16, 16}, 1500, random);
  std::fill(cloud.value.begin(), cloud.value.end(), 1.5);
  std::fill(cloud.other.begin(), cloud.other.end(), 875.0);
  const PixelField<2> map = deposit_cloud(cloud, exact_scales, serial_grid(16, 16, false));
  std::int64_t solid = 0;
  for (std::size_t p = 0; p < map.coverage.size(); ++p) {
    if (map.solid[p] == 0) continue;
    ++solid;
    ASSERT_EQ(map.values[0][p], 1.5);
    ASSERT_EQ(map.values[1][p], 875.0);
  }
  EXPECT_GT(solid, 200);
}

TEST(Deposit, MeanAgreesWithFloatingPointSums) {
  Random random{33};
  const Cloud<2> cloud = random_cloud<2>({6, 6}, 200, random);
  const PixelField<2> map = deposit_cloud(cloud, exact_scales, serial_grid(6, 6, false));
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      double weights = 0.0, sum = 0.0, covered = 0.0;
      for (std::size_t i = 0; i < cloud.size(); ++i) {
        const double side = std::sqrt(cloud.mass[i] / cloud.density[i]) / pixel;
        const auto overlap = [&](double centre, int at) {
          return std::max(0.0, std::min(centre + 0.5 * side, at + 1.0) -
                                   std::max(centre - 0.5 * side, static_cast<double>(at)));
        };
        const double area = overlap(cloud.position[0][i] / pixel, column) *
                            overlap(cloud.position[1][i] / pixel, row);
        covered += area;
        weights += area * cloud.density[i];
        sum += area * cloud.density[i] * cloud.value[i];
      }
      const auto p = static_cast<std::size_t>(row * 6 + column);
      EXPECT_NEAR(static_cast<double>(map.coverage[p]) / full_coverage, covered, 200 * 0x1p-19);
      // Weights of 200 particles are rounded to 2^-19 each, values of size 2 to 2^-20.
      if (map.solid[p] != 0) EXPECT_NEAR(map.values[0][p], sum / weights, 2e-3);
    }
  }
}

/// How the particles are dealt out to the ranks.
enum class Dealing { all_on_first, all_on_last, round_robin, backwards, slabs };

template <int Dim>
Cloud<Dim> dealt(const Cloud<Dim>& cloud, Dealing dealing, int rows) {
  const int ranks = size(world);
  const int self = rank(world);
  Cloud<Dim> mine;
  for (std::size_t n = 0; n < cloud.size(); ++n) {
    const std::size_t i = dealing == Dealing::backwards ? cloud.size() - 1 - n : n;
    const auto row = static_cast<int>(std::floor(cloud.position[Dim - 1][i] / pixel));
    int owner = 0;
    if (dealing == Dealing::all_on_last) owner = ranks - 1;
    if (dealing == Dealing::round_robin) owner = static_cast<int>(i) % ranks;
    if (dealing == Dealing::backwards) owner = static_cast<int>(i / 7) % ranks;
    if (dealing == Dealing::slabs) owner = std::clamp(row * ranks / rows, 0, ranks - 1);
    if (owner == self) mine.add_from(cloud, i);
  }
  return mine;
}

/// Rows per rank: even, or all that can go on the first or the last rank.
std::vector<std::vector<int>> row_splits(int rows) {
  const auto ranks = static_cast<std::size_t>(size(world));
  std::vector<int> low(ranks, 1);
  low.front() = rows - static_cast<int>(ranks) + 1;
  const std::vector<int> high(low.rbegin(), low.rend());
  return {{}, low, high};
}

template <class T>
void expect_same_bits(const std::vector<T>& found, const std::vector<T>& whole, std::size_t start,
                      const char* what) {
  ASSERT_LE(start + found.size(), whole.size());
  EXPECT_EQ(std::memcmp(found.data(), whole.data() + start, found.size() * sizeof(T)), 0) << what;
}

template <int Dim>
void expect_same_bits_however_dealt(const PixelLayout<Dim>& layout, const Cloud<Dim>& cloud) {
  const int rows = layout.pixels[Dim - 1];
  const std::vector<double> thresholds = {-1.0, -0.25, 0.0, 0.3, 0.9};
  const PixelGrid<Dim> whole_grid(MPI_COMM_SELF, layout);
  const PixelField<Dim> whole = deposit_cloud(cloud, exact_scales, whole_grid);
  const MapCounts<Dim> whole_counts = count(whole, 0, thresholds, MPI_COMM_SELF);
  for (const std::vector<int>& split : row_splits(rows)) {
    const PixelGrid<Dim> grid(world, layout, split);
    const std::size_t start = static_cast<std::size_t>(grid.first_row()) * grid.row_size();
    for (const Dealing dealing : {Dealing::all_on_first, Dealing::all_on_last, Dealing::round_robin,
                                  Dealing::backwards, Dealing::slabs}) {
      const PixelField<Dim> map = deposit_cloud(dealt(cloud, dealing, rows), exact_scales, grid);
      EXPECT_EQ(map.rows, grid.rows());
      expect_same_bits(map.coverage, whole.coverage, start, "coverage");
      // Owned rows and the row of the upper neighbour; above the last row the map is void.
      expect_same_bits(map.solid, whole.solid, start, "solid");
      for (std::size_t k = 0; k < 2; ++k) {
        expect_same_bits(map.values[k], whole.values[k], start, "values");
      }
      EXPECT_EQ(map.capped, whole.capped);
      EXPECT_EQ(map.skipped, whole.skipped);
      EXPECT_TRUE(count(map, 0, thresholds, world) == whole_counts);
    }
  }
}

TEST(Deposit, SameBitsHoweverParticlesAndRowsAreDealt) {
  Random random{34};
  const PixelLayout<2> layout = {{11, 17}, pixel, {true}};
  Cloud<2> cloud = random_cloud<2>(layout.pixels, 600, random);
  cloud.add({pixel, pixel}, 20.0 * pixel, 2000.0, 0.5, 0.5);  // capped
  cloud.add({nan_value, pixel}, pixel, 2000.0, 0.5, 0.5);     // skipped
  expect_same_bits_however_dealt(layout, cloud);
}

TEST(Deposit, SameBitsInThreeDimensions) {
  Random random{35};
  const PixelLayout<3> layout = {{6, 5, 9}, pixel, {false, true}};
  expect_same_bits_however_dealt(layout, random_cloud<3>(layout.pixels, 700, random));
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
