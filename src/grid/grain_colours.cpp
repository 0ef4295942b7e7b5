#include "poreshock/grid/grain_colours.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <set>
#include <string>
#include <tuple>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"

namespace poreshock {

namespace {

template <class Item>
void keep_each_once(std::vector<Item>& items) {
  std::sort(items.begin(), items.end());
  items.resize(static_cast<std::size_t>(std::unique(items.begin(), items.end()) - items.begin()));
}

/// Runs of the cells, line after line of cells, in a line by their first one.
std::vector<CellRun> runs_of(std::span<const GrainCell> cells, const GridShape& shape) {
  std::vector<CellRun> runs;
  std::size_t line = 0;  // where its runs begin
  for (const GrainCell& c : cells) {
    const int x = c.lateral % shape.nodes[0], y = c.lateral / shape.nodes[0];
    if (runs.empty() || runs.back().row != c.row || runs.back().y != y) line = runs.size();
    std::size_t k = runs.size();
    // A run that may go on is one of the last: others are of grains that have ended.
    while (k > line && !(runs[k - 1].grain == c.grain && runs[k - 1].last + 1 >= x)) --k;
    if (k > line) {
      runs[k - 1].last = x;
    } else {
      runs.push_back({c.row, y, x, x, c.grain});
    }
  }
  return runs;
}

/// Runs of the rows within `reach` of a slab end that another rank lies beyond.
std::vector<CellRun> runs_at_ends(std::span<const CellRun> runs, int reach, const SlabGrid& grid) {
  std::vector<CellRun> ends;
  for (const CellRun& r : runs) {
    const bool low = grid.first_row() > grid.shape().first && r.row < grid.first_row() + reach;
    const bool high = grid.last_row() < grid.shape().rows && r.row >= grid.last_row() - reach;
    if (low || high) ends.push_back(r);
  }
  return ends;
}

/// Runs by their lines of cells.
class RunMap {
 public:
  RunMap(std::vector<CellRun> runs, const GridShape& shape)
      : runs_(std::move(runs)), lines_(shape.row_size / shape.nodes[0]) {
    const auto before = [](const CellRun& a, const CellRun& b) {
      return std::tie(a.row, a.y, a.first, a.grain) < std::tie(b.row, b.y, b.first, b.grain);
    };
    // Those of one rank are in order.
    if (!std::is_sorted(runs_.begin(), runs_.end(), before)) {
      std::sort(runs_.begin(), runs_.end(), before);
    }
    if (runs_.empty()) return;
    first_row_ = runs_.front().row;
    rows_ = runs_.back().row - first_row_ + 1;
    start_.assign(static_cast<std::size_t>(rows_) * lines_ + 1, 0);
    for (const CellRun& r : runs_) {
      ++start_[place(r.row, r.y) + 1];
      longest_ = std::max(longest_, r.last - r.first);
    }
    for (std::size_t i = 1; i < start_.size(); ++i) start_[i] += start_[i - 1];
  }

  const std::vector<CellRun>& runs() const { return runs_; }
  /// Longest run less one cell.
  int longest() const { return longest_; }

  std::span<const CellRun> line(int row, int y) const {
    if (row < first_row_ || row >= first_row_ + rows_ || y >= lines_) return {};
    return {runs_.data() + start_[place(row, y)], runs_.data() + start_[place(row, y) + 1]};
  }

 private:
  std::size_t place(int row, int y) const {
    return static_cast<std::size_t>(row - first_row_) * lines_ + y;
  }

