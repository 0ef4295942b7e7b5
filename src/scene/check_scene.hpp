#pragma once
// What must hold between the keys of a scene.
// Also in check_boundary.cpp, check_grains.cpp, check_materials.cpp, check_probes.cpp,
// check_scheme.cpp.

#include "poreshock/scene/scene.hpp"
#include "report.hpp"

namespace poreshock::scene_text {

/// Sets what follows from the keys: the numbers of cells, and the porosity as a void fraction.
void resolve(Scene& scene, const Report& report);

/// Adds every contradiction between keys to the report; keys that have a problem are left out.
void check_scene(const Scene& scene, Report& report);

/// The part of it about the two ends of the domain.
void check_boundary(const Scene& scene, Report& report);

/// The part of it about materials.
void check_materials(const Scene& scene, Report& report);

/// The part of it about generated grains.
void check_grains(const Scene& scene, Report& report);

/// The part of it about probes.
void check_probes(const Scene& scene, Report& report);

/// The part of it about [transfer], [conduction], contact.self and time.follow: combinations that
/// cannot work.
void check_scheme(const Scene& scene, Report& report);

}  // namespace poreshock::scene_text
