// Several velocity fields that have nodes only where their particles are: the sums are those of
// fields with all nodes, bit for bit, for every way of sharing out the rows.
#include <gtest/gtest.h>

#include "grid/partitions.hpp"
#include "grid/rows.hpp"
#include "poreshock/core/parallel.hpp"

namespace poreshock {
namespace {

using test::all_partitions;
using test::grid_shape;
using test::row_buffer;

const MPI_Comm world = MPI_COMM_WORLD;
constexpr int field_count = 3;

/// A stencil cell with particles of a field.
struct Cell {
  int field, row, lateral;
};

std::vector<Cell> strewn_cells(const GridShape& shape) {
  reference::Random random{7};
  std::vector<Cell> cells;
  for (int k = 0; k < 24; ++k) {
    const auto below = [&](int nodes) { return random.below(nodes - shape.stencil + 1); };
    int lateral = below(shape.nodes[0]);
    if (shape.dimension == 3) lateral += shape.nodes[0] * below(shape.nodes[1]);
    cells.push_back({random.below(field_count), below(shape.rows), lateral});
  }
  return cells;
}

/// Calls visit(row of the stencil, first node) for every line of nodes of a cell.
template <class Visit>
void for_each_line(const GridShape& shape, const Cell& cell, Visit&& visit) {
  for (int k = 0; k < shape.stencil; ++k) {
    for (int j = 0; j < (shape.dimension == 3 ? shape.stencil : 1); ++j) {
      visit(k, cell.lateral + j * shape.nodes[0]);
    }
  }
}

/// Gives each field the nodes of its cells in the rows that are complete here.
void take_nodes(const std::vector<Cell>& cells, SlabGrid& grid) {
  const GridShape& shape = grid.shape();
  grid.take_fields(field_count, [&](NodeLayout& layout) {
    for (const Cell& cell : cells) {
      for_each_line(shape, cell, [&](int k, int first) {
        const int row = cell.row + k;
        if (row < grid.first_row() || row >= grid.node_end()) return;
        mark_nodes(cell.field, row, first, first + shape.stencil, layout);
      });
    }
  });
}

/// Sums of the cells of every row, random at their nodes and zero beside them. Collective.
void add_cells(const std::vector<Cell>& cells, SlabGrid& grid) {
  const GridShape& shape = grid.shape();
  grid.clear();
  for (int row = grid.first_row(); row < grid.last_row(); ++row) {
    for (int field = 0; field < field_count; ++field) {
      const std::vector<Lanes> all = row_buffer(shape, std::min(row, shape.rows), field);
      std::vector<Lanes> buffer(all.size(), Lanes{});
      for (const Cell& cell : cells) {
        if (cell.row != row || cell.field != field) continue;
        for_each_line(shape, cell, [&](int k, int first) {
          const std::ptrdiff_t at = std::ptrdiff_t{k} * shape.row_size + first;
          std::copy_n(all.begin() + at, shape.stencil, buffer.begin() + at);
        });
      }
      if (row + shape.stencil <= shape.rows) grid.add_row(row, buffer.data(), field);
    }
  }
  grid.exchange();
}

/// Nodes of `grid` that differ from those of `whole`.
int wrong_nodes(SlabGrid& grid, SlabGrid& whole) {
  int wrong = 0;
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    for (int field = 0; field < field_count; ++field) {
      for (int i = 0; i < grid.shape().row_size; ++i) {
        const Lanes* const found = grid.find(field, row, i);
        wrong += found != nullptr && std::memcmp(found, whole.find(field, row, i), sizeof(Lanes));
      }
    }
  }
  return wrong;
}

/// Nodes that `whole` holds sums of and `grid` does not have.
int missing_nodes(SlabGrid& grid, SlabGrid& whole) {
  int missing = 0;
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    for (int field = 0; field < field_count; ++field) {
      for (int i = 0; i < grid.shape().row_size; ++i) {
        missing += grid.find(field, row, i) == nullptr && (*whole.find(field, row, i))[0] != 0.0;
      }
    }
  }
  return missing;
}

