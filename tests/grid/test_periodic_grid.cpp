// Periodic sides: sums on both sides of a seam belong to one node, and its images follow it.
#include <gtest/gtest.h>

#include "grid/partitions.hpp"
#include "grid/rows.hpp"
#include "poreshock/core/parallel.hpp"

namespace poreshock {
namespace {

using test::add_rows;
using test::all_partitions;
using test::grid_shape;
using test::has_particles;

const MPI_Comm world = MPI_COMM_WORLD;

/// Row buffers of small whole numbers: their sums are exact in any order.
std::vector<Lanes> whole_numbers(const GridShape& shape, int row, int round) {
  reference::Random random{static_cast<std::uint64_t>(row + 77 * round)};
  std::vector<Lanes> buffer(static_cast<std::size_t>(shape.stencil) * shape.row_size);
  for (Lanes& node : buffer) {
    for (int lane = 0; lane < lane_count; ++lane) node[lane] = random.below(2001) - 1000;
  }
  return buffer;
}

/// The node 1 ... cells that a node index of one axis stands for: padding wraps round.
int original(int index, int nodes, bool periodic) {
  const int cells = nodes - 3;
  return periodic ? (index - 1 + cells) % cells + 1 : index;
}

int original_node(const GridShape& shape, int i) {
  const int nx = shape.nodes[0];
  if (shape.dimension == 2) return original(i, nx, shape.periodic[0]);
  return original(i / nx, shape.nodes[1], shape.periodic[1]) * nx +
         original(i % nx, nx, shape.periodic[0]);
}

/// Sums of all rows, every buffer entry added where its original is.
std::vector<Lanes> folded_sums(const GridShape& shape) {
  std::vector<Lanes> sums(static_cast<std::size_t>(shape.rows) * shape.row_size, Lanes{});
  for (int row = 0; row + shape.stencil <= shape.rows; ++row) {
    if (!has_particles(row, 0)) continue;
    const std::vector<Lanes> buffer = whole_numbers(shape, row, 0);
    for (int k = 0; k < shape.stencil; ++k) {
      for (int i = 0; i < shape.row_size; ++i) {
        sums[(row + k) * shape.row_size + original_node(shape, i)] +=
            buffer[k * shape.row_size + i];
      }
    }
  }
  return sums;
}

bool equal(const Lanes& a, const Lanes& b) {
  for (int lane = 0; lane < lane_count; ++lane) {
    if (a[lane] != b[lane]) return false;
  }
  return true;
}

void expect_folding_and_images(const GridShape& shape) {
  const auto partitions = all_partitions(shape.rows, size(world), slab_limits(shape));
  SlabGrid grid(shape, partitions[partitions.size() / 2], world);
  add_rows(0, whole_numbers, grid);
  const std::vector<Lanes> expected = folded_sums(shape);
  int wrong_sums = 0, wrong_images = 0;
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    for (int i = 0; i < shape.row_size; ++i) {
      wrong_sums += !equal(grid.row(row)[i], expected[row * shape.row_size + i]);
    }
  }
  grid.fill_periodic_images();
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    for (int i = 0; i < shape.row_size; ++i) {
      wrong_images +=
          !equal(grid.row(row)[i], expected[row * shape.row_size + original_node(shape, i)]);
    }
  }
  EXPECT_EQ(wrong_sums, 0);
  EXPECT_EQ(wrong_images, 0);
}

TEST(PeriodicGrid, SumsFoldOntoOneNodeAndImagesFollowInThePlane) {
  for (const int stencil : {3, 4}) {
    expect_folding_and_images(grid_shape(stencil, {8, 18}, {true, false}));
    expect_folding_and_images(grid_shape(stencil, {8, 18}, {false, false}));
    // Two cells: nodes 0 and 4 are both images of node 2.
    expect_folding_and_images(grid_shape(stencil, {5, 18}, {true, false}));
  }
}

TEST(PeriodicGrid, SumsFoldOntoOneNodeAndImagesFollowInSpace) {
  for (const int stencil : {3, 4}) {
    expect_folding_and_images(grid_shape(stencil, {7, 9, 17}, {true, true}));
    expect_folding_and_images(grid_shape(stencil, {7, 9, 17}, {true, false}));
    expect_folding_and_images(grid_shape(stencil, {7, 9, 17}, {false, true}));
  }
}

}  // namespace
}  // namespace poreshock
