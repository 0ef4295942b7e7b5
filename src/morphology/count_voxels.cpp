#include <algorithm>
#include <string>
#include <utility>

#include "histogram.hpp"
#include "poreshock/core/error.hpp"
#include "poreshock/morphology/minkowski.hpp"
#include "ranks.hpp"

namespace poreshock {
namespace {

/// Ranks and mask of a voxel layer with one voxel more on each side. A voxel outside the map has
/// rank 0 and counts as material, so that no frame face is taken for a void face.
template <class Rank>
struct Layer {
  std::size_t width;   ///< voxels along x
  std::size_t height;  ///< voxels along y
  std::vector<Rank> ranks;
  std::vector<std::uint8_t> mask;
  bool outside = true;
  bool has_void = false;

  Layer(std::size_t x, std::size_t y)
      : width(x), height(y), ranks((x + 2) * (y + 2), Rank{0}), mask((x + 2) * (y + 2), 1) {}

  std::size_t row(std::size_t j) const { return j * (width + 2); }
};

/// Faces across the shock axis, Fz, Sz, are apart from the other ones.
struct Histograms {
  Histogram C, F, Fz, E, V, E4, V8, S_void, Sz_void, S_frame, Sz_frame;

  explicit Histograms(std::size_t thresholds)
      : C(thresholds),
        F(thresholds),
        Fz(thresholds),
        E(thresholds),
        V(thresholds),
        E4(thresholds),
        V8(thresholds),
        S_void(thresholds),
        Sz_void(thresholds),
        S_frame(thresholds),
        Sz_frame(thresholds) {}
};

void check_block(const VoxelBlock& block) {
  const std::int64_t needed =
      (std::int64_t{block.layers} + 1) * block.width[1] * std::int64_t{block.width[0]};
  const auto values = static_cast<std::int64_t>(block.values.size());
  const auto solid = static_cast<std::int64_t>(block.solid.size());
  if (block.width[0] > 0 && block.width[1] > 0 && values == needed && solid == needed) return;
  throw InputError("a voxel block of " + std::to_string(block.layers) + " layers of " +
                   std::to_string(block.width[0]) + " x " + std::to_string(block.width[1]) +
                   " voxels needs " + std::to_string(needed) +
                   " values and mask entries, one layer more than it owns, and at least one voxel "
                   "a layer; it has " +
                   std::to_string(values) + " values and " + std::to_string(solid) +
                   " mask entries.");
}

template <class Rank>
void copy_row(std::size_t from, std::size_t to, Layer<Rank>& layer) {
  const std::size_t length = layer.width + 2;
  std::copy_n(layer.ranks.begin() + static_cast<std::ptrdiff_t>(layer.row(from)), length,
              layer.ranks.begin() + static_cast<std::ptrdiff_t>(layer.row(to)));
  std::copy_n(layer.mask.begin() + static_cast<std::ptrdiff_t>(layer.row(from)), length,
              layer.mask.begin() + static_cast<std::ptrdiff_t>(layer.row(to)));
}

template <class Rank>
void read_layer(const VoxelBlock& block, const RankTable& table, int number, Layer<Rank>& layer) {
  layer.outside = block.last && number == block.layers;
  // Also clears the rows outside the map along y.
  std::fill(layer.ranks.begin(), layer.ranks.end(), Rank{0});
  std::fill(layer.mask.begin(), layer.mask.end(), std::uint8_t{1});
  if (!layer.outside) {
    const std::size_t start = static_cast<std::size_t>(number) * layer.height * layer.width;
    for (std::size_t j = 0; j < layer.height; ++j) {
      const std::size_t at = start + j * layer.width;
      padded_row(table, block.values.subspan(at, layer.width), block.solid.subspan(at, layer.width),
                 block.periodic[0], layer.ranks.data() + layer.row(j + 1),
                 layer.mask.data() + layer.row(j + 1));
    }
    if (block.periodic[1]) {
      copy_row(layer.height, 0, layer);
      copy_row(1, layer.height + 1, layer);
    }
  }
  layer.has_void = has_void(layer.mask);
}

/// Adds the cells owned by row j of the layer `low`: those on the high side of each voxel.
template <class Rank>
void add_row(const Layer<Rank>& low, const Layer<Rank>& high, std::size_t j, bool periodic,
             Rank* scratch, Histograms& histograms) {
  const Rank* a = low.ranks.data() + low.row(j);
  const Rank* b = low.ranks.data() + low.row(j + 1);
  const Rank* c = high.ranks.data() + high.row(j);
  const Rank* d = high.ranks.data() + high.row(j + 1);
  const auto add = [&](auto combine, Histogram& histogram) {
    add_combined(periodic ? 1 : 0, low.width + 1, combine, scratch, histogram);
  };
  // By value: std::max returns one of two addresses, which does not vectorise.
  const auto most = [](Rank p, Rank q) { return p < q ? q : p; };
  const auto least = [](Rank p, Rank q) { return q < p ? q : p; };
  const auto max4 = [=](Rank p, Rank q, Rank r, Rank s) { return most(most(p, q), most(r, s)); };
  const auto min4 = [=](Rank p, Rank q, Rank r, Rank s) { return least(least(p, q), least(r, s)); };
  add([=](std::size_t i) { return a[i]; }, histograms.C);
  add([=](std::size_t i) { return most(a[i], a[i + 1]); }, histograms.F);
  add([=](std::size_t i) { return most(a[i], b[i]); }, histograms.F);
  add([=](std::size_t i) { return most(a[i], c[i]); }, histograms.Fz);
  const auto add_edges = [&](auto four, Histogram& histogram) {
    add([=](std::size_t i) { return four(a[i], b[i], c[i], d[i]); }, histogram);
    add([=](std::size_t i) { return four(a[i], a[i + 1], c[i], c[i + 1]); }, histogram);
    add([=](std::size_t i) { return four(a[i], a[i + 1], b[i], b[i + 1]); }, histogram);
  };
  add_edges(max4, histograms.E);
  add_edges(min4, histograms.E4);
  add(
      [=](std::size_t i) {
        return most(max4(a[i], b[i], c[i], d[i]), max4(a[i + 1], b[i + 1], c[i + 1], d[i + 1]));
      },
      histograms.V);
  add(
      [=](std::size_t i) {
        return least(min4(a[i], b[i], c[i], d[i]), min4(a[i + 1], b[i + 1], c[i + 1], d[i + 1]));
      },
      histograms.V8);
}

/// Adds the faces between material and void that row j of the layer `low` owns.
template <class Rank>
void add_void_faces(const Layer<Rank>& low, const Layer<Rank>& high, std::size_t j,
                    Histograms& histograms) {
  Histogram& histogram = histograms.S_void;
  if (!low.has_void && !high.has_void) return;
  const std::size_t a = low.row(j);
  const std::size_t b = low.row(j + 1);
  for (std::size_t i = 1; i <= low.width; ++i) {
    const Rank rank = low.ranks[a + i];
    const std::uint8_t mask = low.mask[a + i];
    if ((mask & low.mask[a + i + 1]) == 0) {
      add_rank(std::max(rank, low.ranks[a + i + 1]), histogram);
    }
    if ((mask & low.mask[b + i]) == 0) add_rank(std::max(rank, low.ranks[b + i]), histogram);
    if ((mask & high.mask[a + i]) == 0) {
      add_rank(std::max(rank, high.ranks[a + i]), histograms.Sz_void);
    }
  }
}

/// Adds the frame faces that row j of the layer `low` owns, and both frame faces along x and y.
template <class Rank>
void add_frame_faces(const Layer<Rank>& low, const Layer<Rank>& high, std::size_t j,
                     const std::array<bool, 2>& periodic, Histograms& histograms) {
  Histogram& histogram = histograms.S_frame;
  const std::size_t a = low.row(j);
  if (!low.outside) {
    if (!periodic[0]) {
      add_rank(low.ranks[a + 1], histogram);
      add_rank(low.ranks[a + low.width], histogram);
    }
    const int sides = periodic[1] ? 0 : (j == 1 ? 1 : 0) + (j == low.height ? 1 : 0);
    for (int side = 0; side < sides; ++side) {
      add_ranks(low.ranks.data() + a + 1, low.width, histogram);
    }
  }
  // One of the two is outside and has rank 0.
  if (low.outside) add_ranks(high.ranks.data() + a + 1, low.width, histograms.Sz_frame);
  if (high.outside) add_ranks(low.ranks.data() + a + 1, low.width, histograms.Sz_frame);
}

template <class Rank>
void fill_histograms(const VoxelBlock& block, const RankTable& table, Histograms& histograms) {
  const auto width = static_cast<std::size_t>(block.width[0]);
  const auto height = static_cast<std::size_t>(block.width[1]);
  std::vector<Rank> scratch(width + 2);
  Layer<Rank> low(width, height);
  Layer<Rank> high(width, height);
  for (int number = block.first ? -1 : 0; number < block.layers; ++number) {
    if (number == 0 && !block.first) read_layer(block, table, 0, low);
    read_layer(block, table, number + 1, high);
    for (std::size_t j = block.periodic[1] ? 1 : 0; j <= height; ++j) {
      add_row(low, high, j, block.periodic[0], scratch.data(), histograms);
      if (j == 0) continue;  // the row outside owns no face between two voxels of the map
      add_void_faces(low, high, j, histograms);
      add_frame_faces(low, high, j, block.periodic, histograms);
    }
    std::swap(low, high);
  }
}

/// The counts that follow from the histograms.
void take_counts(const Histograms& h, VoxelCounts& counts) {
  const auto Fz = white_counts(h.Fz), Sz_void = white_counts(h.Sz_void);
  const auto Sz_frame = white_counts(h.Sz_frame);
  counts.C = white_counts(h.C);
  counts.F = white_counts(h.F);
  counts.E = white_counts(h.E);
  counts.V = white_counts(h.V);
  counts.E4 = white_counts(h.E4);
  counts.V8 = white_counts(h.V8);
  counts.S_void = white_counts(h.S_void);
  counts.S_frame = white_counts(h.S_frame);
  counts.S_int.resize(counts.C.size());
  counts.S_axial.resize(counts.C.size());
  for (std::size_t j = 0; j < counts.C.size(); ++j) {
    counts.F[j] += Fz[j];
    counts.S_void[j] += Sz_void[j];
    counts.S_frame[j] += Sz_frame[j];
    counts.S_int[j] = 2 * counts.F[j] - 6 * counts.C[j] - counts.S_void[j] - counts.S_frame[j];
    counts.S_axial[j] = 2 * Fz[j] - 2 * counts.C[j] - Sz_void[j] - Sz_frame[j];
  }
}

}  // namespace

VoxelCounts count_voxels(const VoxelBlock& block, std::span<const double> thresholds) {
  const RankTable table = make_rank_table(thresholds);
  Histograms histograms(thresholds.size());
  VoxelCounts counts;
  if (block.layers > 0) {
    check_block(block);
    with_rank_type(table,
                   [&](auto zero) { fill_histograms<decltype(zero)>(block, table, histograms); });
    const std::size_t layer =
        static_cast<std::size_t>(block.width[0]) * static_cast<std::size_t>(block.width[1]);
    const std::size_t owned = static_cast<std::size_t>(block.layers) * layer;
    counts.pixels = material_in(block.solid.first(owned));
  }
  take_counts(histograms, counts);
  return counts;
}

}  // namespace poreshock