  std::vector<CellRun> runs_;
  int lines_;
  int first_row_ = 0, rows_ = 0, longest_ = 0;
  std::vector<std::size_t> start_;
};

using Neighbours = std::vector<std::vector<std::int32_t>>;

/// Pairs of neighbours, each once, with the smaller grain.
struct Joined {
  Neighbours near;
  std::array<GrainPair, 256> latest{};  ///< some of them, as the same ones come again and again
};

/// Notes two neighbours; a grain has few.
void join(std::int32_t a, std::int32_t b, Joined& joined) {
  const GrainPair pair{std::min(a, b), std::max(a, b)};
  const auto place = static_cast<std::uint32_t>(pair.first * 31 + pair.second);
  GrainPair& latest = joined.latest[place % joined.latest.size()];
  if (latest == pair) return;
  latest = pair;
  std::vector<std::int32_t>& list = joined.near[static_cast<std::size_t>(pair.first)];
  if (std::find(list.begin(), list.end(), pair.second) == list.end()) list.push_back(pair.second);
}

/// Joins the grains of two lines whose runs overlap when those of the first are `reach` cells
/// longer at both ends, and moved by `shift`. `longest`: see RunMap.
void join_lines(std::span<const CellRun> line, std::span<const CellRun> others, int reach,
                int shift, int longest, Joined& joined) {
  auto from = others.begin();
  for (const CellRun& r : line) {
    const int first = r.first - reach + shift, last = r.last + reach + shift;
    while (from != others.end() && from->first + longest < first) ++from;
    for (auto other = from; other != others.end() && other->first <= last; ++other) {
      if (other->last >= first && other->grain != r.grain) join(r.grain, other->grain, joined);
    }
  }
}

/// Indices within reach of one along y, each once.
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

std::vector<CellRun> cell_runs(std::span<const GrainCell> cells, int reach, const SlabGrid& grid) {
  const std::vector<CellRun> own = runs_of(cells, grid.shape());
  std::vector<CellRun> all = gather_all(runs_at_ends(own, reach, grid), grid.communicator());
  std::erase_if(all, [&](const CellRun& r) {
    return r.row < grid.first_row() - reach || r.row >= grid.last_row() + reach ||
           (r.row >= grid.first_row() && r.row < grid.last_row());
  });
  all.insert(all.end(), own.begin(), own.end());
  return all;
}

std::vector<GrainPair> near_grains(std::vector<CellRun> runs, int reach, const SlabGrid& grid) {
  const GridShape& shape = grid.shape();
  const RunMap map(std::move(runs), shape);
  std::int32_t most = -1;
  for (const CellRun& r : map.runs()) most = std::max(most, r.grain);
  Joined joined;
  joined.near.resize(static_cast<std::size_t>(most + 1));
  std::vector<int> ys;
  // Stencil cells 0 and `around` are one and the same across a periodic side.
  const int around = shape.nodes[0] - 3;
  std::vector<CellRun> beginning, ending;  // of a line: what may be near across a periodic side
  for (std::size_t first = 0; first < map.runs().size();) {
    const CellRun& r = map.runs()[first];
    const std::span<const CellRun> line = map.line(r.row, r.y);
    first += line.size();
    beginning.clear(), ending.clear();
    for (const CellRun& run : line) {
      if (!shape.periodic[0]) break;
      if (run.first - reach + around < shape.nodes[0]) beginning.push_back(run);
      if (run.last + reach - around >= 0) ending.push_back(run);
    }
    near_indices(r.y, shape.dimension == 3 ? reach : 0, shape.nodes[1],
                 shape.dimension == 3 && shape.periodic[1], ys);
    for (int row = r.row; row <= r.row + reach; ++row) {
      for (const int y : ys) {
        const std::span<const CellRun> others = map.line(row, y);
        join_lines(line, others, reach, 0, map.longest(), joined);
        join_lines(beginning, others, reach, around, map.longest(), joined);
        join_lines(ending, others, reach, -around, map.longest(), joined);
      }
    }
  }
  std::vector<GrainPair> pairs;
  for (std::size_t g = 0; g < joined.near.size(); ++g) {
    for (const std::int32_t other : joined.near[g]) pairs.emplace_back(static_cast<int>(g), other);
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
  std::vector<std::int32_t> order = smallest_first(near);
  std::reverse(order.begin(), order.end());
  for (const std::int32_t grain : order) {
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
