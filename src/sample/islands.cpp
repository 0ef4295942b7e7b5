#include "islands.hpp"

#include <algorithm>

namespace poreshock {
namespace {

/// Runs of the sample's layers in `range`.
Runs runs_in(const Scene& scene, const std::vector<Void>& voids, const Lattice& lattice,
             LatticeRange range) {
  Runs runs;
  // A few million sites at a time keep the memory small.
  const std::int64_t slab =
      std::max(std::int64_t{1}, (std::int64_t{1} << 22) / lattice.layer_size());
  for (std::int64_t first = range.first; first < range.last; first += slab) {
    const LatticeRange some{first, std::min(first + slab, range.last)};
    std::vector<std::int32_t> owners = sample_owners(scene, voids, some);
    for (const Region& region : scene.voids) {
      give_region(lattice, some, region, owner_none, {}, owners);
    }
    append_runs(
        owners, lattice.sites[0], [](std::int32_t owner) { return owner != owner_none; }, runs);
  }
  return runs;
}

}  // namespace

std::vector<Grain> grains_of_islands(const Scene& scene, const Lattice& lattice,
                                     const IslandPieces& islands) {
  double volume = 1.0;
  for (int axis = 0; axis < lattice.dimension; ++axis) volume *= lattice.spacing;
  std::vector<Grain> grains;
  for (std::size_t p = 0; p < islands.pieces.size(); ++p) {
    if (static_cast<std::int32_t>(p) == islands.largest) continue;
    const double measure = static_cast<double>(islands.pieces[p].cells) * volume;
    grains.push_back({.center = {}, .measure = measure, .material = scene.sample.material});
  }
  return grains;
}

IslandPieces find_islands(const Scene& scene, const std::vector<Void>& voids, LatticeRange range,
                          MPI_Comm communicator) {
  const Lattice lattice = make_lattice(scene);
  const RowOrder order = row_order(lattice.sites, lattice.dimension, scene.domain.periodic);
  const LatticeRange own = own_layers(lattice.sample_layers, communicator);
  Runs runs = runs_in(scene, voids, lattice, own);
  IslandPieces result;
  result.pieces = find_regions(order, own.first, communicator, runs);
  result.runs = fetch_layers(order, runs, own, range, communicator);
  const auto fewer = [](const ConnectedRegion& a, const ConnectedRegion& b) {
    return a.cells < b.cells;
  };
  const auto largest = std::max_element(result.pieces.begin(), result.pieces.end(), fewer);
  if (largest != result.pieces.end()) {
    result.largest = static_cast<std::int32_t>(largest - result.pieces.begin());
  }
  return result;
}

}  // namespace poreshock
