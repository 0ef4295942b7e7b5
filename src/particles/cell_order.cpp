#include "poreshock/particles/cell_order.hpp"

namespace poreshock {

void sort_by_cell(const std::vector<std::uint32_t>& cell, std::size_t cells,
                  const std::vector<std::int32_t>& part, const std::vector<std::int64_t>& id,
                  CellOrder& result) {
  result.start.assign(cells + 1, 0);
  const std::uint32_t first = resting_particles(result);
  result.order.resize(cell.size() - first);
  for (std::size_t p = first; p < cell.size(); ++p) ++result.start[cell[p] + 1];
  for (std::size_t c = 0; c < cells; ++c) result.start[c + 1] += result.start[c];
  // Placing shifts every start to the next cell's; one shift back restores them.
  for (std::uint32_t p = first; p < cell.size(); ++p) result.order[result.start[cell[p]]++] = p;
  for (std::size_t c = cells; c > 0; --c) result.start[c] = result.start[c - 1];
  result.start[0] = 0;

  const auto before = [&](std::uint32_t a, std::uint32_t b) {
    return part[a] != part[b] ? part[a] < part[b] : id[a] < id[b];
  };
  std::uint32_t* order = result.order.data();
  for (std::size_t c = 0; c < cells; ++c) {
    for (std::uint32_t k = result.start[c] + 1; k < result.start[c + 1]; ++k) {
      const std::uint32_t moving = order[k];
      std::uint32_t place = k;
      while (place > result.start[c] && before(moving, order[place - 1])) {
        order[place] = order[place - 1];
        --place;
      }
      order[place] = moving;
    }
  }
}

}  // namespace poreshock
