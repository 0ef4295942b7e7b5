#include "image_sites.hpp"

#include <algorithm>
#include <cmath>

#include "poreshock/core/parallel.hpp"
#include "random.hpp"

namespace poreshock {
namespace {

/// One axis of the image beside that of the lattice.
struct Axis {
  double ratio = 1.0;  ///< edge of a site in voxels
  std::int64_t voxels = 1, sites = 1;

  /// Voxels that sites [first, last) may touch.
  LatticeRange voxels_of(std::int64_t first, std::int64_t last) const {
    const double low = std::floor(static_cast<double>(first) * ratio);
    const double high = std::ceil(static_cast<double>(last) * ratio);
    return {std::clamp(static_cast<std::int64_t>(low), std::int64_t{0}, voxels),
            std::clamp(static_cast<std::int64_t>(high), std::int64_t{0}, voxels)};
  }
  /// Sites that voxels [first, last) may touch.
  LatticeRange sites_of(std::int64_t first, std::int64_t last) const {
    const double low = std::floor(static_cast<double>(first) / ratio) - 1.0;
    const double high = std::ceil(static_cast<double>(last) / ratio) + 1.0;
    return {std::max(static_cast<std::int64_t>(low), std::int64_t{0}),
            std::min(static_cast<std::int64_t>(high), sites)};
  }
  /// Share of a site in voxels [first, last), in 1/1024; shares of all voxels add up exactly.
  std::int64_t share(std::int64_t site, std::int64_t first, std::int64_t last) const {
    const auto below = [&](std::int64_t voxel) {
      const double reached = static_cast<double>(voxel) / ratio - static_cast<double>(site);
      return std::llround(1024.0 * std::clamp(reached, 0.0, 1.0));
    };
    return below(last) - below(first);
  }
};

/// How much of a site is solid, in units that add up exactly, and the region that has most of it.
struct Covered {
  std::uint32_t solid = 0;
  std::int32_t region = 0;
};

/// What a run gives to a site.
struct Contribution {
  std::int32_t site = 0;
  std::int32_t region = 0;
  std::int64_t solid = 0;

  bool operator<(const Contribution& other) const {
    return site != other.site ? site < other.site : region < other.region;
  }
};

/// Adds up what a row of sites is given, in any order.
void add_up(std::vector<Contribution>& given, Covered* row) {
  if (!std::is_sorted(given.begin(), given.end())) std::sort(given.begin(), given.end());
  std::int64_t most = 0;
  for (std::size_t i = 0; i < given.size();) {
    Covered& covered = row[given[i].site];
    if (i == 0 || given[i].site != given[i - 1].site) most = 0;
    std::int64_t of_region = 0;
    std::size_t j = i;
    while (j < given.size() && !(given[i] < given[j])) of_region += given[j++].solid;
    covered.solid += static_cast<std::uint32_t>(of_region);
    if (of_region > most) {
      most = of_region;
      covered.region = given[i].region;
    }
    i = j;
  }
}

/// Covers the sites of the rank's share from the voxels around them.
class Cover {
 public:
  Cover(const Lattice& lattice, const SolidVoxels& voxels) : lattice_(lattice) {
    for (int axis = 0; axis < lattice.dimension; ++axis) {
      axes_[static_cast<std::size_t>(axis)] = {lattice.spacing / voxels.edge,
                                               voxels.size[static_cast<std::size_t>(axis)],
                                               lattice.sites[axis]};
    }
  }

  const Axis& shock() const { return axes_[static_cast<std::size_t>(lattice_.shock_axis())]; }

  /// The sites of layers `range` from the runs of the voxel layers `layers`.
  std::vector<Covered> sites(LatticeRange range, LatticeRange layers, const Runs& runs) const {
    const std::int64_t row_length = lattice_.sites[0];
    const std::int64_t rows = lattice_.layer_size() / row_length;
    std::vector<Covered> result(
        static_cast<std::size_t>((range.last - range.first) * lattice_.layer_size()));
    std::vector<Contribution> given;
    for (std::int64_t k = range.first; k < range.last; ++k) {
      for (std::int64_t j = 0; j < rows; ++j) {
        given.clear();
        give_row(k, j, layers, runs, given);
        add_up(given,
               &result[static_cast<std::size_t>(((k - range.first) * rows + j) * row_length)]);
      }
    }
    return result;
  }

 private:
  /// What all runs give to the sites of row j of layer k.
  void give_row(std::int64_t k, std::int64_t j, LatticeRange layers, const Runs& runs,
                std::vector<Contribution>& given) const {
    const bool deep = lattice_.dimension == 3;
    const Axis& depth = axes_[1];
    const std::int64_t rows_per_layer = deep ? depth.voxels : 1;
    const LatticeRange around = shock().voxels_of(k, k + 1);
    const LatticeRange beside = deep ? depth.voxels_of(j, j + 1) : LatticeRange{0, 1};
    for (std::int64_t z = around.first; z < around.last; ++z) {
      const std::int64_t height = shock().share(k, z, z + 1);
      for (std::int64_t y = beside.first; y < beside.last; ++y) {
        const std::int64_t weight = height * (deep ? depth.share(j, y, y + 1) : 1);
        const auto row = static_cast<std::size_t>((z - layers.first) * rows_per_layer + y);
        for (std::size_t r = runs.row_start[row]; weight > 0 && r < runs.row_start[row + 1]; ++r) {
          give_run(runs.runs[r], weight, given);
        }
      }
    }
  }

