#pragma once
// The canonical order of particles: by (cell, part, id). Parts are grains, or what else has
// velocity fields of its own. Kernels walk particles in this order, so
// their sums do not depend on where or how particles are stored.

#include <cstdint>
#include <limits>
#include <vector>

namespace poreshock {

/// Rows of stencil cells: first ... last - 1.
struct RowRange {
  int first = 0, last = 0;
};

/// Particles cell after cell: those of cell c are order[start[c]] ... order[start[c + 1] - 1].
/// Particles that rest are stored first and are in no cell.
struct CellOrder {
  std::vector<std::uint32_t> start;  ///< cells + 1 entries
  std::vector<std::uint32_t> order;  ///< indices into the particle columns
  std::vector<std::uint32_t> cell;   ///< of each particle as stored, when they were sorted
  /// Part that a particle as stored belongs to; empty where grains are the parts.
  std::vector<std::int32_t> part;
  std::vector<std::int8_t> field;  ///< velocity field of each part; empty where there is only one
  /// Rows that a step works on, of the whole grid; the particles of all others only move.
  RowRange awake = {0, std::numeric_limits<int>::max()};
  bool may_rest = false;  ///< where nothing needs the cells of particles asleep
  /// Where each row of particles that rest ends, as stored, from the highest row down.
  std::vector<std::uint32_t> resting;
};

/// Number of particles that rest.
inline std::uint32_t resting_particles(const CellOrder& cells) {
  return cells.resting.empty() ? 0 : cells.resting.back();
}

/// Sorts the particles that do not rest by (cell, part, id). Counting sort, then insertion within a
/// cell; cheap when the storage is nearly sorted. Not collective.
void sort_by_cell(const std::vector<std::uint32_t>& cell, std::size_t cells,
                  const std::vector<std::int32_t>& part, const std::vector<std::int64_t>& id,
                  CellOrder& result);

}  // namespace poreshock
