#include "poreshock/grid/partition.hpp"

#include <metis.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>

#include "poreshock/core/error.hpp"

namespace poreshock {

namespace {

int least_rows(int part, int parts, SlabLimits limits) {
  if (part == 0) return limits.first;
  return part == parts - 1 ? limits.last : limits.inner;
}

/// Row starts of slabs no heavier than `bottleneck`, empty when there are none. `below[row]` is the
/// weight of all rows below `row`. A slab may have to stay lighter than it could be, so that the
/// rows the next one must take are not too heavy: all reachable ends are followed, not the furthest
/// only.
std::vector<int> chain_within(const std::vector<double>& below, int parts, SlabLimits limits,
                              double bottleneck) {
  const int rows = static_cast<int>(below.size()) - 1;
  std::vector<std::vector<int>> start_of(parts, std::vector<int>(below.size(), -1));
  // Last row not above the index at which the slabs so far can end, -1 for none.
  std::vector<int> latest(below.size(), 0), next(below.size());
  for (int part = 0; part < parts; ++part) {
    const int least = least_rows(part, parts, limits);
    for (int end = 0; end <= rows; ++end) {
      // The latest start makes the lightest slab with this end.
      const int start = end < least ? -1 : latest[end - least];
      if (start >= 0 && below[end] - below[start] <= bottleneck) start_of[part][end] = start;
      next[end] = start_of[part][end] >= 0 ? end : (end > 0 ? next[end - 1] : -1);
    }
    latest.swap(next);
  }
  if (start_of.back()[rows] < 0) return {};
  std::vector<int> starts = {rows};
  for (int part = parts - 1; part >= 0; --part) starts.push_back(start_of[part][starts.back()]);
  std::reverse(starts.begin(), starts.end());
  return starts;
}

/// Exact smallest bottleneck by bisection over the attainable range.
std::vector<int> chain_partition(const std::vector<double>& weights, int parts, SlabLimits limits) {
  std::vector<double> below = {0.0};
  for (const double weight : weights) below.push_back(below.back() + weight);
  double low = 0.0;
  double high = below.back();
  std::vector<int> best = chain_within(below, parts, limits, high);
  for (int step = 0; step < 60; ++step) {
    const double middle = 0.5 * (low + high);
    std::vector<int> starts = chain_within(below, parts, limits, middle);
    if (starts.empty()) {
      low = middle;
    } else {
      high = middle;
      best = std::move(starts);
    }
  }
  return best;
}

/// METIS on the path graph of rows; empty when its parts are not contiguous or too thin.
std::vector<int> metis_partition(const std::vector<double>& weights, int parts, SlabLimits limits) {
  idx_t rows = static_cast<idx_t>(weights.size());
  const double total = std::accumulate(weights.begin(), weights.end(), 0.0);
  if (parts < 2 || total <= 0.0) return {};
  std::vector<idx_t> offsets, neighbours, vertex_weights;
  for (idx_t row = 0; row < rows; ++row) {
    offsets.push_back(static_cast<idx_t>(neighbours.size()));
    if (row > 0) neighbours.push_back(row - 1);
    if (row + 1 < rows) neighbours.push_back(row + 1);
    // Scaled so that the sum stays far below 2^31.
    vertex_weights.push_back(static_cast<idx_t>(std::lround(weights[row] / total * 1.0e8)));
  }
  offsets.push_back(static_cast<idx_t>(neighbours.size()));
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_CONTIG] = 1;
  options[METIS_OPTION_SEED] = 1;
  idx_t constraints = 1, part_count = parts, cut = 0;
  std::vector<idx_t> part(weights.size());
  if (METIS_PartGraphKway(&rows, &constraints, offsets.data(), neighbours.data(),
                          vertex_weights.data(), nullptr, nullptr, &part_count, nullptr, nullptr,
                          options, &cut, part.data()) != METIS_OK) {
    return {};
  }
  std::vector<int> starts = {0};
  for (idx_t row = 1; row < rows; ++row) {
    if (part[row] != part[row - 1]) starts.push_back(row);
  }
  starts.push_back(rows);
  if (static_cast<int>(starts.size()) != parts + 1) return {};
  for (int p = 0; p < parts; ++p) {
    if (starts[p + 1] - starts[p] < least_rows(p, parts, limits)) return {};
  }
  return starts;
}

}  // namespace

double heaviest(const std::vector<double>& weights, const std::vector<int>& starts) {
  double result = 0.0;
  for (std::size_t p = 0; p + 1 < starts.size(); ++p) {
    result = std::max(
        result, std::accumulate(weights.begin() + starts[p], weights.begin() + starts[p + 1], 0.0));
  }
  return result;
}

std::vector<int> partition_rows(const std::vector<double>& weights, int parts, SlabLimits limits) {
  const int rows = static_cast<int>(weights.size());
  int needed = 0;
  for (int p = 0; p < parts; ++p) needed += least_rows(p, parts, limits);
  if (parts > 1 && needed > rows) {
    throw InputError("the domain has " + std::to_string(rows) +
                     " rows of nodes along the shock axis, " + std::to_string(parts) +
                     " ranks need at least " + std::to_string(needed) +
                     ": use fewer ranks or smaller cells");
  }
  if (parts == 1) return {0, rows};
  std::vector<int> chain = chain_partition(weights, parts, limits);
  std::vector<int> metis = metis_partition(weights, parts, limits);
  if (!metis.empty() && heaviest(weights, metis) < heaviest(weights, chain)) return metis;
  return chain;
}

}  // namespace poreshock
