#pragma once
// Scenes for the tests of the sample layer.

#include <cmath>

#include "poreshock/scene/scene.hpp"

namespace poreshock::testing {

/// A 2-D block of aluminium, 1 mm wide, periodic in x, with voids of radius 40 um.
inline Scene plane_scene(double height, double porosity) {
  Scene scene;
  scene.dimension = 2;
  scene.domain.cell = 10e-6;
  scene.domain.size = {1e-3, 1.2 * height, 0.0};
  scene.domain.cells = {100, static_cast<int>(std::lround(1.2 * height / 10e-6)), 0};
  scene.domain.periodic = {true, false};
  MaterialParameters aluminium;
  aluminium.name = "aluminium";
  aluminium.density = 2700.0;
  scene.materials = {aluminium};
  scene.sample.kind = SampleKind::random_voids;
  scene.sample.height = height;
  scene.sample.porosity = porosity;
  scene.sample.void_radius = 40e-6;
  scene.sample.seed = 7;
  return scene;
}

/// A 3-D block 0.4 x 0.4 mm wide, periodic in x and y, with voids of radius 40 um.
inline Scene space_scene(double height, double porosity) {
  Scene scene = plane_scene(height, porosity);
  scene.dimension = 3;
  scene.domain.size = {0.4e-3, 0.4e-3, 1.2 * height};
  scene.domain.cells = {40, 40, static_cast<int>(std::lround(1.2 * height / 10e-6))};
  scene.domain.periodic = {true, true};
  return scene;
}

/// The same scene on cells half as large.
inline Scene refined(Scene scene) {
  scene.domain.cell *= 0.5;
  for (int& n : scene.domain.cells) n *= 2;
  return scene;
}

}  // namespace poreshock::testing
