// Distribution of pixel rows over ranks, and what is refused.

#include <gtest/gtest.h>

#include <numeric>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/morphology/pixel_map.hpp"

namespace {

using namespace poreshock;

const MPI_Comm world = MPI_COMM_WORLD;

template <int Dim>
std::string message_of(const PixelLayout<Dim>& layout, std::span<const int> rows) {
  try {
    const PixelGrid<Dim> grid(world, layout, rows);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(PixelGrid, RowsAreSharedOutEvenly) {
  const int ranks = size(world);
  const PixelGrid<2> grid(world, {{7, 4 * ranks + 1}, 0.5, {true}});
  EXPECT_EQ(grid.row_starts().size(), static_cast<std::size_t>(ranks) + 1);
  EXPECT_EQ(grid.row_starts().front(), 0);
  EXPECT_EQ(grid.row_starts().back(), 4 * ranks + 1);
  EXPECT_EQ(grid.rows(), rank(world) == 0 ? 5 : 4);
  EXPECT_EQ(grid.row_size(), 7u);
}

TEST(PixelGrid, RowsCanBeGiven) {
  const int ranks = size(world);
  std::vector<int> rows(static_cast<std::size_t>(ranks));
  std::iota(rows.begin(), rows.end(), 1);
  const int total = std::accumulate(rows.begin(), rows.end(), 0);
  const PixelGrid<3> grid(world, {{2, 3, total}, 1.0, {false, true}}, rows);
  EXPECT_EQ(grid.rows(), rank(world) + 1);
  EXPECT_EQ(grid.first_row(), rank(world) * (rank(world) + 1) / 2);
  EXPECT_EQ(grid.row_size(), 6u);
}

TEST(PixelGrid, OneRowPerRankIsEnough) {
  const int ranks = size(world);
  const PixelGrid<2> grid(world, {{3, ranks}, 1.0, {false}});
  EXPECT_EQ(grid.rows(), 1);
}

TEST(PixelGrid, RefusesFewerRowsThanRanks) {
  const int ranks = size(world);
  if (ranks == 1) GTEST_SKIP() << "needs more than one rank";
  const std::string fewer = std::to_string(ranks - 1);
  EXPECT_EQ(message_of<2>({{5, ranks - 1}, 1.0, {false}}, {}),
            "the pixel map has " + fewer + " rows across the shock axis for " +
                std::to_string(ranks) +
                " ranks; every rank needs at least one row. Use smaller pixels or at most " +
                fewer + " ranks.");
}

TEST(PixelGrid, RefusesRowsThatDoNotAddUp) {
  const int ranks = size(world);
  const std::vector<int> rows(static_cast<std::size_t>(ranks), 2);
  const std::string number = std::to_string(ranks);
  EXPECT_EQ(message_of<2>({{5, 2 * ranks + 1}, 1.0, {false}}, rows),
            "the rows per rank are " + number + " numbers that add up to " +
                std::to_string(2 * ranks) + "; a pixel map of " + std::to_string(2 * ranks + 1) +
                " rows on " + number +
                " ranks needs one number of at least 1 row per rank, and all rows used.");
}

TEST(PixelGrid, RefusesEmptyAndEnormousMaps) {
  EXPECT_EQ(message_of<2>({{0, 8}, 1.0, {false}}, {}),
            "the pixel map has 0 pixels along one axis; it needs at least 1. Use smaller pixels.");
  EXPECT_EQ(message_of<2>({{8, 8}, 0.0, {false}}, {}),
            "the pixel size is 0.000000 m; it must be positive.");
  if (sizeof(PetscInt) == 4) {
    EXPECT_EQ(message_of<3>({{2048, 2048, 1024}, 1.0, {false, false}}, {}),
              "the pixel map has more pixels than PETSc can number, 2147483647. Use larger pixels, "
              "or a PETSc with 64-bit indices.");
  }
}

}  // namespace
