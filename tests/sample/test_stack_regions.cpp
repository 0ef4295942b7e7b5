// Stacks of slices as samples: regions across slabs and sides, and sites that are no voxels.
#include <gtest/gtest.h>

#include <deque>

#include "stack_scenes.hpp"
#include "support/random_numbers.hpp"

namespace poreshock {
namespace {

using namespace testing;

/// Regions of equal label by plain flood fill, numbered by their first voxel from 1 on; those of
/// `joined` labels are one label.
std::vector<int> flood(const Voxels& voxels, std::array<bool, 2> periodic) {
  std::vector<int> region(voxels.value.size(), 0);
  int regions = 0;
  const auto [nx, ny, nz] = voxels.size;
  for (std::size_t start = 0; start < region.size(); ++start) {
    if (voxels.value[start] == 0 || region[start] != 0) continue;
    region[start] = ++regions;
    std::deque<std::size_t> open{start};
    while (!open.empty()) {
      const auto at = static_cast<int>(open.front());
      open.pop_front();
      for (int way = 0; way < 6; ++way) {
        std::array<int, 3> p{at % nx, at / nx % ny, at / nx / ny};
        const auto axis = static_cast<std::size_t>(way / 2);
        p[axis] += way % 2 == 0 ? 1 : -1;
        if (axis < 2 && periodic[axis]) {
          p[axis] = (p[axis] + voxels.size[axis]) % voxels.size[axis];
        }
        if (p[axis] < 0 || p[axis] >= voxels.size[axis]) continue;
        const auto to = static_cast<std::size_t>((p[2] * ny + p[1]) * nx + p[0]);
        if (region[to] != 0 || voxels.value[to] != voxels.value[static_cast<std::size_t>(at)]) {
          continue;
        }
        region[to] = regions;
        open.push_back(to);
      }
    }
  }
  return region;
}

// Near the share at which regions begin to span the stack they wind through many slabs.
TEST(StackRegions, RegionsHangTogetherAcrossSlabsAndSides) {
  const std::string file = place("noise.npy");
  for (const bool periodic : {false, true}) {
    for (const int kinds : {1, 2}) {
      Voxels noise{{9, 7, 23}, {}};
      reference::Random random{static_cast<std::uint64_t>(17 + kinds)};
      for (int i = 0; i < 9 * 7 * 23; ++i) {
        const int value = random.below(10);
        noise.value.push_back(value < 6 ? 0 : (kinds == 1 ? 1 : value % 2 + 1));
      }
      once([&] { write_bytes(file, npy_bytes(noise, "|u1", all_bytes(noise.value, 8))); });
      Scene scene = stack_scene(file, noise.size);
      scene.domain.periodic = {periodic, periodic};
      SampleReport report;
      const std::vector<int> expected = flood(noise, {periodic, periodic});
      EXPECT_EQ(grains_at_sites(scene, &report), expected);
      std::vector<double> voxels(report.grains.size(), 0.0);
      for (const int region : expected) {
        if (region > 0) voxels[static_cast<std::size_t>(region - 1)] += 1.0;
      }
      for (std::size_t g = 0; g < voxels.size(); ++g) {
        EXPECT_NEAR(report.grains[g].measure / (edge * edge * edge), voxels[g], 1e-9);
      }
      MPI_Barrier(world);
    }
  }
}

TEST(StackRegions, AMatrixIsOneSolid) {
  const std::string file = place("matrix.npy");
  once([&] { write_bytes(file, npy_bytes(labels, "|u1", all_bytes(labels.value, 8))); });
  Scene scene = stack_scene(file, labels.size);
  scene.sample.regions = Regions::matrix;
  SampleReport report;
  const std::vector<int> grains = grains_at_sites(scene, &report);
  std::int64_t solid = 0;
  for (const int v : labels.value) solid += v > 0 ? 1 : 0;
  EXPECT_EQ(report.particles, solid);
  EXPECT_TRUE(report.grains.empty());
  EXPECT_EQ(*std::max_element(grains.begin(), grains.end()), 0);
  EXPECT_NEAR(report.geometric_void_fraction, 1.0 - static_cast<double>(solid) / 60.0, 1e-15);
}

/// A scene that the voxels fill, with that many sites to a voxel's edge.
Scene scene_of_sites(const std::string& file, const Voxels& voxels, double sites_per_voxel) {
  Scene scene = stack_scene(file, voxels.size);
  scene.domain.cell = edge / sites_per_voxel;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    scene.domain.cells[axis] = static_cast<int>(std::lround(voxels.size[axis] * sites_per_voxel));
    scene.domain.size[axis] = scene.domain.cells[axis] * scene.domain.cell;
  }
  scene.sample.height = scene.domain.size[2];
  return scene;
}

// Sites finer and coarser than voxels, also such that no edges meet: the solid volume is that of
// the voxels to a site, and every site belongs to the ball that it lies in.
TEST(StackRegions, SitesOfAnySizeKeepTheSolidFraction) {
  const Voxels voxels = balls({48, 48, 48}, 24.0);
  const std::string file = place("balls.npy");
  once([&] { write_bytes(file, npy_bytes(voxels, "<i4", all_bytes(voxels.value, 32))); });
  double solid = 0.0;
  for (const int v : voxels.value) solid += v > 0 ? 1.0 : 0.0;
  // Sites along x: 36, 24, 64, 96 for 48 voxels.
  for (const double sites_per_voxel : {0.75, 0.5, 4.0 / 3.0, 2.0}) {
    const Scene scene = scene_of_sites(file, voxels, sites_per_voxel);
    SampleReport report;
    const std::vector<int> grains = grains_at_sites(scene, &report);
    const double cube = sites_per_voxel * sites_per_voxel * sites_per_voxel;
    EXPECT_EQ(report.particles, std::llround(solid * cube)) << sites_per_voxel;
    EXPECT_NEAR(report.particle_void_fraction, report.geometric_void_fraction, 1e-4);
    ASSERT_EQ(report.grains.size(), 8U);
    std::vector<double> sites(9, 0.0);
    for (const int g : grains) sites[static_cast<std::size_t>(g)] += 1.0;
    for (std::size_t g = 0; g < 8; ++g) {
      const double asked = report.grains[g].measure / std::pow(scene.domain.cell, 3);
      EXPECT_NEAR(sites[g + 1], asked, 0.05 * asked) << sites_per_voxel << ", ball " << g;
    }
  }
}

TEST(StackRegions, AWholeVoxelGivesItsRegionToAllOfItsSites) {
  const Voxels voxels = balls({24, 24, 24}, 12.0);
  const std::string file = place("whole.npy");
  once([&] { write_bytes(file, npy_bytes(voxels, "<i4", all_bytes(voxels.value, 32))); });
  const std::vector<int> grains = grains_at_sites(scene_of_sites(file, voxels, 2.0));
  const std::vector<int> regions = flood(voxels, {true, true});
  for (std::size_t i = 0; i < grains.size(); ++i) {
    const std::size_t x = i % 48 / 2, y = i / 48 % 48 / 2, z = i / 48 / 48 / 2;
    ASSERT_EQ(grains[i], regions[(z * 24 + y) * 24 + x]);
  }
}

}  // namespace
}  // namespace poreshock
