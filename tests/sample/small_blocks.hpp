#pragma once
// A small empty domain for bodies of whole cells, and its particles.

#include "filled.hpp"

namespace poreshock::testing {

template <int Dim>
Particles<Dim> filled(const Scene& scene, LatticeRange range, SampleReport& report,
                      MPI_Comm communicator = MPI_COMM_SELF) {
  Particles<Dim> particles;
  fill(scene, range, communicator, particles, report);
  return particles;
}

inline Region box(Triple low, Triple high) {
  Region region;
  region.shape = BodyShape::box;
  region.low = low;
  region.high = high;
  return region;
}

/// An empty domain of 10 x 10 cells of 1 m with one material.
inline Scene small_scene() {
  Scene scene = plane_scene(10.0, 0.0);
  scene.sample.kind = SampleKind::none;
  scene.domain.cell = 1.0;
  scene.domain.size = {10.0, 10.0, 0.0};
  scene.domain.cells = {10, 10, 0};
  return scene;
}

}  // namespace poreshock::testing
