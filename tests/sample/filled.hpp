#pragma once
// Samples filled for the tests, and what they say when they cannot be.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "poreshock/core/error.hpp"
#include "poreshock/sample/fill.hpp"
#include "sample_scenes.hpp"

namespace poreshock::testing {

inline Scene grain_scene(SampleKind kind, double porosity, int dimension = 2) {
  Scene scene = dimension == 2 ? plane_scene(1e-3, porosity) : space_scene(0.4e-3, porosity);
  scene.sample.kind = kind;
  scene.sample.void_radius = 0.0;
  scene.sample.grain_radius = 60e-6;
  scene.sample.grain_spread = 0.2;
  return scene;
}

template <int Dim>
struct Filled {
  Particles<Dim> particles;
  SampleReport report;
};

/// The whole sample filled range by range, as that many ranks do.
template <int Dim>
Filled<Dim> filled(const Scene& scene, int ranges = 1) {
  Filled<Dim> all;
  const std::int64_t layers = lattice_layers(scene);
  for (int r = 0; r < ranges; ++r) {
    Particles<Dim> part;
    fill<Dim>(scene, {layers * r / ranges, layers * (r + 1) / ranges}, MPI_COMM_SELF, part,
              all.report);
    std::vector<std::uint32_t> every;
    for (std::size_t p = 0; p < part.size(); ++p) every.push_back(static_cast<std::uint32_t>(p));
    append(part, every, all.particles);
  }
  return all;
}

inline std::string error_of(const Scene& scene) {
  try {
    Particles<2> particles;
    SampleReport report;
    fill<2>(scene, {0, lattice_layers(scene)}, MPI_COMM_SELF, particles, report);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

inline void expect_words(const std::string& text, const std::vector<std::string>& words) {
  for (const std::string& word : words) {
    EXPECT_NE(text.find(word), std::string::npos) << "'" << word << "' not in: " << text;
  }
}

}  // namespace poreshock::testing