  void give_run(const Run& run, std::int64_t weight, std::vector<Contribution>& given) const {
    const LatticeRange along = axes_[0].sites_of(run.begin, run.end);
    for (std::int64_t i = along.first; i < along.last; ++i) {
      const std::int64_t share = axes_[0].share(i, run.begin, run.end);
      if (share > 0) given.push_back({static_cast<std::int32_t>(i), run.region, share * weight});
    }
  }

  const Lattice& lattice_;
  std::array<Axis, 3> axes_;
};

/// The largest keys of all ranks end at `level`, of which `at_level` are among them.
struct Selection {
  std::int64_t level = 0, at_level = 0;
};

/// Finds the `wanted` largest of all ranks' keys, key(0) ... key(count - 1), from 0 to 2^33 - 1, by
/// histograms of 11 bits at a time; level 0 when there are not as many. Collective.
template <class Key>
Selection select_largest(std::size_t count, Key&& key, std::int64_t wanted, MPI_Comm communicator) {
  constexpr int bits = 11;
  Selection found{0, wanted};
  for (int shift = 2 * bits; shift >= 0; shift -= bits) {
    std::vector<std::int64_t> histogram(std::size_t{1} << bits, 0);
    for (std::size_t i = 0; i < count; ++i) {
      const std::int64_t digits = key(i) >> shift;
      if (digits >> bits == found.level) {
        ++histogram[static_cast<std::size_t>(digits & ((1 << bits) - 1))];
      }
    }
    sum(histogram, communicator);
    std::size_t bucket = histogram.size() - 1;
    while (bucket > 0 && histogram[bucket] < found.at_level) found.at_level -= histogram[bucket--];
    found.level = (found.level << bits) + static_cast<std::int64_t>(bucket);
  }
  return found;
}

/// Number of a site in a random order.
std::int64_t place_in_order(std::int64_t site) {
  const double u = uniforms(0, RandomStream::sites, static_cast<std::uint64_t>(site), 0)[0];
  return static_cast<std::int64_t>(u * 0x1p32);
}

/// Marks the `wanted` sites of all ranks that are covered most, and empties the others. Collective.
void keep_most_covered(std::int64_t first_site, std::int64_t wanted, MPI_Comm communicator,
                       std::vector<Covered>& sites) {
  const auto covered = [&](std::size_t i) { return std::int64_t{sites[i].solid}; };
  const Selection most = select_largest(sites.size(), covered, wanted, communicator);
  std::vector<std::pair<std::int64_t, std::size_t>> tied;
  for (std::size_t i = 0; i < sites.size(); ++i) {
    if (covered(i) != most.level || covered(i) == 0) continue;
    tied.emplace_back(place_in_order(first_site + static_cast<std::int64_t>(i)), i);
  }
  const Selection last = select_largest(
      tied.size(), [&](std::size_t i) { return tied[i].first; }, most.at_level, communicator);
  for (Covered& c : sites) c.solid = c.solid > most.level ? 1 : 0;
  for (const auto& [place, i] : tied) sites[i].solid = place >= last.level ? 1 : 0;
}

/// Kept sites as runs of one region each.
Runs runs_of(const std::vector<Covered>& sites, std::int64_t row_length) {
  constexpr std::int32_t empty = -1;
  std::vector<std::int32_t> regions;
  regions.reserve(sites.size());
  for (const Covered& c : sites) regions.push_back(c.solid > 0 ? c.region : empty);
  Runs runs;
  append_runs(
      regions, row_length, [](std::int32_t region) { return region != empty; }, runs);
  for (Run& run : runs.runs) run.region = static_cast<std::int32_t>(run.label);
  return runs;
}

}  // namespace

Runs solid_sites(const Lattice& lattice, const SolidVoxels& voxels, LatticeRange wanted,
                 MPI_Comm communicator) {
  const Cover cover(lattice, voxels);
  const LatticeRange share = own_layers(lattice.sample_layers, communicator);
  LatticeRange around{0, 0};
  if (share.first < share.last) around = cover.shock().voxels_of(share.first, share.last);
  const Runs runs = fetch_layers(row_order(voxels.size, lattice.dimension, {}), voxels.runs,
                                 voxels.layers, around, communicator);
  std::vector<Covered> sites = cover.sites(share, around, runs);
  double solid = static_cast<double>(voxels.solid);
  for (int axis = 0; axis < lattice.dimension; ++axis) solid *= voxels.edge / lattice.spacing;
  const std::int64_t all = lattice.sample_layers * lattice.layer_size();
  keep_most_covered(share.first * lattice.layer_size(),
                    std::min<std::int64_t>(all, std::llround(solid)), communicator, sites);
  return fetch_layers(row_order(lattice.sites, lattice.dimension, {}),
                      runs_of(sites, lattice.sites[0]), share, wanted, communicator);
}

}  // namespace poreshock
