#include <algorithm>
#include <cmath>

#include "overlapping.hpp"
#include "packing.hpp"
#include "poreshock/core/error.hpp"
#include "text.hpp"

namespace poreshock {
namespace {

/// Throws when one void of radius `radius` does not fit into the block, or its own image is too
/// near.
void require_room(const Sample& sample, const Block& block, double radius) {
  for (int axis = 0; axis < block.dimension; ++axis) {
    const bool shock = axis == block.dimension - 1;
    const double gap =
        block.periodic[axis] ? (sample.overlap ? 0.0 : sample.ligament) : 2.0 * sample.keep_out;
    if (2.0 * radius + gap <= block.size[axis]) continue;
    const std::string side = shock ? "sample.height" : "the domain's width";
    const std::string what = block.periodic[axis]
                                 ? "its own image across the periodic sides at least "
                                   "sample.ligament away"
                                 : "sample.keep_out on both sides";
    throw InputError("A void of radius " + length_text(radius) + " with " + what + " needs " +
                     length_text(2.0 * radius + gap) + ", but " + side + " is " +
                     length_text(block.size[axis]) + ". Lower sample.void_radius (now " +
                     length_text(sample.void_radius) + "), or enlarge " + side + ".");
  }
}

void check_sample(const Sample& sample, const Block& block) {
  if (!(sample.porosity >= 0.0 && sample.porosity < 1.0)) {
    throw InputError("sample.porosity = " + significant<4>(sample.porosity) +
                     ". Allowed is a void fraction from 0 to below 1.");
  }
  if (!(sample.void_radius > 0.0)) {
    throw InputError("sample.void_radius = " + length_text(sample.void_radius) +
                     ". Allowed is a positive length in m.");
  }
  const double expected =
      sample.porosity * block_measure(block) / ball_measure(sample.void_radius, block.dimension);
  if (expected > 1e7) {
    throw InputError("sample.void_radius = " + length_text(sample.void_radius) + " asks for " +
                     significant<4>(expected) +
                     " voids. Allowed are at most 1e7. Raise sample.void_radius.");
  }
  const double most = block.dimension == 2 ? 0.65 : 0.95;
  if (sample.overlap && sample.porosity > most) {
    throw InputError("sample.porosity = " + significant<4>(sample.porosity) +
                     " with sample.overlap = true. Allowed is at most " + significant<4>(most) +
                     " in " + std::to_string(block.dimension) +
                     "-D: a little above it the solid falls into pieces. Lower sample.porosity.");
  }
}

std::string crowding_text(const Packing& packing) {
  const bool flat = packing.block.dimension == 2;
  std::string text = " With half the ligament around them they would take " +
                     significant<4>(crowding(packing)) +
                     " of the space between the keep-out layers; random arrangements of equal " +
                     (flat ? "discs end near 0.84." : "balls end near 0.64.");
  double narrow = INFINITY;
  for (int axis = 0; axis < packing.block.dimension; ++axis) {
    narrow = std::min(narrow, packing.block.size[axis] / largest_contact(packing));
  }
  if (narrow < 6.0) {
    text += " The block is only " + significant<4>(narrow) +
            " of the largest voids wide, which wastes space at its sides.";
  }
  return text;
}

[[noreturn]] void throw_not_packed(const Sample& sample, const Packing& packing) {
  const double scale = fitting_scale(packing);
  const double reached = sample.porosity * std::pow(scale, packing.block.dimension);
  throw InputError(
      "sample.porosity = " + significant<4>(sample.porosity) +
      " cannot be packed: " + std::to_string(packing.voids.size()) + " voids of radius " +
      length_text(sample.void_radius) + " with sample.ligament = " + length_text(sample.ligament) +
      " and sample.keep_out = " + length_text(sample.keep_out) +
      " were moved apart as far as they go, and fit only when shrunk to a void fraction of " +
      significant<4>(reached) + "." + crowding_text(packing) +
      " Lower sample.porosity, sample.ligament or sample.keep_out, mix sizes with "
      "sample.void_spread, or set sample.overlap = true.");
}

std::vector<Void> place_apart(const Sample& sample, const Block& block) {
  Packing packing{.block = block,
                  .ligament = sample.ligament,
                  .keep_out = sample.keep_out,
                  .seed = sample.seed,
                  .voids = matching_voids(sample, block)};
  require_room(sample, block, packing.voids.front().radius);
  if (!add_in_sequence(packing)) {
    if (!relax(packing)) throw_not_packed(sample, packing);
    shake(packing);
  }
  return packing.voids;
}

}  // namespace

std::vector<Void> place_voids(const Scene& scene) {
  const Sample& sample = scene.sample;
  if (sample.kind != SampleKind::random_voids) return {};
  const Block block = sample_block(scene);
  check_sample(sample, block);
  if (sample.porosity == 0.0) return {};
  // Overlapping voids are drawn one by one later on: the largest that can come has to fit.
  const double largest = sample.overlap ? std::exp(2.5 * sample.void_spread) : 1.0;
  require_room(sample, block, sample.void_radius * largest);
  return sample.overlap ? place_overlapping(sample, block) : place_apart(sample, block);
}

}  // namespace poreshock
