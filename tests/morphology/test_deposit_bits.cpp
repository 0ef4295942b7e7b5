// The same bits on any number of ranks, however particles and rows are dealt out to them.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include "cloud.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/morphology/analysis.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::reference;

const MPI_Comm world = MPI_COMM_WORLD;

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

// A map that begins higher has the pixels of the whole one, though places in metres are no whole
// pixels there.
TEST(DepositBits, HigherMapHasThePixelsOfTheWholeOne) {
  Random random{7};
  const std::array<int, 2> pixels = {9, 40};
  Cloud<2> cloud = random_cloud<2>(pixels, 900, random);
  const double size = 0.1 * pixel;
  for (auto& axis : cloud.position) {
    for (double& x : axis) x *= 0.1;
  }
  for (double& m : cloud.mass) m *= 0.01;
  const PixelScales scales = {exact_scales.density, 0.1 * exact_scales.max_side};
  const PixelGrid<2> all(MPI_COMM_SELF, {pixels, size, {false}});
  const PixelField<2> whole = deposit_cloud(cloud, scales, all);
  const int low = 13, rows = 22;
  const PixelGrid<2> some(MPI_COMM_SELF, {{9, rows}, size, {false}});
  const PixelField<2> part =
      deposit_cloud(cloud, {scales.density, scales.max_side, static_cast<double>(low)}, some);
  const std::size_t start = static_cast<std::size_t>(low) * 9, count = rows * 9;
  expect_same_bits<std::int64_t>(part.coverage, whole.coverage, start, "coverage");
  const auto owned = [&](const auto& field) {
    return std::vector(field.begin(), field.begin() + static_cast<std::ptrdiff_t>(count));
  };
  for (std::size_t k = 0; k < 2; ++k) {
    expect_same_bits(owned(part.values[k]), whole.values[k], start, "values");
  }
  EXPECT_GT(std::count(part.solid.begin(), part.solid.end(), 1), 50);
}

}  // namespace
