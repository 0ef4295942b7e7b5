#pragma once
// A scene and materials for the tests of derived fields and snapshots.
#include "poreshock/scene/scene.hpp"

namespace poreshock::test {

inline MaterialParameters aluminium() {
  MaterialParameters m;
  m.name = "aluminium";
  m.density = 2785.0;
  m.young = 70e9;
  m.poisson = 0.34;
  m.yield = 300e6;
  m.hardening = 100e6;
  m.c0 = 5328.0;
  m.lambda = 1.338;
  m.gamma = 2.0;
  m.cv = 880.0;
  m.T0 = 300.0;
  return m;
}

inline Scene small_scene(int dimension) {
  Scene scene;
  scene.title = "snapshot";
  scene.dimension = dimension;
  scene.domain.cell = 0.5;
  scene.materials = {aluminium(), aluminium()};
  scene.materials[1].T0 = 500.0;
  return scene;
}

inline std::vector<Material> small_materials() {
  const Scene scene = small_scene(2);
  return {make_material(scene.materials[0]), make_material(scene.materials[1])};
}

}  // namespace poreshock::test
