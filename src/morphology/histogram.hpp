#pragma once
// Histograms of ranks. Private to the layer.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace poreshock {

/// Histogram of ranks 0 ... K in four interleaved copies, so that a run of equal ranks does not
/// wait for its own last increment.
struct Histogram {
  static constexpr std::size_t copies = 4;
  std::vector<std::int64_t> bins;

  explicit Histogram(std::size_t thresholds) : bins(copies * (thresholds + 1), 0) {}
};

/// Adds one rank.
inline void add_rank(std::size_t rank, Histogram& histogram) {
  ++histogram.bins[Histogram::copies * rank];
}

/// Adds `count` ranks. Stretches of 64 equal ranks, common away from fronts, cost one addition.
template <class Rank>
void add_ranks(const Rank* ranks, std::size_t count, Histogram& histogram) {
  constexpr std::size_t copies = Histogram::copies;
  constexpr std::size_t stretch = 64;
  static_assert(stretch % copies == 0);
  std::int64_t* bins = histogram.bins.data();
  std::size_t i = 0;
  for (; i + stretch <= count; i += stretch) {
    const Rank* part = ranks + i;
    Rank difference = 0;
    for (std::size_t k = 0; k < stretch; ++k) {
      difference = static_cast<Rank>(difference | (part[k] ^ part[0]));
    }
    if (difference == 0) {
      bins[copies * part[0]] += static_cast<std::int64_t>(stretch);
      continue;
    }
    for (std::size_t k = 0; k < stretch; k += copies) {
      for (std::size_t copy = 0; copy < copies; ++copy) {
        ++bins[copies * part[k + copy] + copy];
      }
    }
  }
  for (; i < count; ++i) ++bins[copies * ranks[i] + i % copies];
}

/// For every threshold j the number of ranks above j, which is the number of white cells.
inline std::vector<std::int64_t> white_counts(const Histogram& histogram) {
  const std::size_t thresholds = histogram.bins.size() / Histogram::copies - 1;
  std::vector<std::int64_t> counts(thresholds);
  std::int64_t above = 0;
  for (std::size_t j = thresholds; j-- > 0;) {
    for (std::size_t copy = 0; copy < Histogram::copies; ++copy) {
      above += histogram.bins[Histogram::copies * (j + 1) + copy];
    }
    counts[j] = above;
  }
  return counts;
}

/// Adds combine(i) for i = begin ... end - 1; `scratch` holds at least `end` ranks.
template <class Rank, class Combine>
void add_combined(std::size_t begin, std::size_t end, Combine combine, Rank* scratch,
                  Histogram& histogram) {
  for (std::size_t i = begin; i < end; ++i) scratch[i] = combine(i);
  add_ranks(scratch + begin, end - begin, histogram);
}

}  // namespace poreshock
