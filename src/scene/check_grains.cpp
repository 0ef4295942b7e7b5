#include <algorithm>
#include <cmath>

#include "check_scene.hpp"
#include "rules.hpp"

namespace poreshock::scene_text {
namespace {

/// Porosities that grains can have. Packed discs jam near 0.84, balls near 0.64; Voronoi grains
/// fill everything but their gaps.
Range porosities(const Scene& scene) {
  if (scene.sample.kind == SampleKind::voronoi_grains) {
    return {.low = 0.0, .high = 0.5, .above_low = true};
  }
  return {.low = scene.dimension == 2 ? 0.14 : 0.34, .high = 0.95};
}

void check_placed_grains(const Scene& scene, Report& report) {
  const Sample& sample = scene.sample;
  const bool voronoi = sample.kind == SampleKind::voronoi_grains;
  const std::string with =
      voronoi ? " with kind = \"voronoi_grains\"" : " with kind = \"packed_grains\"";
  if (good(report, {"sample.grain_radius"}) && !(sample.grain_radius > 0.0)) {
    add_problem("sample.grain_radius",
                wrong(report, "sample.grain_radius", plain_number(sample.grain_radius) + " m",
                      "a number > 0 (m)" + with),
                report);
  }
  const Range range = porosities(scene);
  if (good(report, {"sample.porosity", "sample.porosity_definition"}) &&
      !in_range(range, sample.porosity)) {
    add_problem(
        "sample.porosity",
        wrong(report, "sample.porosity", "a void fraction of " + plain_number(sample.porosity),
              allowed_numbers("a void fraction", {range, "", ""}) + with +
                  (voronoi ? "" : ": denser grains are jammed; use \"voronoi_grains\"")),
        report);
  }
  if (voronoi && sample.grain_gap > 0.0 && good(report, {"sample.grain_gap"})) {
    add_problem("sample.grain_gap",
                "found " + plain_number(sample.grain_gap) +
                    " m, allowed 0 with kind = \"voronoi_grains\": their gap follows from porosity",
                report);
  }
}

/// A size of a raw image is whole, and is there if the image is one.
void check_raw(const Scene& scene, Report& report) {
  const Sample& sample = scene.sample;
  if (!good(report, {"sample.raw_size", "sample.image"})) return;
  const auto size = sample.raw_size.begin();
  const bool given = std::any_of(size, size + scene.dimension, [](double n) { return n != 0.0; });
  const bool whole = std::all_of(size, size + scene.dimension, [](double n) {
    return n >= 1.0 && n <= 1e9 && n == std::floor(n);
  });
  const std::string allowed = "whole numbers from 1 to 1e9, voxels along each axis";
  const bool named = sample.image.ends_with(".raw") || sample.image.ends_with(".bin");
  if (given && !whole) {
    add_problem("sample.raw_size",
                "found " + plain_number(sample.raw_size[0]) + ", " +
                    plain_number(sample.raw_size[1]) + " ..., allowed " + allowed,
                report);
  } else if (named && !given) {
    add_problem("sample.raw_size",
                wrong(report, "sample.raw_size", "0", allowed + ", with " + sample.image), report);
  }
}

void check_image(const Scene& scene, Report& report) {
  const Sample& sample = scene.sample;
  if (good(report, {"sample.image"}) && sample.image.empty()) {
    add_problem("sample.image",
                wrong(report, "sample.image", "no name",
                      scene.dimension == 2 ? "the path of a PNG, TIFF or PGM file or of an array"
                                           : "the path of a stack: a folder of slices, or a file"),
                report);
  }
  check_raw(scene, report);
  if (good(report, {"sample.pixel"}) && !(sample.pixel > 0.0)) {
    add_problem("sample.pixel",
                wrong(report, "sample.pixel", plain_number(sample.pixel) + " m",
                      "a number > 0 (m), the side of a pixel or voxel of the image"),
                report);
  }
}

void check_mixture(const Sample& sample, Report& report) {
  if (sample.mixture.empty() || !good(report, {"sample.mixture"})) return;
  if (!makes_grains(sample)) {
    add_problem("sample.mixture.0", "found a mixture, allowed with a sample of grains only",
                report);
    return;
  }
  double sum = 0.0;
  for (const MixturePart& part : sample.mixture) sum += part.fraction;
  if (std::abs(sum - 1.0) <= 1e-9) return;
  add_problem("sample.mixture.0.fraction",
              "found fractions that sum to " + plain_number(sum) + ", allowed a sum of 1", report);
}

}  // namespace

void check_grains(const Scene& scene, Report& report) {
  const SampleKind kind = scene.sample.kind;
  if (kind == SampleKind::packed_grains || kind == SampleKind::voronoi_grains) {
    check_placed_grains(scene, report);
  }
  if (kind == SampleKind::image) check_image(scene, report);
  check_mixture(scene.sample, report);
}

}  // namespace poreshock::scene_text
