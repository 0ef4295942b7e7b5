#include <algorithm>
#include <cmath>

#include "grains.hpp"
#include "overlapping.hpp"
#include "packing.hpp"
#include "poreshock/core/error.hpp"
#include "text.hpp"

namespace poreshock {
namespace {

/// The share of the space that loosely packed grains take: sequential addition always gets there.
double loose_share(int dimension) {
  return dimension == 2 ? 0.42 : 0.25;
}

/// Sets the radii to `scale` times those wanted.
void set_scale(const std::vector<double>& wanted, double scale, Packing& packing) {
  for (std::size_t i = 0; i < wanted.size(); ++i) packing.voids[i].radius = scale * wanted[i];
}

/// Lets the grains grow to the radii they have, from a loose arrangement. Returns the share of
/// their radii at which they jam, 1 when they do not.
double inflate(Packing& packing) {
  std::vector<double> wanted;
  for (const Void& v : packing.voids) wanted.push_back(v.radius);
  const double dimension = packing.block.dimension;
  const double crowded = crowding(packing);
  double scale =
      std::min(1.0, std::pow(loose_share(packing.block.dimension) / crowded, 1.0 / dimension));
  set_scale(wanted, scale, packing);
  if (!add_in_sequence(packing) && !relax(packing)) return 0.0;
  shake(packing);
  double growth = 1.03;
  while (scale < 1.0) {
    const std::vector<Void> before = packing.voids;
    const double next = std::min(1.0, scale * growth);
    set_scale(wanted, next, packing);
    if (relax(packing)) {
      scale = next;
      shake(packing);
    } else {
      packing.voids = before;
      growth = 1.0 + 0.5 * (growth - 1.0);
      if (growth < 1.001) return scale;
    }
  }
  return 1.0;
}

[[noreturn]] void throw_jammed(const Sample& sample, const Packing& packing, double scale) {
  const double share =
      (1.0 - sample.porosity) * std::pow(scale, static_cast<double>(packing.block.dimension));
  throw InputError("sample.porosity = " + significant<4>(sample.porosity) +
                   " cannot be packed: " + std::to_string(packing.voids.size()) +
                   " grains of median radius " + length_text(sample.grain_radius) +
                   " with sample.grain_gap = " + length_text(sample.grain_gap) +
                   " jam at a void fraction of " + significant<4>(1.0 - share) +
                   ". Raise sample.porosity, lower sample.grain_gap, mix sizes with "
                   "sample.grain_spread, or use kind = \"voronoi_grains\".");
}

}  // namespace

Packing grain_packing(const Scene& scene, double share) {
  const Block block = sample_block(scene);
  Sample as_voids = scene.sample;
  as_voids.void_radius = scene.sample.grain_radius;
  as_voids.void_spread = scene.sample.grain_spread;
  as_voids.porosity = share;
  const double expected =
      share * block_measure(block) / ball_measure(as_voids.void_radius, block.dimension);
  if (!(expected >= 1.0 && expected <= 1e7)) {
    throw InputError("sample.grain_radius = " + length_text(as_voids.void_radius) + " asks for " +
                     significant<4>(expected) +
                     " grains in the sample block. Allowed are 1 to 1e7. Change "
                     "sample.grain_radius.");
  }
  Packing packing{.block = block,
                  .ligament = scene.sample.grain_gap,
                  .keep_out = scene.sample.keep_out,
                  .seed = scene.sample.seed,
                  .voids = matching_voids(as_voids, block)};
  const double largest = packing.voids.front().radius;
  for (int axis = 0; axis < block.dimension; ++axis) {
    const double needed =
        2.0 * largest + (block.periodic[axis] ? packing.ligament : 2.0 * packing.keep_out);
    if (needed <= block.size[axis]) continue;
    throw InputError("The largest grain, of radius " + length_text(largest) + ", needs " +
                     length_text(needed) + ", but the sample block is " +
                     length_text(block.size[axis]) +
                     " wide along one axis. Lower sample.grain_radius (now " +
                     length_text(scene.sample.grain_radius) +
                     "), sample.grain_spread or "
                     "sample.keep_out.");
  }
  return packing;
}

GrainLayout pack_grains(const Scene& scene) {
  Packing packing = grain_packing(scene, 1.0 - scene.sample.porosity);
  const double scale = inflate(packing);
  if (scale < 1.0) throw_jammed(scene.sample, packing, scale);
  GrainLayout layout;
  for (const Void& v : packing.voids) {
    layout.grains.push_back({.center = v.center,
                             .radius = v.radius,
                             .measure = ball_measure(v.radius, scene.dimension)});
  }
  layout.gap = least_gap(packing.voids, packing.block);
  layout.void_fraction =
      1.0 - summed_measure(packing.voids, scene.dimension) / block_measure(packing.block);
  return layout;
}

}  // namespace poreshock
