#include "poreshock/morphology/minkowski.hpp"

#include <algorithm>
#include <bit>
#include <cstring>
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
  std::vector<std::uint64_t> voids;  ///< bit i % 64 of word i / 64: pixel i of the row is void
  bool outside = true;

  explicit Row(std::size_t width)
      : ranks(width + 2, Rank{0}), mask(width + 2, 1), voids((width + 2 + 63) / 64, 0) {}
};

struct Histograms {
  Histogram F, Ex, Ey, V, V4, D, Bx_void, By_void, D_void, Bx_frame, By_frame, D_frame;

  explicit Histograms(std::size_t thresholds)
      : F(thresholds),
        Ex(thresholds),
        Ey(thresholds),
        V(thresholds),
        V4(thresholds),
        D(thresholds),
        Bx_void(thresholds),
        By_void(thresholds),
        D_void(thresholds),
        Bx_frame(thresholds),
        By_frame(thresholds),
        D_frame(thresholds) {}
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

/// Sets the bits of the void pixels of the row itself, those at its two ends left out.
template <class Rank>
void mark_voids(Row<Rank>& row) {
  const std::size_t last = row.mask.size() - 2;
  for (std::size_t w = 0; w < row.voids.size(); ++w) {
    std::uint8_t solid[64];
    std::memset(solid, 1, sizeof(solid));
    const std::size_t first = std::max<std::size_t>(64 * w, 1);
    const std::size_t end = std::min(64 * w + 64, last + 1);
    if (first < end) std::memcpy(solid + first - 64 * w, &row.mask[first], end - first);
    std::uint64_t bits = 0;
    for (std::size_t k = 0; k < 8; ++k) {
      std::uint64_t eight = 0;
      std::memcpy(&eight, solid + 8 * k, sizeof(eight));
      // Each byte is 0 or 1; the product moves the lowest bit of byte i to bit 56 + i.
      bits |= (((eight ^ 0x0101010101010101U) * 0x0102040810204080U) >> 56) << (8 * k);
    }
    row.voids[w] = bits;
  }
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
  mark_voids(result);
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
  // By value: std::max returns one of two addresses, which does not vectorise.
  const auto most = [](Rank p, Rank q) { return p < q ? q : p; };
  const auto least = [](Rank p, Rank q) { return q < p ? q : p; };
  add([=](std::size_t i) { return a[i]; }, histograms.F);
  add([=](std::size_t i) { return most(a[i], a[i + 1]); }, histograms.Ex);
  add([=](std::size_t i) { return most(a[i], b[i]); }, histograms.Ey);
  add([=](std::size_t i) { return most(most(a[i], a[i + 1]), most(b[i], b[i + 1])); },
      histograms.V);
  add([=](std::size_t i) { return least(least(a[i], a[i + 1]), least(b[i], b[i + 1])); },
      histograms.V4);
  add([=](std::size_t i) { return most(a[i], b[i + 1]); }, histograms.D);
  add([=](std::size_t i) { return most(a[i + 1], b[i]); }, histograms.D);
}

/// Adds the edges and diagonals between material and void that the row `low` owns, seen from the
/// void pixels: what lies across has its rank, and rank 0 where it is void too, which counts as
/// nothing.
template <class Rank>
void add_void_edges(const Row<Rank>& low, const Row<Rank>& high, Histograms& histograms) {
  const Rank* a = low.ranks.data();
  const Rank* b = high.ranks.data();
  for (std::size_t w = 0; w < low.voids.size(); ++w) {
    // Pixels with nothing but void around have no such edges.
    std::uint64_t inside = low.voids[w] & high.voids[w];
    inside &= (inside << 1) & (inside >> 1);
    for (std::uint64_t left = low.voids[w] & ~inside; left != 0; left &= left - 1) {
      const std::size_t i = 64 * w + static_cast<std::size_t>(std::countr_zero(left));
      add_rank(a[i - 1], histograms.Bx_void);
      add_rank(a[i + 1], histograms.Bx_void);
      add_rank(b[i], histograms.By_void);
      add_rank(b[i - 1], histograms.D_void);
      add_rank(b[i + 1], histograms.D_void);
    }
    for (std::uint64_t left = high.voids[w] & ~inside; left != 0; left &= left - 1) {
      const std::size_t i = 64 * w + static_cast<std::size_t>(std::countr_zero(left));
      add_rank(a[i], histograms.By_void);
      add_rank(a[i - 1], histograms.D_void);
      add_rank(a[i + 1], histograms.D_void);
    }
  }
}

/// Adds the frame edges and diagonals that the row `low` owns; one of two neighbours outside has
/// rank 0.
template <class Rank>
void add_frame_edges(const Row<Rank>& low, const Row<Rank>& high, bool periodic, Rank* scratch,
                     Histograms& histograms) {
  const Rank* a = low.ranks.data();
  const Rank* b = high.ranks.data();
  const std::size_t width = low.ranks.size() - 2;
  if (!periodic && !low.outside) {
    add_rank(a[1], histograms.Bx_frame);
    add_rank(a[width], histograms.Bx_frame);
  }
  if (low.outside || high.outside) {
    const auto add = [&](std::size_t begin, auto combine, Histogram& histogram) {
      add_combined(begin, width + 1, combine, scratch, histogram);
    };
    const std::size_t begin = periodic ? 1 : 0;
    add(
        1, [=](std::size_t i) { return std::max(a[i], b[i]); }, histograms.By_frame);
    add(
        begin, [=](std::size_t i) { return std::max(a[i], b[i + 1]); }, histograms.D_frame);
    add(
        begin, [=](std::size_t i) { return std::max(a[i + 1], b[i]); }, histograms.D_frame);
  } else if (!periodic) {
    for (const Rank rank : {a[1], b[1], a[width], b[width]}) add_rank(rank, histograms.D_frame);
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
    add_void_edges(low, high, histograms);
    add_frame_edges(low, high, block.periodic, scratch.data(), histograms);
    std::swap(low, high);
  }
}

/// Adds b to a, element by element.
std::vector<std::int64_t> sum_of(std::vector<std::int64_t> a, const std::vector<std::int64_t>& b) {
  for (std::size_t j = 0; j < a.size(); ++j) a[j] += b[j];
  return a;
}

/// The counts that follow from the histograms. A row of K white pixels has 2 K ends along each axis
/// and diagonal, so that 2 E - 2 F edges across an axis, or 2 D - 4 F diagonals, are boundary.
void take_counts(const Histograms& h, PixelCounts& counts) {
  const auto Ex = white_counts(h.Ex), Ey = white_counts(h.Ey);
  const auto Bx_void = white_counts(h.Bx_void), By_void = white_counts(h.By_void);
  const auto Bx_frame = white_counts(h.Bx_frame), By_frame = white_counts(h.By_frame);
  const auto D_void = white_counts(h.D_void), D_frame = white_counts(h.D_frame);
  counts.F = white_counts(h.F);
  counts.E = sum_of(Ex, Ey);
  counts.V = white_counts(h.V);
  counts.V4 = white_counts(h.V4);
  counts.D = white_counts(h.D);
  counts.B_void = sum_of(Bx_void, By_void);
  counts.B_frame = sum_of(Bx_frame, By_frame);
  const std::size_t thresholds = counts.F.size();
  counts.B_int.resize(thresholds);
  counts.B_axial.resize(thresholds);
  counts.D_int.resize(thresholds);
  for (std::size_t j = 0; j < thresholds; ++j) {
    const std::int64_t F = counts.F[j];
    counts.B_int[j] = 2 * counts.E[j] - 4 * F - counts.B_void[j] - counts.B_frame[j];
    counts.B_axial[j] = 2 * Ey[j] - 2 * F - By_void[j] - By_frame[j];
    counts.D_int[j] = 2 * counts.D[j] - 4 * F - D_void[j] - D_frame[j];
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
    counts.pixels = material_in(block.solid.first(owned));
  }
  take_counts(histograms, counts);
  return counts;
}

}  // namespace poreshock
