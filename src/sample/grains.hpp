#pragma once
// Generated grains: where they are and which of them a point of the sample block belongs to.

#include <cstdint>
#include <vector>

#include "lattice.hpp"
#include "packing.hpp"

namespace poreshock {

/// A grey or labelled image as grains: one per connected region.
struct GrainImage {
  std::int64_t columns = 0, rows = 0;
  std::vector<std::int32_t> grain;  ///< per pixel, lowest row first; -1 = void
};

/// Grains of a sample and what tells them apart.
struct GrainLayout {
  std::vector<Grain> grains;
  double gap = 0.0;            ///< m, between Voronoi grains
  double void_fraction = 0.0;  ///< of the sample block
  GrainImage image;            ///< only for images
};

/// The grains of a scene's sample; none for samples without. Deterministic in the scene. Throws
/// InputError with the reason when they cannot be made. Not collective.
GrainLayout place_grains(const Scene& scene);

/// Packed grains: soft discs or balls grow in small steps while they are moved apart (inflation),
/// until they take the share of the block that is not void. Throws InputError with the share at
/// which they jam.
GrainLayout pack_grains(const Scene& scene);

/// Voronoi grains: the cells of a power diagram of packed centres, each shrunk by half a gap that
/// is the same everywhere and follows from the void fraction, to about 1e-3 of it.
GrainLayout divide_into_grains(const Scene& scene);

/// Grains of an image. Throws InputError that names the file.
GrainLayout grains_of_image(const Scene& scene);

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
