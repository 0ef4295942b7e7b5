// Nodal sums have the same bits on every rank, for every way of sharing out the rows.
#include <gtest/gtest.h>

#include "grid/partitions.hpp"
#include "grid/rows.hpp"
#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"

namespace poreshock {
namespace {

using test::add_rows;
using test::all_partitions;
using test::different_rows;
using test::grid_shape;
using test::has_particles;
using test::row_buffer;

const MPI_Comm world = MPI_COMM_WORLD;

TEST(GridShape, FollowsFromTheScene) {
  Scene scene;
  scene.dimension = 3;
  scene.domain.cell = 2e-6;
  scene.domain.cells = {7, 5, 40};
  scene.domain.periodic = {true, false};
  scene.transfer.shape = ShapeFunction::quadratic;
  const GridShape shape = make_grid_shape(scene);
  EXPECT_EQ(shape.nodes, (std::array<int, 3>{10, 8, 43}));
  EXPECT_EQ(shape.row_size, 80);
  EXPECT_EQ(shape.rows, 43);
  EXPECT_EQ(shape.stencil, 3);
  EXPECT_EQ(shape.cell, 2e-6);
  EXPECT_EQ(shape.periodic, (std::array<bool, 2>{true, false}));
  scene.dimension = 2;
  scene.transfer.shape = ShapeFunction::cubic;
  const GridShape plane = make_grid_shape(scene);
  EXPECT_EQ(plane.row_size, 10);
  EXPECT_EQ(plane.rows, 8);
  EXPECT_EQ(plane.nodes[2], 1);
  EXPECT_EQ(plane.stencil, 4);
}

TEST(GridShape, IsRefusedWhereItsNodesCannotBeCounted) {
  Scene scene;
  scene.dimension = 3;
  scene.domain.cell = 1.0;
  scene.domain.cells = {1021, 1021, 2043};
  EXPECT_EQ(make_grid_shape(scene).row_size, 1024 * 1024);
  scene.domain.cells[2] = 2045;
  EXPECT_THROW(make_grid_shape(scene), InputError);
}

// Cubic: six planes to each neighbour, eight numbers a node.
TEST(GridShape, IsRefusedWhereItsSeamsCannotBeCounted) {
  GridShape shape;
  shape.row_size = 398 * 398;
  EXPECT_NO_THROW(require_countable_seam(shape, 141));
  if (sizeof(PetscInt) == 4) {
    EXPECT_THROW(require_countable_seam(shape, 142), InputError);
  } else {
    EXPECT_NO_THROW(require_countable_seam(shape, 1000));
  }
  shape.row_size = 1 << 30;
  EXPECT_NO_THROW(require_countable_seam(shape, 1));
}

// Rows keep their numbers where a grid moves up, and so do sums.
TEST(SlabGrid, MovedUpHasTheSumsOfTheSameRows) {
  const GridShape low = grid_shape(4, {7, 30}, {});
  GridShape part = moved_up(grid_shape(4, {7, 16}, {}), 11);
  EXPECT_EQ(part.first, 11);
  EXPECT_EQ(part.rows, 27);
  EXPECT_EQ(part.nodes, (std::array<int, 3>{7, 27, 1}));
  SlabGrid serial(low, {0, low.rows}, MPI_COMM_SELF);
  add_rows(0, row_buffer, serial);
  for (const auto& starts : all_partitions(16, size(world), slab_limits(part))) {
    std::vector<int> moved = starts;
    for (int& row : moved) row += 11;
    SlabGrid grid(part, moved, world);
    add_rows(0, row_buffer, grid);
    for (const int row : different_rows(grid, serial)) {
      // Only the ends lack what rows beyond them add.
      EXPECT_TRUE(row < 11 + 3 || row >= 27 - 3) << row;
    }
    EXPECT_EQ(grid.owner(11), 0);
    EXPECT_EQ(grid.owner(26), size(world) - 1);
  }
}

TEST(SlabLimits, KeepSeamAndMirrorNodesOnOneRank) {
  const SlabLimits quadratic = slab_limits(grid_shape(3, {9, 20}, {}));
  EXPECT_EQ(quadratic.first, 3);
  EXPECT_EQ(quadratic.inner, 2);
  EXPECT_EQ(quadratic.last, 5);
  const SlabLimits cubic = slab_limits(grid_shape(4, {9, 20}, {}));
  EXPECT_EQ(cubic.first, 3);
  EXPECT_EQ(cubic.inner, 3);
  EXPECT_EQ(cubic.last, 6);
}

TEST(SlabGrid, WholeGridAddsRowBuffersInRowOrder) {
  for (const int stencil : {3, 4}) {
    const GridShape shape = grid_shape(stencil, {7, 16}, {});
    SlabGrid grid(shape, {0, shape.rows}, MPI_COMM_SELF);
    add_rows(0, row_buffer, grid);
    std::vector<Lanes> expected(static_cast<std::size_t>(shape.rows) * shape.row_size, Lanes{});
    for (int row = 0; row + stencil <= shape.rows; ++row) {
      if (!has_particles(row, 0)) continue;
      const std::vector<Lanes> buffer = row_buffer(shape, row, 0);
      for (std::size_t n = 0; n < buffer.size(); ++n) {
        expected[static_cast<std::size_t>(row) * shape.row_size + n] += buffer[n];
      }
    }
    EXPECT_EQ(grid.node_end(), shape.rows);
    EXPECT_EQ(std::memcmp(grid.row(0), expected.data(), sizeof(Lanes) * expected.size()), 0);
  }
}

/// Compares every partition of the rows with the whole grid on one rank, twice per grid: the second
/// round finds whatever the first one left behind.
void expect_same_bits_for_every_partition(const GridShape& shape) {
  SlabGrid first(shape, {0, shape.rows}, MPI_COMM_SELF);
  SlabGrid second(shape, {0, shape.rows}, MPI_COMM_SELF);
  add_rows(0, row_buffer, first);
  add_rows(1, row_buffer, second);
  const auto partitions = all_partitions(shape.rows, size(world), slab_limits(shape));
  EXPECT_FALSE(partitions.empty());
  for (const std::vector<int>& starts : partitions) {
    const std::string where = "stencil " + std::to_string(shape.stencil) + ", rows from " +
                              std::to_string(starts[rank(world)]) + " to " +
                              std::to_string(starts[rank(world) + 1]);
    SlabGrid grid(shape, starts, world);
    add_rows(0, row_buffer, grid);
    EXPECT_EQ(different_rows(grid, first), std::vector<int>{}) << where;
    add_rows(1, row_buffer, grid);
    EXPECT_EQ(different_rows(grid, second), std::vector<int>{}) << where;
  }
}

/// Rows of the thinnest slabs of four ranks, and two more.
int row_count(int stencil) {
  const SlabLimits limits = slab_limits(grid_shape(stencil, {9, 20}, {}));
  return limits.first + 2 * limits.inner + limits.last + 2;
}

TEST(SlabGrid, SumsHaveTheSameBitsForEveryPartitionInThePlane) {
  for (const int stencil : {3, 4}) {
    expect_same_bits_for_every_partition(grid_shape(stencil, {8, row_count(stencil)}, {}));
    expect_same_bits_for_every_partition(
        grid_shape(stencil, {8, row_count(stencil)}, {true, false}));
  }
}

TEST(SlabGrid, SumsHaveTheSameBitsForEveryPartitionInSpace) {
  for (const int stencil : {3, 4}) {
    expect_same_bits_for_every_partition(grid_shape(stencil, {7, 8, row_count(stencil)}, {}));
    expect_same_bits_for_every_partition(
        grid_shape(stencil, {7, 8, row_count(stencil)}, {true, true}));
    expect_same_bits_for_every_partition(
        grid_shape(stencil, {7, 8, row_count(stencil)}, {false, true}));
  }
}

TEST(SlabGrid, CompleteRowsReachOverTheNeighboursStencils) {
  const GridShape shape = grid_shape(4, {6, row_count(4)}, {});
  const auto partitions = all_partitions(shape.rows, size(world), slab_limits(shape));
  const SlabGrid grid(shape, partitions.back(), world);
  const bool top = rank(world) + 1 == size(world);
  EXPECT_EQ(grid.node_end(), top ? shape.rows : grid.last_row() + 3);
  EXPECT_EQ(grid.starts(), partitions.back());
  EXPECT_EQ(grid.first_row(), partitions.back()[rank(world)]);
  EXPECT_EQ(grid.last_row(), partitions.back()[rank(world) + 1]);
}

TEST(SlabGrid, EveryRowHasItsOwner) {
  const GridShape shape = grid_shape(3, {6, row_count(3)}, {});
  for (const auto& starts : all_partitions(shape.rows, size(world), slab_limits(shape))) {
    const SlabGrid grid(shape, starts, world);
    for (int row = 0; row < shape.rows; ++row) {
      const int owner = grid.owner(row);
      EXPECT_GE(row, starts[owner]);
      EXPECT_LT(row, starts[owner + 1]);
      EXPECT_EQ(owner == rank(world), row >= grid.first_row() && row < grid.last_row());
    }
  }
}

TEST(SlabGrid, ClearLeavesPlusZeroEverywhere) {
  const GridShape shape = grid_shape(4, {6, row_count(4)}, {true, false});
  SlabGrid grid(shape, all_partitions(shape.rows, size(world), slab_limits(shape)).front(), world);
  add_rows(0, row_buffer, grid);
  grid.clear();
  grid.exchange();
  const std::vector<Lanes> zero(static_cast<std::size_t>(shape.row_size), Lanes{});
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    EXPECT_EQ(std::memcmp(grid.row(row), zero.data(), sizeof(Lanes) * zero.size()), 0) << row;
  }
}

}  // namespace
}  // namespace poreshock
