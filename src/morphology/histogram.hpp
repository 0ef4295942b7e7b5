#pragma once
// How many ranks lie above each threshold. Private to the layer.

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <limits>
#include <vector>

namespace poreshock {

/// Counts of ranks 0 ... K. With few thresholds every rank is compared with each, 64 at a time;
/// with many there is a histogram, in four interleaved copies so that a run of equal ranks does not
/// wait for its own last increment, of short integers so that all kinds of cells fit the first
/// cache.
struct Histogram {
  static constexpr std::size_t copies = 4;
  static constexpr std::size_t few = 24;  ///< measured: below, comparing is faster, even on noise
  std::size_t thresholds;
  std::vector<std::uint32_t> bins;   ///< copies x ranks
  std::size_t pending = 0;           ///< ranks added to bins since they were last emptied
  std::vector<std::int64_t> totals;  ///< per rank, what the bins have been emptied into
  std::vector<std::int64_t> above;   ///< per threshold, of the ranks that were compared

  explicit Histogram(std::size_t count)
      : thresholds(count), bins(copies * (count + 1), 0), totals(count + 1, 0), above(count, 0) {}
};

/// Adds one rank.
inline void add_rank(std::size_t rank, Histogram& histogram) {
  ++histogram.totals[rank];
}

/// Empties the bins before one of them can overflow.
inline void empty_bins(Histogram& histogram) {
  for (std::size_t i = 0; i < histogram.bins.size(); ++i) {
    histogram.totals[i / Histogram::copies] += histogram.bins[i];
    histogram.bins[i] = 0;
  }
  histogram.pending = 0;
}

/// 64 bytes that the compiler handles as one or several vectors.
using Bytes = std::uint8_t __attribute__((vector_size(64)));

/// Adds `blocks` times 64 ranks by comparing them with every threshold.
inline void compare_ranks(const std::uint8_t* ranks, std::size_t blocks, Histogram& histogram) {
  constexpr std::size_t most = std::numeric_limits<std::uint8_t>::max();  // before a byte overflows
  for (std::size_t begin = 0; begin < blocks; begin += most) {
    const std::size_t end = blocks < begin + most ? blocks : begin + most;
    for (std::size_t j = 0; j < histogram.thresholds; ++j) {
      const Bytes limit = Bytes{} + static_cast<std::uint8_t>(j);
      Bytes sums{};
      for (std::size_t block = begin; block < end; ++block) {
        Bytes part;
        std::memcpy(&part, ranks + 64 * block, sizeof(part));
        sums -= static_cast<Bytes>(part > limit);  // true is 255, that is -1
      }
      std::int64_t total = 0;
      for (std::size_t k = 0; k < 64; ++k) total += sums[k];
      histogram.above[j] += total;
    }
  }
}

/// Adds 64 ranks; equal ones, common away from fronts, cost one addition.
template <class Rank>
void add_stretch(const Rank* ranks, std::uint32_t* bins) {
  constexpr std::size_t copies = Histogram::copies;
  Rank difference = 0;
  for (std::size_t k = 0; k < 64; ++k) {
    difference = static_cast<Rank>(difference | (ranks[k] ^ ranks[0]));
  }
  if (difference == 0) {
    bins[copies * ranks[0]] += 64;
    return;
  }
  for (std::size_t k = 0; k < 64; k += copies) {
    for (std::size_t copy = 0; copy < copies; ++copy) ++bins[copies * ranks[k + copy] + copy];
  }
}

/// Adds `count` ranks.
template <class Rank>
void add_ranks(const Rank* ranks, std::size_t count, Histogram& histogram) {
  const std::size_t blocks = count / 64;
  if (histogram.pending + count > std::numeric_limits<std::uint32_t>::max()) empty_bins(histogram);
  histogram.pending += count;
  std::uint32_t* bins = histogram.bins.data();
  bool compared = false;
  if constexpr (sizeof(Rank) == 1) {
    compared = histogram.thresholds <= Histogram::few;
    if (compared) compare_ranks(ranks, blocks, histogram);
  }
  for (std::size_t b = 0; !compared && b < blocks; ++b) add_stretch(ranks + 64 * b, bins);
  for (std::size_t i = 64 * blocks; i < count; ++i) ++bins[Histogram::copies * ranks[i]];
}

/// For every threshold j the number of ranks above j, which is the number of white cells.
inline std::vector<std::int64_t> white_counts(const Histogram& histogram) {
  std::vector<std::int64_t> counts = histogram.above;
  std::int64_t above = 0;
  for (std::size_t j = histogram.thresholds; j-- > 0;) {
    above += histogram.totals[j + 1];
    for (std::size_t copy = 0; copy < Histogram::copies; ++copy) {
      above += histogram.bins[Histogram::copies * (j + 1) + copy];
    }
    counts[j] += above;
  }
  return counts;
}

/// Adds combine(i) for i = begin ... end - 1; `scratch` holds at least `end` ranks.
template <class Rank, class Combine>
void add_combined(std::size_t begin, std::size_t end, Combine combine, Rank* __restrict scratch,
                  Histogram& histogram) {
  for (std::size_t i = begin; i < end; ++i) scratch[i] = combine(i);
  add_ranks(scratch + begin, end - begin, histogram);
}

}  // namespace poreshock
