#pragma once
// Regions of a lattice or an image that hang together through shared faces (4 neighbours in 2-D, 6
// in 3-D, periodic sides included), kept as runs along x that the ranks share by layers: memory
// grows with the number of runs of a rank's layers, and with the number of regions.

#include <array>
#include <cstdint>
#include <vector>

#include "poreshock/sample/fill.hpp"

namespace poreshock {

/// Cells [begin, end) of one row, all filled and of one label.
struct Run {
  std::int32_t begin = 0;
  std::int32_t end = 0;
  std::int32_t region = 0;  ///< set by find_regions
  double label = 0.0;
};

/// Runs of consecutive rows.
struct Runs {
  std::vector<Run> runs;
  std::vector<std::size_t> row_start{0};  ///< runs of row r: row_start[r] ... row_start[r + 1] - 1

  std::int64_t rows() const { return static_cast<std::int64_t>(row_start.size()) - 1; }
};

/// Rows in their order: x along a row, then y (3-D), then the layers along the shock axis.
struct RowOrder {
  std::int64_t row_length = 0;
  std::int64_t rows_per_layer = 1;  ///< 1 in 2-D
  std::array<bool, 2> periodic{};
};

/// Rows of an image or a lattice of that many cells along x, y(, z).
RowOrder row_order(const std::array<std::int64_t, 3>& size, int dimension,
                   const std::array<bool, 2>& periodic);

/// Cells that hang together.
struct ConnectedRegion {
  std::int64_t cells = 0;
  std::int64_t first = 0;  ///< number of the first cell, in the order of rows
};

/// Appends the runs of whole rows of `row_length` values: those that are `filled`, parted where the
/// value changes.
template <class Value, class Filled>
void append_runs(const std::vector<Value>& values, std::int64_t row_length, Filled&& filled,
                 Runs& runs) {
  const auto length = static_cast<std::int32_t>(row_length);
  for (std::size_t row = 0; row < values.size(); row += static_cast<std::size_t>(length)) {
    for (std::int32_t i = 0; i < length;) {
      const Value value = values[row + static_cast<std::size_t>(i)];
      const std::int32_t begin = i++;
      if (!filled(value)) continue;
      while (i < length && values[row + static_cast<std::size_t>(i)] == value) ++i;
      runs.runs.push_back({.begin = begin, .end = i, .label = static_cast<double>(value)});
    }
    runs.row_start.push_back(runs.runs.size());
  }
}

/// Numbers the connected regions of equal label by their first cell, from 0 on the same way on any
/// number of ranks, and returns them all. `runs` are this rank's layers from `first_layer` on; the
/// ranks have consecutive layers, or none. Throws InputError when there are more than 2^30
/// regions. Collective.
std::vector<ConnectedRegion> find_regions(const RowOrder& order, std::int64_t first_layer,
                                          MPI_Comm communicator, Runs& runs);

/// The runs of the layers `wanted`, from ranks that have those of the layers `own`, which are
/// consecutive over the ranks. Collective.
Runs fetch_layers(const RowOrder& order, const Runs& runs, LatticeRange own, LatticeRange wanted,
                  MPI_Comm communicator);

}  // namespace poreshock
