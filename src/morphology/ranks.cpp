#include "ranks.hpp"

#include <cmath>
#include <limits>
#include <string>

#include "poreshock/core/error.hpp"

namespace poreshock {
namespace {

void check_thresholds(std::span<const double> thresholds) {
  for (std::size_t i = 0; i < thresholds.size(); ++i) {
    const bool descends = i > 0 && thresholds[i] < thresholds[i - 1];
    if (!std::isnan(thresholds[i]) && !descends) continue;
    throw InputError("threshold " + std::to_string(i + 1) + " of " +
                     std::to_string(thresholds.size()) + " is " + std::to_string(thresholds[i]) +
                     (descends ? ", below the one before it, " + std::to_string(thresholds[i - 1])
                               : std::string(", not a number")) +
                     ". Thresholds ascend; equal and infinite ones are allowed. Sort the list.");
  }
}

/// Origin and scale of the cells, from the finite thresholds.
void place_cells(std::span<const double> thresholds, RankTable& table) {
  double low = std::numeric_limits<double>::infinity();
  double high = -low;
  for (const double threshold : thresholds) {
    if (!std::isfinite(threshold)) continue;
    low = std::min(low, threshold);
    high = std::max(high, threshold);
  }
  const double range = high - low;
  if (!(range > 0.0) || !std::isfinite(range)) return;  // one cell: the search takes over
  // Four cells per threshold keep evenly spaced ones apart with room for rounding.
  table.low = low;
  table.last_cell = 4.0 * static_cast<double>(thresholds.size());
  table.scale = table.last_cell / range;
}

}  // namespace

RankTable make_rank_table(std::span<const double> thresholds) {
  check_thresholds(thresholds);
  // Above this many comparisons a bisection is faster.
  constexpr int most_per_cell = 4;
  RankTable table;
  table.count = thresholds.size();
  table.thresholds.assign(thresholds.begin(), thresholds.end());
  table.thresholds.resize(thresholds.size() + most_per_cell,
                          std::numeric_limits<double>::quiet_NaN());
  place_cells(thresholds, table);

  std::vector<std::int32_t> in_cell(static_cast<std::size_t>(table.last_cell) + 1, 0);
  for (const double threshold : thresholds) {
    ++in_cell[static_cast<std::size_t>(table_cell(table, threshold))];
  }
  table.below.resize(in_cell.size());
  std::int32_t below = 0;
  std::int32_t most = 0;
  for (std::size_t cell = 0; cell < in_cell.size(); ++cell) {
    table.below[cell] = below;
    below += in_cell[cell];
    most = std::max(most, in_cell[cell]);
  }
  table.per_cell = most <= most_per_cell ? most : 0;
  return table;
}

}  // namespace poreshock
