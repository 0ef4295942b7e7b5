#pragma once
// Stacks as samples on the ranks of a test.

#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "filled.hpp"
#include "poreshock/core/parallel.hpp"
#include "stack_files.hpp"

namespace poreshock::testing {

inline const MPI_Comm world = MPI_COMM_WORLD;
inline constexpr double edge = 20e-6;  ///< m, of a voxel

/// A name in a folder of this number of ranks, so that tests may run side by side.
inline std::string place(const std::string& name) {
  const std::string folder = "stacks_np" + std::to_string(size(world));
  std::filesystem::create_directories(folder);
  return folder + "/" + name;
}

/// Calls write() on rank 0 and lets all wait for it.
template <class Write>
void once(Write&& write) {
  if (rank(world) == 0) write();
  MPI_Barrier(world);
}

/// A scene that a stack of that many voxels fills, with one particle for each.
inline Scene stack_scene(const std::string& file, std::array<int, 3> voxels) {
  Scene scene = grain_scene(SampleKind::image, 0.0, 3);
  scene.domain.cell = edge;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    scene.domain.cells[axis] = voxels[axis] + (axis == 2 ? 2 : 0);
    scene.domain.size[axis] = scene.domain.cells[axis] * edge;
  }
  scene.sample.height = voxels[2] * edge;
  scene.sample.particles_per_cell = 1;
  scene.sample.pixel = edge;
  scene.sample.image = file;
  return scene;
}

/// Grain of every site of the sample, x fastest, 0 = void; the same on every rank.
inline std::vector<int> grains_at_sites(const Scene& scene, SampleReport* report = nullptr) {
  Particles<3> particles;
  SampleReport own;
  fill<3>(scene, own_layers(lattice_layers(scene), world), world, particles, own);
  const SampleReport all = total(own, world);
  if (report != nullptr) *report = all;
  std::int64_t sites = std::llround(scene.sample.height / scene.domain.cell);
  for (int axis = 0; axis < 2; ++axis) sites *= scene.domain.cells[axis];
  std::vector<std::int64_t> grain(static_cast<std::size_t>(sites), 0);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    grain[static_cast<std::size_t>(particles.id[p])] = particles.grain[p];
  }
  sum(grain, world);
  return {grain.begin(), grain.end()};
}

/// What fill says on every rank when it refuses.
inline std::string refusal(const Scene& scene) {
  try {
    Particles<3> particles;
    SampleReport report;
    fill<3>(scene, own_layers(lattice_layers(scene), world), world, particles, report);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

/// Three labels in four regions; one meets itself across both sides, one goes through most slices.
inline const Voxels labels{{4, 3, 5}, {7, 0, 0, 7, 0, 0, 0, 0, 9, 9, 0, 7,  //
                                       7, 0, 0, 0, 0, 0, 3, 0, 9, 0, 0, 0,  //
                                       7, 0, 0, 0, 0, 0, 0, 0, 9, 0, 7, 7,  //
                                       7, 7, 7, 0, 0, 0, 7, 0, 0, 0, 7, 0,  //
                                       0, 0, 0, 0, 9, 0, 0, 9, 0, 0, 0, 9}};
inline const std::vector<int> labelled = {1, 0, 0, 1, 0, 0, 0, 0, 2, 2, 0, 1,  //
                                          1, 0, 0, 0, 0, 0, 3, 0, 2, 0, 0, 0,  //
                                          1, 0, 0, 0, 0, 0, 0, 0, 2, 0, 1, 1,  //
                                          1, 1, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0,  //
                                          0, 0, 0, 0, 4, 0, 0, 4, 0, 0, 0, 4};

/// Balls of two sizes on a loose grid as voxels, each with a label of its own.
inline Voxels balls(std::array<int, 3> size, double pitch) {
  Voxels voxels{size, {}};
  for (int z = 0; z < size[2]; ++z) {
    for (int y = 0; y < size[1]; ++y) {
      for (int x = 0; x < size[0]; ++x) {
        int label = 1;
        double square = 0.0;
        for (const double c : {x + 0.5, y + 0.5, z + 0.5}) {
          const double cell = std::floor(c / pitch);
          label = label * 7 + static_cast<int>(cell);
          const double d = c - (cell + 0.5) * pitch;
          square += d * d;
        }
        const double radius = label % 2 == 0 ? 0.46 * pitch : 0.4 * pitch;
        voxels.value.push_back(square < radius * radius ? label : 0);
      }
    }
  }
  return voxels;
}

}  // namespace poreshock::testing
