#include "check_scene.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "rules.hpp"

namespace poreshock::scene_text {
namespace {

constexpr double tolerance = 1e-9;
constexpr double most_cells = std::numeric_limits<int>::max();
constexpr double most_beats = 1e9;
constexpr double greatest_void_fraction = 0.65;
constexpr int least_lateral_cells = 4;
constexpr int least_shock_cells = 8;
constexpr std::array<const char*, 3> axis_names{"x", "y", "z"};

bool whole_multiple(double value, double unit) {
  const double ratio = value / unit;
  const double nearest = std::round(ratio);
  return nearest >= 1.0 && std::abs(ratio - nearest) <= tolerance * nearest;
}

void check_domain(const Scene& scene, Report& report) {
  if (!good(report, {"domain.size", "domain.cell"})) return;
  const double cell = scene.domain.cell;
  const auto sides = scene.domain.size.begin();
  const double smallest = *std::min_element(sides, sides + scene.dimension);
  if (cell > smallest) {
    add_problem("domain.cell",
                "found " + plain_number(cell) +
                    " m, allowed up to a quarter of domain.size, here " +
                    plain_number(smallest / least_lateral_cells) + " m; 10 um are 10e-6",
                report);
    return;
  }
  for (int axis = 0; axis < scene.dimension; ++axis) {
    const double size = scene.domain.size[axis];
    const std::string found =
        "found " + plain_number(size) + " m along " + axis_names[axis] + ", allowed ";
    const bool shock_axis = axis == scene.dimension - 1;
    const int least = shock_axis ? least_shock_cells : least_lateral_cells;
    if (size / cell > most_cells) {
      add_problem("domain.size", found + "at most 2147483647 cells", report);
    } else if (!whole_multiple(size, cell)) {
      add_problem("domain.size",
                  found + "whole multiples of domain.cell = " + plain_number(cell) + " m", report);
    } else if (std::round(size / cell) < least) {
      add_problem("domain.size",
                  found + "at least " + std::to_string(least) + " cells " +
                      (shock_axis ? "along the shock axis" : "along a lateral axis") + " (" +
                      plain_number(least * cell) + " m)",
                  report);
    }
  }
}

void check_voids_of_sample(const Sample& sample, Report& report) {
  if (good(report, {"sample.void_radius"}) && !(sample.void_radius > 0.0)) {
    add_problem("sample.void_radius",
                wrong(report, "sample.void_radius", plain_number(sample.void_radius) + " m",
                      "a number > 0 (m) with kind = \"random_voids\""),
                report);
  }
  if (good(report, {"sample.porosity", "sample.porosity_definition"}) &&
      !(sample.porosity > 0.0 && sample.porosity <= greatest_void_fraction)) {
    add_problem(
        "sample.porosity",
        wrong(report, "sample.porosity", "a void fraction of " + plain_number(sample.porosity),
              "a void fraction > 0 and <= 0.65 with kind = \"random_voids\""),
        report);
  }
  if (good(report, {"sample.ligament", "sample.overlap"}) && sample.overlap &&
      sample.ligament > 0.0) {
    add_problem("sample.ligament",
                "found " + plain_number(sample.ligament) + " m, allowed 0 with overlap = true",
                report);
  }
}

void check_sample(const Scene& scene, Report& report) {
  const Sample& sample = scene.sample;
  if (!good(report, {"sample.kind"})) return;
  if (sample.kind == SampleKind::none) {
    if (scene.bodies.empty() && good(report, {"body"})) {
      add_problem("sample",
                  "found no material in the domain, allowed a [sample] with a kind other "
                  "than \"none\", or at least one [[body]]",
                  report);
    }
    return;
  }
  const double height = scene.domain.size[scene.dimension - 1];
  if (good(report, {"domain.size", "sample.height", "time"}) && sample.height > height &&
      !follows_front(scene)) {
    add_problem("sample.height",
                "found " + plain_number(sample.height) + " m, allowed up to the domain height of " +
                    plain_number(height) + " m, or more with time.follow = \"front\"",
                report);
  }
  if (sample.kind == SampleKind::random_voids) check_voids_of_sample(sample, report);
  check_grains(scene, report);
}

/// Twice the signed area of a polygon.
double twice_area(const std::vector<Triple>& points) {
  double sum = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Triple& a = points[i];
    const Triple& b = points[(i + 1) % points.size()];
    sum += a[0] * b[1] - b[0] * a[1];
  }
  return sum;
}

void check_region(const Region& region, int dimension, const std::string& path, Report& report) {
  if (has_problem(report, path)) return;
  if (region.shape == BodyShape::ring && !(region.inner_radius < region.radius)) {
    add_problem(path + ".inner",
                "found " + plain_number(region.inner_radius) +
                    " m, allowed less than outer = " + plain_number(region.radius) + " m",
                report);
  }
  for (int axis = 0; region.shape == BodyShape::box && axis < dimension; ++axis) {
    if (region.low[axis] < region.high[axis]) continue;
    add_problem(path + ".high",
                "found " + plain_number(region.high[axis]) + " m along " + axis_names[axis] +
                    ", allowed more than low, " + plain_number(region.low[axis]) + " m",
                report);
  }
  if (region.shape == BodyShape::polygon && twice_area(region.points) == 0.0) {
    add_problem(path + ".points", "found no area, allowed corners in order around an area", report);
  }
}

void check_beat(double value, const char* path, bool may_be_zero, double beat, Report& report) {
  if (!good(report, {path, "output.beat"}) || (may_be_zero && value == 0.0)) return;
  if (whole_multiple(value, beat)) return;
  add_problem(path,
              "found " + plain_number(value) + " s, allowed " + (may_be_zero ? "0 or " : "") +
                  "whole multiples of output.beat = " + plain_number(beat) + " s",
              report);
}

void check_output(const Scene& scene, Report& report) {
  const double beat = scene.output.beat;
  if (good(report, {"output.beat", "time.end"}) && scene.time.end / beat > most_beats) {
    // Who gave no beat has most likely given the end in another unit.
    report.origins.contains("output.beat")
        ? add_problem("output.beat",
                      "found " + plain_number(beat) + " s, allowed at least time.end / 1e9 = " +
                          plain_number(scene.time.end / most_beats) + " s",
                      report)
        : add_problem("time.end",
                      "found " + plain_number(scene.time.end) +
                          " s, allowed up to 1e9 times output.beat = " +
                          plain_number(most_beats * beat) + " s; 100 ns are 100e-9",
                      report);
  }
  check_beat(scene.output.snapshot, "output.snapshot", true, beat, report);
  check_beat(scene.output.history, "output.history", false, beat, report);
  check_beat(scene.morphology.every, "morphology.every", true, beat, report);
  if (scene.profile.every != scene.output.snapshot) {  // its default, which is checked above
    check_beat(scene.profile.every, "profile.every", true, beat, report);
  }
  check_beat(scene.checkpoint.every_time, "checkpoint.every_time", true, beat, report);
  if (scene.output.fields.empty() && good(report, {"output.fields"})) {
    add_problem("output.fields", "found an empty list, allowed at least one name, or no such key",
                report);
  }
}

/// Sites are pixels of their own size.
void check_site(const Scene& scene, Report& report) {
  if (!good(report, {"morphology.pixel", "domain.cell", "sample.particles_per_cell"})) return;
  const double site = scene.domain.cell / scene.sample.particles_per_cell;
  const std::string found = "found " + plain_number(scene.morphology.pixel) + " m, allowed ";
  if (std::abs(scene.morphology.pixel / site - 1.0) <= tolerance) return;
  add_problem("morphology.pixel",
              found +
                  "with lattice = \"lagrangian\" only the site, domain.cell / "
                  "sample.particles_per_cell = " +
                  plain_number(site) + " m",
              report);
}

void check_pixel(const Scene& scene, Report& report) {
  if (!good(report, {"morphology.pixel", "domain.size", "domain.cell"})) return;
  const double pixel = scene.morphology.pixel;
  const double power = std::round(std::log2(pixel / scene.domain.cell));
  const double ratio = pixel / (scene.domain.cell * std::exp2(power));
  if (power < -3.0 || power > 4.0 || std::abs(ratio - 1.0) > tolerance) {
    add_problem("morphology.pixel",
                "found " + plain_number(pixel) + " m, allowed domain.cell = " +
                    plain_number(scene.domain.cell) + " m times 1/8, 1/4, 1/2, 1, 2, 4, 8 or 16",
                report);
    return;
  }
  for (int axis = 0; axis < scene.dimension; ++axis) {
    if (whole_multiple(scene.domain.size[axis], pixel)) continue;
    add_problem("morphology.pixel",
                "found " + plain_number(pixel) + " m, allowed whole parts of the domain, " +
                    plain_number(scene.domain.size[axis]) + " m along " + axis_names[axis],
                report);
  }
}

void check_morphology(const Scene& scene, Report& report) {
  const bool sites = scene.morphology.lattice == MapLattice::lagrangian;
  sites ? check_site(scene, report) : check_pixel(scene, report);
  if (!good(report, {"morphology.every", "morphology.fields"})) return;
  const auto& fields = scene.morphology.fields;
  const bool molten = std::any_of(fields.begin(), fields.end(),
                                  [](const MorphologyField& f) { return f.name == "molten"; });
  if (molten && !can_melt(scene) && good(report, {"material"})) {
    add_problem("morphology.fields",
                "found \"molten\", allowed only where a material melts: set material.melting",
                report);
  }
  if (scene.morphology.every > 0.0 && fields.empty()) {
    add_problem("morphology.fields", "missing, give at least one field, or every = 0", report);
  }
}

}  // namespace

