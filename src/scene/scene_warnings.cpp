#include "poreshock/scene/scene_warnings.hpp"

#include <algorithm>
#include <set>

#include "rules.hpp"
#include "unit_warnings.hpp"

namespace poreshock {
namespace {

/// Indices of the materials that the sample or a body is made of.
std::set<int> used_materials(const Scene& scene) {
  std::set<int> used;
  for (const Body& body : scene.bodies) used.insert(body.material);
  if (scene.sample.kind == SampleKind::none) return used;
  if (scene.sample.mixture.empty()) used.insert(scene.sample.material);
  for (const MixturePart& part : scene.sample.mixture) used.insert(part.material);
  return used;
}

/// A value that all material of some kind has at least, from the start.
struct Floor {
  double value = 0.0;
  std::string name;
};

/// The floor of a field; the coldest material's T0 for temperatures, 0 for what has no sign.
std::vector<Floor> floors_of(const Scene& scene, const std::string& field) {
  std::vector<Floor> floors;
  if (field == "temperature") {
    for (const int index : used_materials(scene)) {
      const MaterialParameters& m = scene.materials.at(static_cast<std::size_t>(index));
      floors.push_back({m.T0, "T0 = " + scene_text::plain_number(m.T0) + " K of " + m.name});
    }
  } else if (field != "pressure") {
    floors.push_back({0.0, "0"});
  }
  return floors;
}

void warn_thresholds(const Scene& scene, const std::string& key, const MorphologyField& field,
                     const std::vector<double>& thresholds, std::vector<std::string>& warnings) {
  for (const Floor& floor : floors_of(scene, field.name)) {
    const auto low = std::count_if(thresholds.begin(), thresholds.end(),
                                   [&](double t) { return t <= floor.value; });
    if (low == 0) continue;
    warnings.push_back(std::to_string(low) + " of " + std::to_string(thresholds.size()) + " " +
                       key + " of " + field.name + " " + (low == 1 ? "is" : "are") + " not above " +
                       floor.name +
                       ": all of it counts as hot there from the start. Begin above it.");
  }
}

}  // namespace

std::vector<std::string> scene_warnings(const Scene& scene) {
  std::vector<std::string> warnings;
  scene_text::warn_units(scene, warnings);
  if (!(scene.morphology.every > 0.0)) return warnings;
  for (const MorphologyField& field : scene.morphology.fields) {
    warn_thresholds(scene, "morphology.thresholds", field, field.thresholds, warnings);
    warn_thresholds(scene, "morphology.hot_spots", field, field.hot_spots, warnings);
  }
  return warnings;
}

}  // namespace poreshock
