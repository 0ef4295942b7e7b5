#pragma once
// Names of what a snapshot may hold and of what morphology may measure.

#include <algorithm>
#include <string>
#include <vector>

#include "poreshock/particles/particles.hpp"
#include "poreshock/scene/particle_options.hpp"

namespace poreshock::scene_text {

inline const std::vector<std::string> particle_datasets{"id",
                                                        "grain",
                                                        "material",
                                                        "position",
                                                        "velocity",
                                                        "mass",
                                                        "density",
                                                        "pressure",
                                                        "stress",
                                                        "temperature",
                                                        "plastic_strain",
                                                        "plastic_work",
                                                        "internal_energy",
                                                        "kinetic_energy"};

/// The particle datasets of a scene: the common ones, then the other columns that are shown.
inline std::vector<std::string> datasets_of(const Scene& scene) {
  std::vector<std::string> names = particle_datasets;
  Particles<2> particles;
  particles.options = particle_options(scene);
  for_each_entry(
      [&](const auto& entry, const auto&) {
        const bool known = std::find(names.begin(), names.end(), entry.name) != names.end();
        if (entry.use.shown && !known) names.emplace_back(entry.name);
      },
      particles);
  if (can_melt(scene)) names.push_back("molten");
  // With several velocity fields.
  if (scene.contact.self || has_grains(scene)) names.push_back("colour");
  return names;
}

inline const std::vector<std::string> morphology_fields{
    "temperature", "pressure", "density", "speed", "von_mises", "plastic_strain", "molten"};

}  // namespace poreshock::scene_text
