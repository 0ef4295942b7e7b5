// A stack of 200 x 200 x 400 voxels, a packing of balls whose functionals are known: it comes out
// with them, and no rank holds more than its slab.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "filled.hpp"
#include "poreshock/core/memory.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/morphology/minkowski.hpp"
#include "sample/grains.hpp"
#include "support/random_numbers.hpp"
#include "support/sanitizer.hpp"

namespace poreshock {
namespace {

using namespace testing;

const MPI_Comm world = MPI_COMM_WORLD;
constexpr int nx = 200, ny = 200, nz = 400;

struct Ball {
  double x, y, z, radius;  ///< voxels
};

/// One ball near the middle of each cube of 40 voxels, so that none touch.
std::vector<Ball> packing() {
  std::vector<Ball> balls;
  reference::Random random{5};
  for (int k = 0; k < nz / 40; ++k) {
    for (int j = 0; j < ny / 40; ++j) {
      for (int i = 0; i < nx / 40; ++i) {
        const auto place = [&](int n) { return 40.0 * n + 19.0 + 2.0 * random.uniform(); };
        balls.push_back({place(i), place(j), place(k), 15.0 + 3.0 * random.uniform()});
      }
    }
  }
  return balls;
}

/// Voxels whose centre lies in a ball: the number of the ball, from 1 on, else 0.
std::vector<std::uint8_t> voxels_of(const std::vector<Ball>& balls) {
  std::vector<std::uint8_t> voxels(std::size_t{nx} * ny * nz, 0);
  for (std::size_t b = 0; b < balls.size(); ++b) {
    const Ball& ball = balls[b];
    const auto low = [&](double c) { return static_cast<int>(c - ball.radius - 1.0); };
    const auto high = [&](double c) { return static_cast<int>(c + ball.radius + 1.0); };
    for (int z = low(ball.z); z < high(ball.z); ++z) {
      for (int y = low(ball.y); y < high(ball.y); ++y) {
        for (int x = low(ball.x); x < high(ball.x); ++x) {
          const double dx = x + 0.5 - ball.x, dy = y + 0.5 - ball.y, dz = z + 0.5 - ball.z;
          if (dx * dx + dy * dy + dz * dz > ball.radius * ball.radius) continue;
          voxels[(static_cast<std::size_t>(z) * ny + static_cast<std::size_t>(y)) * nx +
                 static_cast<std::size_t>(x)] = static_cast<std::uint8_t>(b % 250 + 1);
        }
      }
    }
  }
  return voxels;
}

/// A scene with one site for each voxel, of edge 1 um.
Scene packing_scene(const std::string& file) {
  Scene scene = grain_scene(SampleKind::image, 0.0, 3);
  scene.domain.cell = scene.sample.pixel = 1e-6;
  scene.domain.cells = {nx, ny, nz};
  scene.domain.size = {nx * 1e-6, ny * 1e-6, nz * 1e-6};
  scene.sample.height = nz * 1e-6;
  scene.sample.particles_per_cell = 1;
  scene.sample.image = file;
  scene.sample.raw_size = {nx, ny, nz};
  return scene;
}

class Packing : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    if (rank(world) == 0) {
      const std::vector<std::uint8_t> voxels = voxels_of(packing());
      std::ofstream(file(), std::ios::binary)
          .write(reinterpret_cast<const char*>(voxels.data()),
                 static_cast<std::streamsize>(voxels.size()));
    }
    MPI_Barrier(world);
  }
  static void TearDownTestSuite() {
    MPI_Barrier(world);
    if (rank(world) == 0) std::filesystem::remove(file());
  }
  static std::string file() { return "packing_np" + std::to_string(size(world)) + ".raw"; }
};

// First, while nothing else has taken memory.
TEST_F(Packing, EachRankHoldsItsSlabOnly) {
  if (test::allocator_of_the_sanitizer) GTEST_SKIP() << "the sanitizer keeps what is freed";
  const Scene scene = packing_scene(file());
  const LatticeRange own = own_layers(nz, world);
  release_freed_memory();
  const std::int64_t before = own_memory(), peak_before = peak_memory();
  const GrainLayout layout = grains_of_image(scene, own, world);
  const double voxels = static_cast<double>(own.last - own.first) * nx * ny;
  const double taken =
      static_cast<double>(std::max(peak_memory() - peak_before, own_memory() - before));
  std::printf("rank %d of %d: %.1f MB for %.1f million voxels, %.1f bytes each\n", rank(world),
              size(world), taken * 1e-6, voxels * 1e-6, taken / voxels);
  EXPECT_LT(taken, 24e6 + 16.0 * voxels);
  EXPECT_GT(layout.sites.runs.size(), 0U);
}

