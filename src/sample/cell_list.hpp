#pragma once
// Cells over the block that find the points near a point in constant time.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "block.hpp"

namespace poreshock {

/// Points sorted into cells no smaller than a cutoff; a chain of item numbers per cell.
struct CellList {
  Block block;
  std::array<int, 3> cells{1, 1, 1};
  std::vector<int> head;  ///< last item put into each cell, -1 = none
  std::vector<int> next;  ///< item put into the same cell before, -1 = none
};

/// An empty list whose any_near finds every item closer than `cutoff` (m), for about `items` items.
inline CellList make_cell_list(const Block& block, double cutoff, std::size_t items) {
  CellList list;
  list.block = block;
  // More cells than items find nothing faster.
  const double most =
      4.0 * std::ceil(std::pow(static_cast<double>(items) + 1.0, 1.0 / block.dimension)) + 16.0;
  std::size_t total = 1;
  for (int axis = 0; axis < block.dimension; ++axis) {
    // The margin keeps rounding in cell_of from parting a pair at the cutoff by two cells.
    const double fit = std::floor(block.size[axis] / (cutoff * (1.0 + 1e-12)));
    list.cells[axis] = static_cast<int>(std::clamp(fit, 1.0, most));
    total *= static_cast<std::size_t>(list.cells[axis]);
  }
  list.head.assign(total, -1);
  list.next.reserve(items);
  return list;
}

/// Cell coordinate along one axis; points outside a side that is not periodic count to its cell.
inline int cell_of(const CellList& list, const Triple& point, int axis) {
  const int cells = list.cells[axis];
  const double s = std::floor(point[axis] / list.block.size[axis] * static_cast<double>(cells));
  return static_cast<int>(std::clamp(s, 0.0, static_cast<double>(cells - 1)));
}

/// Puts item number `item` at `point`; items come in ascending order without gaps.
inline void insert(const Triple& point, int item, CellList& list) {
  std::size_t cell = 0;
  for (int axis = list.block.dimension - 1; axis >= 0; --axis) {
    cell = cell * static_cast<std::size_t>(list.cells[axis]) +
           static_cast<std::size_t>(cell_of(list, point, axis));
  }
  list.next.resize(static_cast<std::size_t>(item) + 1, -1);
  list.next[static_cast<std::size_t>(item)] = list.head[cell];
  list.head[cell] = item;
}

/// Cells to search along one axis around cell `centre`, each once.
struct NearCells {
  std::array<int, 3> cell{};
  int count = 0;
};

inline NearCells near_cells(const CellList& list, int centre, int axis) {
  NearCells result;
  const int cells = list.cells[axis];
  for (int offset = -1; offset <= 1; ++offset) {
    int cell = centre + offset;
    if (list.block.periodic[axis]) {
      cell = (cell + cells) % cells;
      // With one or two cells around the period both offsets reach the same cell.
      const bool seen = (result.count > 0 && result.cell[0] == cell) ||
                        (result.count > 1 && result.cell[1] == cell);
      if (seen) continue;
    } else if (cell < 0 || cell >= cells) {
      continue;
    }
    result.cell[static_cast<std::size_t>(result.count++)] = cell;
  }
  return result;
}

/// True as soon as test(item) is true for an item in the cells around `point`; each item once.
template <class Test>
bool any_near(const CellList& list, const Triple& point, Test&& test) {
  std::array<NearCells, 3> near;
  near[2].count = 1;
  for (int axis = 0; axis < list.block.dimension; ++axis) {
    near[axis] = near_cells(list, cell_of(list, point, axis), axis);
  }
  for (int k = 0; k < near[2].count; ++k) {
    for (int j = 0; j < near[1].count; ++j) {
      for (int i = 0; i < near[0].count; ++i) {
        const std::size_t row =
            static_cast<std::size_t>(near[2].cell[k]) * static_cast<std::size_t>(list.cells[1]) +
            static_cast<std::size_t>(near[1].cell[j]);
        const std::size_t cell = row * static_cast<std::size_t>(list.cells[0]) +
                                 static_cast<std::size_t>(near[0].cell[i]);
        for (int item = list.head[cell]; item >= 0;
             item = list.next[static_cast<std::size_t>(item)]) {
          if (test(item)) return true;
        }
      }
    }
  }
  return false;
}

}  // namespace poreshock
