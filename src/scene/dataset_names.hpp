#pragma once
// Names of what a snapshot may hold and of what morphology may measure.

#include <string>
#include <vector>

#include "poreshock/scene/scene.hpp"

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

/// The particle datasets of a scene: the common ones and those of the physics it asks for.
inline std::vector<std::string> datasets_of(const Scene& scene) {
  std::vector<std::string> names = particle_datasets;
  if (scene.thermal == Thermal::paper && conducts_heat(scene)) names.push_back("conducted_heat");
  if (can_fail(scene)) names.push_back("failed");
  return names;
}

inline const std::vector<std::string> morphology_fields{
    "temperature", "pressure", "density", "speed", "von_mises", "plastic_strain"};

}  // namespace poreshock::scene_text
