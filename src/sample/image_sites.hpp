#pragma once
// Lattice sites of an image: which are solid, and in which region.

#include "lattice.hpp"
#include "regions.hpp"

namespace poreshock {

/// Solid voxels of an image as runs, in the rank's layers, regions numbered.
struct SolidVoxels {
  std::array<std::int64_t, 3> size{1, 1, 1};  ///< voxels of the image along x, y(, z)
  double edge = 0.0;                          ///< m
  std::int64_t solid = 0;                     ///< voxels, of the whole image
  LatticeRange layers;                        ///< of this rank, consecutive over the ranks
  Runs runs;
};

/// The solid sites of the lattice's layers `wanted` below the sample's height, as runs with their
/// region. Of all sites those are solid that the image covers most with solid, as many as make up
/// its solid volume to one site; sites covered alike are taken in a random order that follows from
/// their numbers. A site has the region that covers most of it. Needs the voxels around the
/// rank's share of the sites only. Collective.
Runs solid_sites(const Lattice& lattice, const SolidVoxels& voxels, LatticeRange wanted,
                 MPI_Comm communicator);

}  // namespace poreshock
