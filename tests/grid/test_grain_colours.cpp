// Neighbours and colours of grains: complete, the same on every rank, and never too few.
#include <gtest/gtest.h>

#include <set>

#include "grid/partitions.hpp"
#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/grid/grain_colours.hpp"
#include "support/random_numbers.hpp"

namespace poreshock {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;

GridShape shape_of(int dimension, bool periodic) {
  Scene scene;
  scene.dimension = dimension;
  scene.domain.cell = 1e-5;
  scene.domain.cells =
      dimension == 2 ? std::array<int, 3>{17, 30, 0} : std::array<int, 3>{9, 8, 24};
  scene.domain.periodic = {periodic, periodic};
  scene.transfer.shape = ShapeFunction::cubic;
  return make_grid_shape(scene);
}

/// Some cells of 12 grains strewn over all rows.
std::vector<GrainCell> strewn_cells(const GridShape& shape) {
  reference::Random random{42};
  std::vector<GrainCell> cells;
  for (int k = 0; k < 60; ++k) {
    const auto below = [&](int n) { return static_cast<int>(random.uniform() * n); };
    int lateral = below(shape.nodes[0] - 3);
    if (shape.dimension == 3) lateral += shape.nodes[0] * below(shape.nodes[1] - 3);
    cells.push_back({below(shape.rows - 3), lateral, below(12)});
  }
  std::sort(cells.begin(), cells.end());
  return cells;
}

/// Distance along an axis of `nodes` nodes.
int distance(int a, int b, int nodes, bool periodic) {
  const int d = std::abs(a - b);
  return periodic ? std::min(d, nodes - 3 - d) : d;
}

std::vector<GrainPair> all_pairs(const std::vector<GrainCell>& cells, int reach,
                                 const GridShape& shape) {
  std::set<GrainPair> pairs;
  const int nx = shape.nodes[0];
  for (const GrainCell& a : cells) {
    for (const GrainCell& b : cells) {
      const bool near =
          std::abs(a.row - b.row) <= reach &&
          distance(a.lateral % nx, b.lateral % nx, nx, shape.periodic[0]) <= reach &&
          distance(a.lateral / nx, b.lateral / nx, shape.nodes[1], shape.periodic[1]) <= reach;
      if (near && a.grain < b.grain) pairs.insert({a.grain, b.grain});
    }
  }
  return {pairs.begin(), pairs.end()};
}

// Every way of cutting the rows finds the pairs that a look at all cells finds.
TEST(NearGrains, AreFoundAcrossSlabsAndPeriodicSides) {
  for (const int dimension : {2, 3}) {
    for (const bool periodic : {false, true}) {
      const GridShape shape = shape_of(dimension, periodic);
      const std::vector<GrainCell> cells = strewn_cells(shape);
      for (const int reach : {1, 3, 5}) {
        const std::vector<double> weights(static_cast<std::size_t>(shape.rows), 1.0);
        const SlabGrid grid(shape, partition_rows(weights, size(world), slab_limits(shape)), world);
        std::vector<GrainCell> mine;
        for (const GrainCell& c : cells) {
          if (c.row >= grid.first_row() && c.row < grid.last_row()) mine.push_back(c);
        }
        const std::vector<GrainPair> found = near_grains(cell_runs(mine, reach, grid), reach, grid);
        EXPECT_EQ(found, all_pairs(cells, reach, shape)) << dimension << periodic << reach;
        EXPECT_GT(found.size(), 3U);
      }
    }
  }
}

void expect_proper(const std::vector<std::int8_t>& colours, const std::vector<GrainPair>& pairs,
                   int most) {
  for (const auto& [a, b] : pairs) EXPECT_NE(colours[a], colours[b]) << a << " and " << b;
  for (const std::int8_t c : colours) EXPECT_LT(c, most);
}

// A triangular lattice, three neighbours each way: planar, so six colours are enough for sure.
TEST(GrainColours, NeighboursDiffer) {
  constexpr int side = 20;
  std::vector<GrainPair> pairs;
  for (int y = 0; y < side; ++y) {
    for (int x = 0; x < side; ++x) {
      const int g = y * side + x;
      if (x + 1 < side) pairs.push_back({g, g + 1});
      if (y + 1 < side) pairs.push_back({g, g + side});
      if (x + 1 < side && y + 1 < side) pairs.push_back({g, g + side + 1});
    }
  }
  const std::vector<std::int8_t> colours = colour_grains(side * side + 3, pairs);
  expect_proper(colours, pairs, 4);
  EXPECT_EQ(colours.back(), 0);  // a grain by itself
}

std::vector<GrainPair> everybody(int count) {
  std::vector<GrainPair> pairs;
  for (int a = 0; a < count; ++a) {
    for (int b = a + 1; b < count; ++b) pairs.push_back({a, b});
  }
  return pairs;
}

TEST(GrainColours, TwelveMeetAndOneMoreIsRefused) {
  ASSERT_EQ(most_colours, 12);
  expect_proper(colour_grains(12, everybody(12)), everybody(12), 12);
  try {
    colour_grains(13, everybody(13));
    FAIL() << "thirteen grains cannot share a place";
  } catch (const StateError& error) {
    const std::string text = error.what();
    EXPECT_NE(text.find("near 12 others"), std::string::npos) << text;
    EXPECT_NE(text.find("all 12 velocity fields are taken"), std::string::npos) << text;
  }
}

}  // namespace
}  // namespace poreshock
