#pragma once
// Pieces of a lattice sample that overlapping voids cut off.

#include <cstdint>
#include <vector>

#include "lattice.hpp"
#include "regions.hpp"

namespace poreshock {

/// The pieces of the sample, all of which float but the largest (the first of the largest on a
/// tie).
struct IslandPieces {
  Runs runs;                            ///< of the sample's layers in a range
  std::vector<ConnectedRegion> pieces;  ///< all, the same on every rank
  std::int32_t largest = -1;            ///< the piece that stays
};

/// The floating pieces as grains, in the order of their numbers.
std::vector<Grain> grains_of_islands(const Scene& scene, const Lattice& lattice,
                                     const IslandPieces& islands);

/// Islands of the sample with its generated voids and the scene's explicit voids taken out, and the
/// runs in `range`. Each rank looks at its share of the lattice. Collective.
IslandPieces find_islands(const Scene& scene, const std::vector<Void>& voids, LatticeRange range,
                          MPI_Comm communicator);

}  // namespace poreshock
