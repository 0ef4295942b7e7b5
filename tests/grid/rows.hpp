#pragma once
// Row buffers as particles would leave them, and the sums they make on grids of any partition.

#include <cmath>
#include <cstring>
#include <vector>

#include "poreshock/grid/slab_grid.hpp"
#include "support/random_numbers.hpp"

namespace poreshock::test {

/// Shape of a grid of `nodes` per axis; the last of `dimension` axes is the shock axis.
inline GridShape grid_shape(int stencil, std::vector<int> nodes, std::array<bool, 2> periodic) {
  GridShape shape;
  shape.dimension = static_cast<int>(nodes.size());
  shape.stencil = stencil;
  shape.cell = 1e-5;
  shape.periodic = periodic;
  shape.row_size = 1;
  for (std::size_t axis = 0; axis < nodes.size(); ++axis) {
    shape.nodes[axis] = nodes[axis];
    if (axis + 1 < nodes.size()) shape.row_size *= nodes[axis];
  }
  shape.rows = nodes.back();
  return shape;
}

/// True when some particle lives in the row. Every seventh row is empty, so that most nodes still
/// sum over all rows of a stencil and see their order. Round 0, 1, ...
inline bool has_particles(int row, int round) {
  return (row + 3 * round) % 7 != 5;
}

/// Sums of row `row` for its `stencil` node rows: both signs and 16 orders of magnitude, so that
/// every other order of addition gives other bits.
inline std::vector<Lanes> row_buffer(const GridShape& shape, int row, int round) {
  reference::Random random{static_cast<std::uint64_t>(row + 1000 * round)};
  std::vector<Lanes> buffer(static_cast<std::size_t>(shape.stencil) * shape.row_size);
  for (Lanes& node : buffer) {
    for (int lane = 0; lane < lane_count; ++lane) {
      node[lane] = std::ldexp(random.uniform() - 0.5, random.below(52));
    }
  }
  return buffer;
}

/// Clears the grid, adds the buffers of the rows this rank owns and completes the sums. Collective.
template <class Buffer>
void add_rows(int round, Buffer&& buffer, SlabGrid& grid) {
  grid.clear();
  for (int row = grid.first_row(); row < grid.last_row(); ++row) {
    if (row > grid.shape().rows - grid.shape().stencil || !has_particles(row, round)) continue;
    grid.add_row(row, buffer(grid.shape(), row, round).data());
  }
  grid.exchange();
}

/// Complete rows of `grid` that differ from the whole grid `serial` in any bit.
inline std::vector<int> different_rows(const SlabGrid& grid, const SlabGrid& serial) {
  std::vector<int> rows;
  const std::size_t bytes = sizeof(Lanes) * static_cast<std::size_t>(grid.shape().row_size);
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    if (std::memcmp(grid.row(row), serial.row(row), bytes) != 0) rows.push_back(row);
  }
  return rows;
}

}  // namespace poreshock::test
