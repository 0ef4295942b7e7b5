#include "poreshock/grid/grain_colours.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <ranges>
#include <set>
#include <string>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"

namespace poreshock {

namespace {

template <class Item>
void keep_each_once(std::vector<Item>& items) {
  std::sort(items.begin(), items.end());
  items.resize(static_cast<std::size_t>(std::unique(items.begin(), items.end()) - items.begin()));
}

/// Cells of the rows within `reach` of a slab end that another rank lies beyond.
std::vector<GrainCell> cells_at_ends(std::span<const GrainCell> cells, int reach,
                                     const SlabGrid& grid) {
  std::vector<GrainCell> ends;
  for (const GrainCell& c : cells) {
    const bool low = grid.first_row() > 0 && c.row < grid.first_row() + reach;
    const bool high = grid.last_row() < grid.shape().rows && c.row >= grid.last_row() - reach;
    if (low || high) ends.push_back(c);
  }
  return ends;
}

/// Cells by row and lateral index, with their grains.
class CellMap {
 public:
  CellMap(std::vector<GrainCell> cells, const GridShape& shape)
      : cells_(std::move(cells)), shape_(shape) {
    keep_each_once(cells_);
    if (cells_.empty()) return;
    first_row_ = cells_.front().row;
    rows_ = cells_.back().row - first_row_ + 1;
    start_.assign(static_cast<std::size_t>(rows_) * shape.row_size + 1, 0);
    for (const GrainCell& c : cells_) ++start_[place(c.row, c.lateral) + 1];
    for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
  }

  const std::vector<GrainCell>& cells() const { return cells_; }

  std::span<const GrainCell> at(int row, int lateral) const {
    if (row < first_row_ || row >= first_row_ + rows_) return {};
    const std::size_t at = place(row, lateral);
    return std::span<const GrainCell>(cells_).subspan(start_[at], start_[at + 1] - start_[at]);
  }

 private:
  std::size_t place(int row, int lateral) const {
    return static_cast<std::size_t>(row - first_row_) * shape_.row_size + lateral;
  }

  std::vector<GrainCell> cells_;
  const GridShape& shape_;
  int first_row_ = 0, rows_ = 0;
  std::vector<std::size_t> start_;
};

using Neighbours = std::vector<std::vector<std::int32_t>>;

/// Notes two neighbours, once, with the smaller one; a grain has few.
void join(std::int32_t a, std::int32_t b, Neighbours& near) {
  std::vector<std::int32_t>& list = near[static_cast<std::size_t>(std::min(a, b))];
  const std::int32_t other = std::max(a, b);
  if (std::find(list.begin(), list.end(), other) == list.end()) list.push_back(other);
}

/// Lateral indices within reach of one along an axis, each once.
void near_indices(int index, int reach, int nodes, bool periodic, std::vector<int>& result) {
  result.clear();
  const int cells = nodes - 3;
  for (int d = -reach; d <= reach; ++d) {
    int i = index + d;
    // Stencil cells 0 and `cells` are one and the same across a periodic side.
    if (periodic) {
      i = ((i % cells) + cells) % cells;
      if (i == 0) result.push_back(cells);
    }
    if (i >= 0 && i < nodes) result.push_back(i);
  }
  keep_each_once(result);
}

}  // namespace

std::vector<GrainPair> near_grains(std::span<const GrainCell> cells, int reach,
                                   const SlabGrid& grid) {
  const GridShape& shape = grid.shape();
  std::vector<GrainCell> all = gather_all(cells_at_ends(cells, reach, grid), grid.communicator());
  std::erase_if(all, [&](const GrainCell& c) {
    return c.row < grid.first_row() - reach || c.row >= grid.last_row() + reach;
  });
  all.insert(all.end(), cells.begin(), cells.end());
  const CellMap map(std::move(all), shape);
  std::int32_t most = -1;
  for (const GrainCell& c : map.cells()) most = std::max(most, c.grain);
  Neighbours near(static_cast<std::size_t>(most + 1));
  std::vector<int> xs, ys;
  ys.push_back(0);
  for (const GrainCell& c : map.cells()) {
    near_indices(c.lateral % shape.nodes[0], reach, shape.nodes[0], shape.periodic[0], xs);
    if (shape.dimension == 3) {
      near_indices(c.lateral / shape.nodes[0], reach, shape.nodes[1], shape.periodic[1], ys);
    }
    for (int row = c.row; row <= c.row + reach; ++row) {
      for (const int y : ys) {
        for (const int x : xs) {
          for (const GrainCell& other : map.at(row, y * shape.nodes[0] + x)) {
            if (other.grain != c.grain) join(c.grain, other.grain, near);
          }
        }
      }
    }
  }
  std::vector<GrainPair> pairs;
  for (std::size_t g = 0; g < near.size(); ++g) {
    for (const std::int32_t other : near[g]) pairs.emplace_back(static_cast<int>(g), other);
  }
  pairs = gather_all(pairs, grid.communicator());
  keep_each_once(pairs);
  return pairs;
}

namespace {

/// Grains in the order in which they lose their last neighbours: always one of the smallest degree
/// among those left, the smallest number first.
std::vector<std::int32_t> smallest_first(const Neighbours& near) {
  std::vector<int> degree;
  std::set<std::pair<int, std::int32_t>> left;
  for (std::size_t g = 0; g < near.size(); ++g) {
    degree.push_back(static_cast<int>(near[g].size()));
    if (!near[g].empty()) left.emplace(degree.back(), static_cast<std::int32_t>(g));
  }
  std::vector<std::int32_t> order;
  while (!left.empty()) {
    const std::int32_t grain = left.begin()->second;
    left.erase(left.begin());
    order.push_back(grain);
    for (const std::int32_t other : near[static_cast<std::size_t>(grain)]) {
      int& d = degree[static_cast<std::size_t>(other)];
      if (left.erase({d, other}) == 1) left.emplace(--d, other);
    }
  }
  return order;
}

}  // namespace

std::vector<std::int8_t> colour_grains(std::int32_t grains, const std::vector<GrainPair>& pairs) {
  Neighbours near(static_cast<std::size_t>(grains));
  for (const auto& [a, b] : pairs) {
    near[static_cast<std::size_t>(a)].push_back(b);
    near[static_cast<std::size_t>(b)].push_back(a);
  }
  std::vector<std::int8_t> colour(near.size(), -1);
  const std::vector<std::int32_t> order = smallest_first(near);
  for (const std::int32_t grain : std::views::reverse(order)) {
    std::array<bool, most_colours> taken{};
    for (const std::int32_t other : near[static_cast<std::size_t>(grain)]) {
      const std::int8_t c = colour[static_cast<std::size_t>(other)];
      if (c >= 0) taken[static_cast<std::size_t>(c)] = true;
    }
    const auto free = std::find(taken.begin(), taken.end(), false);
    if (free == taken.end()) {
      throw StateError(
          "grain " + std::to_string(grain) + " is near " +
          std::to_string(near[static_cast<std::size_t>(grain)].size()) + " others, grain " +
          std::to_string(near[static_cast<std::size_t>(grain)].front()) + " among them, and all " +
          std::to_string(most_colours) + " velocity fields are taken there");
    }
    colour[static_cast<std::size_t>(grain)] = static_cast<std::int8_t>(free - taken.begin());
  }
  std::replace(colour.begin(), colour.end(), std::int8_t{-1}, std::int8_t{0});
  return colour;
}

}  // namespace poreshock
