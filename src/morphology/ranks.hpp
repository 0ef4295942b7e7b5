#pragma once
// Ranks of values: the number of thresholds that a value reaches. Private to the layer.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace poreshock {

/// Table for rank(v) = number of thresholds <= v. A coarse cell of the table gives the number of
/// thresholds in lower cells; the few thresholds of the same cell are then compared one by one.
/// Thresholds and values find their cell by the same monotone arithmetic, so the rank is exact
/// whatever the rounding, for any spacing, repeated and infinite thresholds.
struct RankTable {
  std::size_t count = 0;            ///< thresholds
  std::vector<double> thresholds;   ///< padded with NaN, which no value reaches
  std::vector<std::int32_t> below;  ///< per cell: thresholds in lower cells
  double low = 0.0;
  double scale = 0.0;  ///< cells per unit of value
  double last_cell = 0.0;
  int per_cell = 0;  ///< most thresholds in one cell; 0: search instead of the table
};

/// Makes the table. Throws InputError when thresholds descend or are NaN. Not collective.
RankTable make_rank_table(std::span<const double> thresholds);

/// Cell of a value; NaN belongs to cell 0.
inline std::int32_t table_cell(const RankTable& table, double value) {
  const double position = (value - table.low) * table.scale;
  const double from_zero = position > 0.0 ? position : 0.0;
  return static_cast<std::int32_t>(from_zero < table.last_cell ? from_zero : table.last_cell);
}

/// Rank by bisection without branches; NaN has rank 0.
inline std::size_t searched_rank(const RankTable& table, double value) {
  std::size_t rank = 0;
  std::size_t step = 1;
  while (2 * step <= table.count) step *= 2;
  for (; step > 0; step /= 2) {
    const std::size_t next = rank + step;
    const bool reached = next <= table.count && table.thresholds[next - 1] <= value;
    rank = reached ? next : rank;
  }
  return rank;
}

/// Calls use(zero) with a zero of the smallest type that holds ranks 0 ... K: the smaller the type,
/// the more pixels a vector instruction takes.
template <class Use>
void with_rank_type(const RankTable& table, Use&& use) {
  if (table.count <= std::numeric_limits<std::uint8_t>::max()) {
    use(std::uint8_t{0});
  } else if (table.count <= std::numeric_limits<std::uint16_t>::max()) {
    use(std::uint16_t{0});
  } else {
    use(std::uint32_t{0});
  }
}

/// Ranks of at most 256 values when no cell holds more than PerCell thresholds. A loop of its own
/// over numbers of one size, so that it vectorises.
template <int PerCell>
void look_up(const RankTable& table, const double* values, std::size_t count,
             std::int32_t* __restrict ranks) {
  const double* thresholds = table.thresholds.data();
  const std::int32_t* below = table.below.data();
  const double low = table.low, scale = table.scale, last = table.last_cell;
  for (std::size_t i = 0; i < count; ++i) {
    const double position = (values[i] - low) * scale;
    const double from_zero = position > 0.0 ? position : 0.0;
    const std::int32_t base = below[static_cast<std::int32_t>(from_zero < last ? from_zero : last)];
    std::int32_t rank = base;
    for (int k = 0; k < PerCell; ++k) rank += thresholds[base + k] <= values[i] ? 1 : 0;
    ranks[i] = rank;
  }
}

/// Ranks of at most 256 values by comparing with every threshold, for few thresholds.
inline void compare_values(const RankTable& table, const double* values, std::size_t count,
                           std::int32_t* __restrict ranks) {
  std::fill(ranks, ranks + count, 0);
  for (std::size_t k = 0; k < table.count; ++k) {
    const double threshold = table.thresholds[k];
    for (std::size_t i = 0; i < count; ++i) ranks[i] += threshold <= values[i] ? 1 : 0;
  }
}

/// Ranks of at most 256 values.
inline void rank_values(const RankTable& table, const double* values, std::size_t count,
                        std::int32_t* ranks) {
  constexpr std::size_t few = 16;  // measured: then it is faster than the table
  if (table.count <= few) return compare_values(table, values, count, ranks);
  switch (table.per_cell) {
    case 1:
      return look_up<1>(table, values, count, ranks);
    case 2:
      return look_up<2>(table, values, count, ranks);
    case 3:
      return look_up<3>(table, values, count, ranks);
    case 4:
      return look_up<4>(table, values, count, ranks);
    default:
      for (std::size_t i = 0; i < count; ++i) {
        ranks[i] = static_cast<std::int32_t>(searched_rank(table, values[i]));
      }
  }
}

/// Ranks of a row of values; void pixels have rank 0.
template <class Rank>
void rank_row(const RankTable& table, std::span<const double> values,
              std::span<const std::uint8_t> solid, Rank* __restrict ranks) {
  constexpr std::size_t stretch = 256;
  std::int32_t found[stretch];
  for (std::size_t at = 0; at < values.size(); at += stretch) {
    const std::size_t count = std::min(stretch, values.size() - at);
    rank_values(table, &values[at], count, found);
    const std::uint8_t* mask = &solid[at];
    for (std::size_t i = 0; i < count; ++i) {
      ranks[at + i] = static_cast<Rank>(mask[i] != 0 ? found[i] : 0);
    }
  }
}

/// Number of material pixels. Bytes are summed in short stretches, which vectorises.
inline std::int64_t material_in(std::span<const std::uint8_t> solid) {
  std::int64_t total = 0;
  for (std::size_t i = 0; i < solid.size(); i += 4096) {
    const std::size_t end = std::min<std::size_t>(solid.size(), i + 4096);
    std::uint32_t part = 0;
    for (std::size_t k = i; k < end; ++k) part += solid[k] != 0 ? 1 : 0;
    total += part;
  }
  return total;
}

/// Whether a mask of ones and zeros has a zero.
inline bool has_void(std::span<const std::uint8_t> mask) {
  std::uint8_t all = 1;
  for (const std::uint8_t solid : mask) all = static_cast<std::uint8_t>(all & solid);
  return all == 0;
}

/// Ranks and mask of a row, with one more pixel at each end: the other end of the row when it is
/// periodic, else outside, which has rank 0 and counts as material so that no frame edge is a void
/// edge. `ranks` and `mask` hold values.size() + 2 entries.
template <class Rank>
void padded_row(const RankTable& table, std::span<const double> values,
                std::span<const std::uint8_t> solid, bool periodic, Rank* ranks,
                std::uint8_t* mask) {
  const std::size_t width = values.size();
  rank_row(table, values, solid, ranks + 1);
  for (std::size_t i = 0; i < width; ++i) mask[i + 1] = solid[i] != 0 ? 1 : 0;
  ranks[0] = periodic ? ranks[width] : Rank{0};
  ranks[width + 1] = periodic ? ranks[1] : Rank{0};
  mask[0] = periodic ? mask[width] : std::uint8_t{1};
  mask[width + 1] = periodic ? mask[1] : std::uint8_t{1};
}

}  // namespace poreshock
