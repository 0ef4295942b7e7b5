#include <array>
#include <limits>

#include "histogram.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/morphology/analysis.hpp"
#include "poreshock/morphology/voids.hpp"
#include "ranks.hpp"
#include "slab.hpp"

namespace poreshock {
namespace {

std::vector<double> share(std::span<const std::int64_t> counts, double of) {
  std::vector<double> result;
  for (const std::int64_t count : counts) {
    result.push_back(of > 0.0 ? static_cast<double>(count) / of : 0.0);
  }
  return result;
}

/// Euler characteristics of a map whose voids have a value or are black, per pixel of `material`.
template <int Dim>
EulerDensity topological(const PixelField<Dim>& map, std::size_t field,
                         std::span<const double> thresholds, std::int64_t material,
                         MPI_Comm communicator) {
  MapCounts<Dim> counts = count<Dim>(map, field, thresholds, communicator);
  if (material == 0) counts.pixels = 0;
  const double scale = static_cast<double>(counts.pixels) / static_cast<double>(material);
  const MapFunctionals<Dim> per_pixel = functionals(counts);
  EulerDensity result;
  result.corners = per_pixel.chi;
  if constexpr (Dim == 2) {
    result.faces = per_pixel.chi4;
  } else {
    result.faces = per_pixel.chi6;
  }
  for (double& value : result.corners) value *= counts.pixels > 0 ? scale : 0.0;
  for (double& value : result.faces) value *= counts.pixels > 0 ? scale : 0.0;
  return result;
}

/// Cells that span two pixels along the axes of one subset, all of whose pixels are material.
struct InnerCells {
  std::int64_t cells = 0;
  Histogram most, least;  ///< of the largest and the smallest rank of their pixels

  explicit InnerCells(std::size_t thresholds) : most(thresholds), least(thresholds) {}
};

/// A slab with the ranks of its stored pixels.
struct RankedSlab {
  Slab slab;
  std::vector<std::uint32_t> ranks;
  std::span<const std::uint8_t> solid;

  /// Index of a pixel after wrapping; the largest number outside the map.
  std::size_t index(int x, int y, int z) const {
    if (x >= slab.nx && slab.periodic_x) x -= slab.nx;
    if (y >= slab.ny && slab.periodic_y) y -= slab.ny;
    if (x >= slab.nx || y >= slab.ny || z >= slab.stored) {
      return std::numeric_limits<std::size_t>::max();
    }
    return (static_cast<std::size_t>(z) * static_cast<std::size_t>(slab.ny) +
            static_cast<std::size_t>(y)) *
               static_cast<std::size_t>(slab.nx) +
           static_cast<std::size_t>(x);
  }
};

/// Adds the cell with its low corner at a pixel and this extent (0 or 1 along each axis).
void add_cell(const RankedSlab& ranked, const std::array<int, 3>& at,
              const std::array<int, 3>& extent, InnerCells& cells) {
  std::uint32_t most = 0;
  std::uint32_t least = std::numeric_limits<std::uint32_t>::max();
  for (int z = 0; z <= extent[2]; ++z) {
    for (int y = 0; y <= extent[1]; ++y) {
      for (int x = 0; x <= extent[0]; ++x) {
        const std::size_t i = ranked.index(at[0] + x, at[1] + y, at[2] + z);
        if (i >= ranked.ranks.size() || ranked.solid[i] == 0) return;
        most = std::max(most, ranked.ranks[i]);
        least = std::min(least, ranked.ranks[i]);
      }
    }
  }
  ++cells.cells;
  add_rank(most, cells.most);
  add_rank(least, cells.least);
}

InnerCells count_cells(const RankedSlab& ranked, const std::array<int, 3>& extent,
                       std::size_t thresholds) {
  InnerCells cells(thresholds);
  for (int z = 0; z < ranked.slab.layers; ++z) {
    for (int y = 0; y < ranked.slab.ny; ++y) {
      for (int x = 0; x < ranked.slab.nx; ++x) add_cell(ranked, {x, y, z}, extent, cells);
    }
  }
  return cells;
}

/// Adds sign x share to a density.
void add_share(const std::vector<double>& shares, int sign, std::vector<double>& density) {
  density.resize(shares.size(), 0.0);
  for (std::size_t j = 0; j < shares.size(); ++j) density[j] += sign * shares[j];
}

/// A white closed pixel has cells of Dim - |extent| dimensions; the Euler characteristic is their
/// alternating sum, of open pixels that over the extents themselves.
template <int Dim>
EulerDensity inside_material(const PixelField<Dim>& map, std::size_t field,
                             std::span<const double> thresholds, MPI_Comm communicator) {
  const RankTable table = make_rank_table(thresholds);
  RankedSlab ranked{slab_of(map), {}, {}};
  const std::size_t stored = ranked.slab.stored_size();
  ranked.solid = std::span<const std::uint8_t>(map.solid).first(stored);
  ranked.ranks.resize(stored);
  rank_row(table, std::span<const double>(map.values.at(field)).first(stored), ranked.solid,
           ranked.ranks.data());
  EulerDensity result;
  for (int kind = 0; kind < (1 << Dim); ++kind) {
    const bool deep = (kind & 1) != 0;
    std::array<int, 3> extent = {(kind >> 1) & 1, Dim == 3 ? (kind >> 2) & 1 : 0, deep ? 1 : 0};
    const InnerCells cells = count_cells(ranked, extent, thresholds.size());
    std::vector<std::int64_t> packed = white_counts(cells.most);
    const std::vector<std::int64_t> least = white_counts(cells.least);
    packed.insert(packed.end(), least.begin(), least.end());
    packed.push_back(cells.cells);
    sum(packed, communicator);
    const auto of = static_cast<double>(packed.back());
    const std::span<const std::int64_t> all(packed);
    const int spanned = extent[0] + extent[1] + extent[2];
    add_share(share(all.first(least.size()), of), (Dim - spanned) % 2 == 0 ? 1 : -1,
              result.corners);
    add_share(share(all.subspan(least.size(), least.size()), of), spanned % 2 == 0 ? 1 : -1,
              result.faces);
  }
  return result;
}

}  // namespace

template <int Dim>
EulerDensity euler_density(const PixelField<Dim>& map, std::size_t field,
                           std::span<const double> thresholds, Voids voids, MPI_Comm communicator) {
  if (voids == Voids::exclude) return inside_material(map, field, thresholds, communicator);
  const Slab slab = slab_of(map);
  const std::size_t owned = slab.layer_size() * static_cast<std::size_t>(slab.layers);
  const std::int64_t material =
      sum(material_in(std::span<const std::uint8_t>(map.solid).first(owned)), communicator);
  if (voids == Voids::black) return topological(map, field, thresholds, material, communicator);
  if (voids == Voids::fill) {
    return topological(fill_voids(map, field, communicator), field, thresholds, material,
                       communicator);
  }
  PixelField<Dim> white = map;
  for (std::size_t i = 0; i < slab.stored_size(); ++i) {
    if (white.solid[i] == 0) white.values[field][i] = std::numeric_limits<double>::infinity();
    white.solid[i] = 1;
  }
  return topological(white, field, thresholds, material, communicator);
}

template EulerDensity euler_density<2>(const PixelField<2>&, std::size_t, std::span<const double>,
                                       Voids, MPI_Comm);
template EulerDensity euler_density<3>(const PixelField<3>&, std::size_t, std::span<const double>,
                                       Voids, MPI_Comm);

}  // namespace poreshock
