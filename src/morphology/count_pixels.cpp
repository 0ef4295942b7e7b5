#include "poreshock/morphology/minkowski.hpp"

#include <algorithm>
#include <string>
#include <utility>

#include "histogram.hpp"
#include "poreshock/core/error.hpp"
#include "ranks.hpp"

namespace poreshock {
namespace {

/// Ranks and mask of a pixel row with one pixel more at each end. A row outside the map has rank 0
/// and counts as material, so that no frame edge is taken for a void edge.
template <class Rank>
struct Row {
  std::vector<Rank> ranks;
  std::vector<std::uint8_t> mask;
  bool outside = true;
  bool has_void = false;

  explicit Row(std::size_t width) : ranks(width + 2, Rank{0}), mask(width + 2, 1) {}
};

struct Histograms {
  Histogram F, E, V, V4, D, B_void, B_frame;

  explicit Histograms(std::size_t thresholds)
      : F(thresholds),
        E(thresholds),
        V(thresholds),
        V4(thresholds),
        D(thresholds),
        B_void(thresholds),
        B_frame(thresholds) {}
};

void check_block(const PixelBlock& block) {
  const std::int64_t needed = (std::int64_t{block.rows} + 1) * block.width;
  const auto values = static_cast<std::int64_t>(block.values.size());
  const auto solid = static_cast<std::int64_t>(block.solid.size());
  if (block.width > 0 && values == needed && solid == needed) return;
  throw InputError("a pixel block of " + std::to_string(block.rows) + " rows of " +
                   std::to_string(block.width) + " pixels needs " + std::to_string(needed) +
                   " values and mask entries, one row more than it owns, and at least one pixel a "
                   "row; it has " +
                   std::to_string(values) + " values and " + std::to_string(solid) +
                   " mask entries.");
}

template <class Rank>
void read_row(const PixelBlock& block, const RankTable& table, int row, Row<Rank>& result) {
  const auto width = static_cast<std::size_t>(block.width);
  result.outside = block.last && row == block.rows;
  if (result.outside) {
    std::fill(result.ranks.begin(), result.ranks.end(), Rank{0});
    std::fill(result.mask.begin(), result.mask.end(), std::uint8_t{1});
  } else {
    const std::size_t start = static_cast<std::size_t>(row) * width;
    padded_row(table, block.values.subspan(start, width), block.solid.subspan(start, width),
               block.periodic, result.ranks.data(), result.mask.data());
  }
  result.has_void = std::find(result.mask.begin(), result.mask.end(), 0) != result.mask.end();
}

/// Adds the cells owned by the row `low`. Where x is not periodic, the pixel outside on the left
/// owns the left frame, just as the row outside below the map owns the low frame.
template <class Rank>
void add_row(const Row<Rank>& low, const Row<Rank>& high, bool periodic, Rank* scratch,
             Histograms& histograms) {
  const Rank* a = low.ranks.data();
  const Rank* b = high.ranks.data();
  const std::size_t begin = periodic ? 1 : 0;
  const std::size_t end = low.ranks.size() - 1;
  const auto add = [&](auto combine, Histogram& histogram) {
    add_combined(begin, end, combine, scratch, histogram);
  };
  add([=](std::size_t i) { return a[i]; }, histograms.F);
  add([=](std::size_t i) { return std::max(a[i], a[i + 1]); }, histograms.E);
  add([=](std::size_t i) { return std::max(a[i], b[i]); }, histograms.E);
  add([=](std::size_t i) { return std::max(std::max(a[i], a[i + 1]), std::max(b[i], b[i + 1])); },
      histograms.V);
  add([=](std::size_t i) { return std::min(std::min(a[i], a[i + 1]), std::min(b[i], b[i + 1])); },
      histograms.V4);
  add([=](std::size_t i) { return std::max(a[i], b[i + 1]); }, histograms.D);
  add([=](std::size_t i) { return std::max(a[i + 1], b[i]); }, histograms.D);
}

/// Adds the edges between material and void that the row `low` owns.
template <class Rank>
void add_void_edges(const Row<Rank>& low, const Row<Rank>& high, Histogram& histogram) {
  if (!low.has_void && !high.has_void) return;
  for (std::size_t i = 1; i + 1 < low.ranks.size(); ++i) {
    if ((low.mask[i] & low.mask[i + 1]) == 0) {
      add_rank(std::max(low.ranks[i], low.ranks[i + 1]), histogram);
    }
    if ((low.mask[i] & high.mask[i]) == 0) {
      add_rank(std::max(low.ranks[i], high.ranks[i]), histogram);
    }
  }
}

/// Adds the frame edges that the row `low` owns; one of two neighbours outside has rank 0.
template <class Rank>
void add_frame_edges(const Row<Rank>& low, const Row<Rank>& high, bool periodic, Rank* scratch,
                     Histogram& histogram) {
  const std::size_t width = low.ranks.size() - 2;
  if (!periodic && !low.outside) {
    add_rank(low.ranks[1], histogram);
    add_rank(low.ranks[width], histogram);
  }
  if (low.outside || high.outside) {
    const Rank* a = low.ranks.data();
    const Rank* b = high.ranks.data();
    add_combined(
        1, width + 1, [=](std::size_t i) { return std::max(a[i], b[i]); }, scratch, histogram);
  }
}

template <class Rank>
void fill_histograms(const PixelBlock& block, const RankTable& table, Histograms& histograms) {
  const auto width = static_cast<std::size_t>(block.width);
  std::vector<Rank> scratch(width + 2);
  Row<Rank> low(width);
  Row<Rank> high(width);
  for (int row = block.first ? -1 : 0; row < block.rows; ++row) {
    if (row == 0 && !block.first) read_row(block, table, 0, low);
    read_row(block, table, row + 1, high);
    add_row(low, high, block.periodic, scratch.data(), histograms);
    add_void_edges(low, high, histograms.B_void);
    add_frame_edges(low, high, block.periodic, scratch.data(), histograms.B_frame);
    std::swap(low, high);
  }
}

}  // namespace

PixelCounts count_pixels(const PixelBlock& block, std::span<const double> thresholds) {
  const RankTable table = make_rank_table(thresholds);
  Histograms histograms(thresholds.size());
  PixelCounts counts;
  if (block.rows > 0) {
    check_block(block);
    with_rank_type(table,
                   [&](auto zero) { fill_histograms<decltype(zero)>(block, table, histograms); });
    const std::size_t owned =
        static_cast<std::size_t>(block.rows) * static_cast<std::size_t>(block.width);
    for (std::size_t i = 0; i < owned; ++i) counts.pixels += block.solid[i] != 0 ? 1 : 0;
  }
  counts.F = white_counts(histograms.F);
  counts.E = white_counts(histograms.E);
  counts.V = white_counts(histograms.V);
  counts.V4 = white_counts(histograms.V4);
  counts.D = white_counts(histograms.D);
  counts.B_void = white_counts(histograms.B_void);
  counts.B_frame = white_counts(histograms.B_frame);
  counts.B_int.resize(thresholds.size());
  for (std::size_t j = 0; j < thresholds.size(); ++j) {
    counts.B_int[j] = 2 * counts.E[j] - 4 * counts.F[j] - counts.B_void[j] - counts.B_frame[j];
  }
  return counts;
}

}  // namespace poreshock
