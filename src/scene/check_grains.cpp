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

void check_image(const Scene& scene, Report& report) {
  const Sample& sample = scene.sample;
  if (scene.dimension != 2) {
    add_problem("sample.kind", "found \"image\" in 3-D, allowed in 2-D only", report);
  }
  if (good(report, {"sample.image"}) && sample.image.empty()) {
    add_problem("sample.image",
                wrong(report, "sample.image", "no name", "the path of a PNG or PGM file"), report);
  }
  if (good(report, {"sample.pixel"}) && !(sample.pixel > 0.0)) {
    add_problem("sample.pixel",
                wrong(report, "sample.pixel", plain_number(sample.pixel) + " m",
                      "a number > 0 (m), the side of a pixel of the image"),
                report);
  }
}

void check_mixture(const Sample& sample, Report& report) {
  if (sample.mixture.empty() || !good(report, {"sample.mixture"})) return;
  if (!makes_grains(sample.kind)) {
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