void expect_bits_of_whole_fields(const GridShape& shape) {
  const std::vector<Cell> cells = strewn_cells(shape);
  SlabGrid whole(shape, {0, shape.rows}, MPI_COMM_SELF),
      filled(shape, {0, shape.rows}, MPI_COMM_SELF);
  for (SlabGrid* grid : {&whole, &filled}) {
    grid->take_fields(field_count);
    add_cells(cells, *grid);
  }
  filled.fill_periodic_images();
  const auto partitions = all_partitions(shape.rows, size(world), slab_limits(shape));
  for (const std::vector<int>& starts : {partitions.front(), partitions.back()}) {
    SlabGrid grid(shape, starts, world);
    take_nodes(cells, grid);
    EXPECT_LT(grid.layout().size, std::size_t(field_count) * grid.layout().rows * shape.row_size);
    add_cells(cells, grid);
    EXPECT_EQ(wrong_nodes(grid, whole), 0);
    EXPECT_EQ(missing_nodes(grid, whole), 0);
    grid.fill_periodic_images();
    EXPECT_EQ(wrong_nodes(grid, filled), 0);
    const auto twin = grid.sibling();
    add_cells(cells, *twin);
    EXPECT_EQ(wrong_nodes(*twin, whole), 0);
  }
}

TEST(NodeLayout, FieldsOfSomeNodesHaveTheBitsOfWholeFields) {
  for (const int stencil : {3, 4}) {
    for (const bool periodic : {false, true}) {
      expect_bits_of_whole_fields(grid_shape(stencil, {21, 17}, {periodic, false}));
      expect_bits_of_whole_fields(grid_shape(stencil, {11, 9, 16}, {periodic, periodic}));
    }
  }
}

// Tiles of four nodes, stored side by side where they are neighbours; the last one ends with the
// row.
TEST(NodeLayout, HoldsTilesInTheOrderOfRowsAndFields) {
  NodeLayout layout;
  layout.first_row = 3, layout.rows = 2, layout.row_size = 18;
  begin_layout(2, layout);
  mark_nodes(1, 3, 5, 9, layout);
  mark_nodes(0, 4, 17, 18, layout);
  mark_nodes(0, 4, 1, 2, layout);
  finish_layout(layout);
  EXPECT_EQ(layout.size, 14U);
  EXPECT_TRUE(runs_of(layout, 0, 3).empty());
  ASSERT_EQ(runs_of(layout, 1, 3).size(), 1U);
  EXPECT_EQ(runs_of(layout, 1, 3)[0].first, 4);
  EXPECT_EQ(runs_of(layout, 1, 3)[0].last, 12);
  ASSERT_EQ(runs_of(layout, 0, 4).size(), 2U);
  EXPECT_EQ(runs_of(layout, 0, 4)[1].first, 16);
  EXPECT_EQ(runs_of(layout, 0, 4)[1].last, 18);
  EXPECT_EQ(first_place(layout, 3), 0U);
  EXPECT_EQ(first_place(layout, 4), 8U);
  EXPECT_EQ(first_place(layout, 5), 14U);
  EXPECT_EQ(shift_at(layout, 1, 3, 11) + 11, 7);
  EXPECT_EQ(shift_at(layout, 0, 4, 16) + 16, 12);
  EXPECT_EQ(shift_at(layout, 0, 4, 4), no_tile);
}

TEST(NodeLayout, HoldsOneFieldInSomeRows) {
  NodeLayout layout;
  layout.first_row = 3, layout.rows = 5, layout.row_size = 18;
  take_node_rows(4, 6, layout);
  EXPECT_EQ(layout.size, 36U);
  EXPECT_TRUE(runs_of(layout, 0, 3).empty());
  ASSERT_EQ(runs_of(layout, 0, 5).size(), 1U);
  EXPECT_EQ(runs_of(layout, 0, 5)[0].first, 0);
  EXPECT_EQ(runs_of(layout, 0, 5)[0].last, 18);
  EXPECT_TRUE(runs_of(layout, 0, 6).empty());
  EXPECT_EQ(first_place(layout, 4), 0U);
  EXPECT_EQ(first_place(layout, 5), 18U);
  EXPECT_EQ(first_place(layout, 8), 36U);
  EXPECT_EQ(shift_at(layout, 0, 6, 0), no_tile);
  take_node_rows(8, 8, layout);
  EXPECT_EQ(layout.size, 0U);
}

}  // namespace
}  // namespace poreshock
