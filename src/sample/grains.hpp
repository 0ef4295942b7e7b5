#pragma once
// Generated grains: where they are and which of them a point of the sample block belongs to.
// Also in pack_grains.cpp, voronoi_grains.cpp, image_grains.cpp.

#include <cstdint>
#include <vector>

#include "lattice.hpp"
#include "packing.hpp"
#include "regions.hpp"

namespace poreshock {

/// Grains of a sample and what tells them apart.
struct GrainLayout {
  std::vector<Grain> grains;
  double gap = 0.0;            ///< m, between Voronoi grains
  double void_fraction = 0.0;  ///< of the sample block
  Runs sites;                  ///< of an image: solid sites of a range, of its grains as regions
};

/// The grains of a scene's sample; none for samples without, and of an image the sites in `range`.
/// Deterministic in the scene. Throws InputError with the reason when they cannot be made.
/// Collective for images.
GrainLayout place_grains(const Scene& scene, LatticeRange range, MPI_Comm communicator);

/// Packed grains: soft discs or balls grow in small steps while they are moved apart (inflation),
/// until they take the share of the block that is not void. Throws InputError with the share at
/// which they jam.
GrainLayout pack_grains(const Scene& scene);

/// Voronoi grains: the cells of a power diagram of packed centres, each shrunk by half a gap that
/// is the same everywhere and follows from the void fraction, to about 1e-3 of it.
GrainLayout divide_into_grains(const Scene& scene);

/// Grains of an image, one for each connected region, or none where it is one matrix, and its solid
/// sites in `range`. Every rank reads its share of the layers. Throws InputError with all that is
/// wrong with the files. Collective.
GrainLayout grains_of_image(const Scene& scene, LatticeRange range, MPI_Comm communicator);

/// Gives each grain a material of the sample's mixture, in a random order always the one whose
/// share is farthest behind.
void assign_materials(const Sample& sample, std::vector<Grain>& grains);

/// Discs or balls, largest first, whose measures sum up to `share` of the block; their centres are
/// not set. Throws InputError when none, too many, or one too large for the block would come.
Packing grain_packing(const Scene& scene, double share);

/// give_grains for Voronoi grains.
void give_cells(const Scene& scene, const GrainLayout& layout, LatticeRange range,
                std::int32_t first_owner, std::vector<std::int32_t>& owners);

/// Gives the sites of the range to their grains: owner = first_owner + number of the grain.
void give_grains(const Scene& scene, const GrainLayout& layout, LatticeRange range,
                 std::int32_t first_owner, std::vector<std::int32_t>& owners);

}  // namespace poreshock