/// Counts of a map of these sites, voids around.
VoxelCounts counts_of(const std::vector<std::uint8_t>& solid) {
  std::vector<double> values(solid.begin(), solid.end());
  values.resize(values.size() + std::size_t{nx} * ny,
                0.0);  // the layer that a neighbour would have
  std::vector<std::uint8_t> material(values.size(), 1);
  VoxelBlock block;
  block.width = {nx, ny};
  block.layers = nz;
  block.first = block.last = true;
  block.values = values;
  block.solid = material;
  const double threshold[] = {0.5};
  return count_voxels(block, threshold);
}

TEST_F(Packing, ComesOutWithItsFunctionals) {
  const Scene scene = packing_scene(file());
  const LatticeRange own = own_layers(nz, world);
  const GrainLayout layout = grains_of_image(scene, own, world);
  const std::vector<Ball> balls = packing();
  ASSERT_EQ(layout.grains.size(), balls.size());
  double volume = 0.0, surface = 0.0, breadth = 0.0;
  for (std::size_t b = 0; b < balls.size(); ++b) {
    const double r = balls[b].radius;
    volume += 4.0 / 3.0 * std::numbers::pi * r * r * r;
    surface += 4.0 * std::numbers::pi * r * r;
    breadth += 3.0 * 2.0 * r;
  }
  const double all = double{nx} * ny * nz;
  EXPECT_NEAR((1.0 - layout.void_fraction) / (volume / all), 1.0, 1e-3);
  // The sites of this rank are its voxels, with nothing lost or moved.
  const std::vector<std::uint8_t> voxels = voxels_of(balls);
  std::vector<std::uint8_t> solid(voxels.size(), 0);
  ASSERT_EQ(layout.sites.rows(), (own.last - own.first) * ny);
  for (std::int64_t row = 0; row < layout.sites.rows(); ++row) {
    const auto r = static_cast<std::size_t>(row);
    for (std::size_t n = layout.sites.row_start[r]; n < layout.sites.row_start[r + 1]; ++n) {
      const auto& run = layout.sites.runs[n];
      const auto begin = solid.begin() + (own.first * ny + row) * nx;
      std::fill(begin + run.begin, begin + run.end, std::uint8_t{1});
    }
  }
  for (std::size_t i = 0; i < voxels.size(); ++i) {
    const auto layer = static_cast<std::int64_t>(i / (std::size_t{nx} * ny));
    const bool mine = layer >= own.first && layer < own.last;
    ASSERT_EQ(solid[i] != 0, mine && voxels[i] != 0) << i;
  }
  if (size(world) > 1) return;
  const VoxelCounts counts = counts_of(solid);
  const Minkowski3 found = functionals(counts);
  std::printf("volume, surface, breadth off by %.1e, %.1e, %.1e\n", found.V[0] * all / volume - 1.0,
              found.S_crofton[0] * all / surface - 1.0, found.M[0] * all / breadth - 1.0);
  EXPECT_NEAR(found.V[0] * all / volume, 1.0, 1e-3);
  EXPECT_NEAR(found.S_crofton[0] * all / surface, 1.0, 1e-3);
  EXPECT_NEAR(found.M[0] * all / breadth, 1.0, 1e-3);
  EXPECT_EQ(counts.F[0] - counts.C[0] - counts.E[0] + counts.V[0],
            static_cast<std::int64_t>(balls.size()));
}

// Particles twice as far apart as voxels, through all of fill.
TEST_F(Packing, CoarseParticlesKeepTheSolidFraction) {
  Scene scene = packing_scene(file());
  scene.domain.cell = 2e-6;
  scene.domain.cells = {nx / 2, ny / 2, nz / 2};
  Particles<3> particles;
  SampleReport own;
  fill<3>(scene, own_layers(lattice_layers(scene), world), world, particles, own);
  const SampleReport report = total(own, world);
  double volume = 0.0;
  for (const Ball& ball : packing())
    volume += 4.0 / 3.0 * std::numbers::pi * std::pow(ball.radius, 3);
  const double share = volume / (double{nx} * ny * nz);
  if (rank(world) == 0) {
    std::printf("solid fraction %.6f, of the particles %.6f\n", share,
                1.0 - report.particle_void_fraction);
  }
  EXPECT_NEAR((1.0 - report.particle_void_fraction) / share, 1.0, 1e-3);
}

}  // namespace
}  // namespace poreshock