void resolve(Scene& scene, const Report& report) {
  if (good(report, {"domain.size", "domain.cell"})) {
    for (int axis = 0; axis < scene.dimension; ++axis) {
      const double cells = std::round(scene.domain.size[axis] / scene.domain.cell);
      if (cells <= most_cells) scene.domain.cells[axis] = static_cast<int>(cells);
    }
  }
  Sample& sample = scene.sample;
  if (sample.particles_per_cell > 0) {
    scene.transfer.half_length = 0.5 / static_cast<double>(sample.particles_per_cell);
  }
  if (sample.porosity_definition == PorosityDefinition::distension_minus_1) {
    sample.porosity = sample.porosity / (1.0 + sample.porosity);
    sample.porosity_definition = PorosityDefinition::void_fraction;
  }
}

void check_scene(const Scene& scene, Report& report) {
  check_domain(scene, report);
  check_boundary(scene, report);
  check_materials(scene, report);
  check_sample(scene, report);
  for (std::size_t i = 0; i < scene.bodies.size(); ++i) {
    check_region(scene.bodies[i].region, scene.dimension, "body." + std::to_string(i), report);
  }
  for (std::size_t i = 0; i < scene.voids.size(); ++i) {
    check_region(scene.voids[i], scene.dimension, "void." + std::to_string(i), report);
  }
  check_scheme(scene, report);
  check_output(scene, report);
  check_morphology(scene, report);
  check_probes(scene, report);
}

}  // namespace poreshock::scene_text
