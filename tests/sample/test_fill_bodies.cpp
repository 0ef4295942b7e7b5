// Bodies on the lattice: which one owns a site, how much they fill, and how they spin.
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <set>

#include "small_blocks.hpp"

namespace poreshock {
namespace {

using namespace testing;

TEST(Fill, TheLastBodyOwnsASiteAndVoidsTakeAll) {
  Scene scene = small_scene();
  scene.sample.kind = SampleKind::solid;
  scene.sample.height = 4.0;
  MaterialParameters copper = scene.materials[0];
  copper.density = 8900.0;
  scene.materials.push_back(copper);
  Body lower;
  lower.region = box({2.0, 2.0, 0.0}, {6.0, 8.0, 0.0});
  lower.material = 1;
  lower.grain = 3;  // one grain of two bodies: others may not overlap
  Body upper;
  upper.region = box({4.0, 6.0, 0.0}, {8.0, 9.0, 0.0});
  upper.grain = 3;
  scene.bodies = {lower, upper};
  scene.voids = {box({5.0, 3.0, 0.0}, {7.0, 7.0, 0.0})};
  SampleReport report;
  const Particles<2> particles = filled<2>(scene, {0, lattice_layers(scene)}, report);
  std::map<std::pair<int, int>, int> count;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    ++count[{particles.grain[p], particles.material[p]}];
    EXPECT_EQ(particles.density[p], particles.material[p] == 1 ? 8900.0 : 2700.0);
  }
  // In unit squares (four sites each): sample 40 - 8 (lower) - 1 (void); lower 24 - 4 (upper) - 3;
  // upper 12 - 2.
  const std::map<std::pair<int, int>, int> expected = {
      {{0, 0}, 4 * 31}, {{3, 1}, 4 * 17}, {{3, 0}, 4 * 10}};
  EXPECT_EQ(count, expected);
  EXPECT_EQ(report.lattice_sites, 4 * 40);
  EXPECT_EQ(report.block_particles, 4 * (31 + 8 - 1));
  EXPECT_EQ(report.particles, 4 * 58);
  const std::vector<RegionSites> bodies = {{4 * 24, 4 * 8, 4 * 17}, {4 * 12, 4 * 4, 4 * 10}};
  EXPECT_EQ(report.bodies, bodies);
  EXPECT_EQ(report.hollows, (std::vector<RegionSites>{{4 * 8, 4 * 6, 0}}));
  const std::set<std::int64_t> ids(particles.id.begin(), particles.id.end());
  EXPECT_EQ(ids.size(), particles.size());
}

TEST(Fill, ABodyFillsAGeneratedVoid) {
  Scene scene = plane_scene(1e-3, 0.3);
  Body plug;
  plug.region = box({0.0, 0.0, 0.0}, {1e-3, 0.5e-3, 0.0});
  plug.grain = 1;
  scene.bodies = {plug};
  const Particles<2> particles = filled<2>(scene).particles;
  EXPECT_EQ(std::count(particles.grain.begin(), particles.grain.end(), 1), 200 * 100);
}

TEST(Fill, ADiscIsFilledToItsArea) {
  Scene scene = small_scene();
  scene.sample.particles_per_cell = 40;
  Body disc;
  disc.region.center = {5.0, 5.0, 0.0};
  disc.region.radius = 2.0;
  scene.bodies = {disc};
  const Particles<2> particles = filled<2>(scene).particles;
  double mass = 0.0;
  for (const double m : particles.mass) mass += m;
  EXPECT_NEAR(mass / 2700.0, 4.0 * std::numbers::pi, 1e-3 * 4.0 * std::numbers::pi);
}

TEST(Fill, APolygonIsFilledExactlyWhenItsSidesAreLatticePlanes) {
  Scene scene = small_scene();
  Body corner;
  corner.region.shape = BodyShape::polygon;
  corner.region.points = {{1, 1, 0}, {5, 1, 0}, {5, 3, 0}, {3, 3, 0}, {3, 6, 0}, {1, 6, 0}};
  scene.bodies = {corner};
  EXPECT_EQ(filled<2>(scene).particles.size(), 4U * (8U + 6U));
}

TEST(Fill, SpinTurnsABodyAboutItsCentroidIn2D) {
  Scene scene = small_scene();
  Body body;
  body.region = box({2.0, 2.0, 0.0}, {4.0, 6.0, 0.0});
  body.velocity = {10.0, 20.0, 0.0};
  body.spin = {7.0, 7.0, 3.0};  // only z counts in 2-D
  scene.bodies = {body};
  scene.loading.velocity = 100.0;
  const Particles<2> particles = filled<2>(scene).particles;
  ASSERT_EQ(particles.size(), 32U);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    EXPECT_DOUBLE_EQ(particles.velocity[0][p], 10.0 - 3.0 * (particles.position[1][p] - 4.0));
    EXPECT_DOUBLE_EQ(particles.velocity[1][p], -80.0 + 3.0 * (particles.position[0][p] - 3.0));
    EXPECT_EQ(particles.affine[0][p], 0.0);
    EXPECT_EQ(particles.affine[1][p], -3.0);
    EXPECT_EQ(particles.affine[2][p], 3.0);
    EXPECT_EQ(particles.affine[3][p], 0.0);
  }
}

TEST(Fill, SpinIsACrossProductIn3D) {
  Scene scene = small_scene();
  scene.dimension = 3;
  scene.domain.size = {10.0, 10.0, 10.0};
  scene.domain.cells = {10, 10, 10};
  Body body;
  body.region = box({2.0, 2.0, 2.0}, {4.0, 6.0, 8.0});
  body.spin = {1.0, 2.0, 3.0};
  scene.bodies = {body};
  scene.loading.velocity = 100.0;
  const Particles<3> particles = filled<3>(scene).particles;
  ASSERT_EQ(particles.size(), 8U * 48U);
  const Triple w = body.spin;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Triple r{particles.position[0][p] - 3.0, particles.position[1][p] - 4.0,
                   particles.position[2][p] - 5.0};
    const Triple v{w[1] * r[2] - w[2] * r[1], w[2] * r[0] - w[0] * r[2],
                   w[0] * r[1] - w[1] * r[0] - 100.0};
    for (std::size_t i = 0; i < 3; ++i) {
      EXPECT_NEAR(particles.velocity[i][p], v[i], 1e-13);
      double product = 0.0;
      for (std::size_t j = 0; j < 3; ++j) product += particles.affine[3 * i + j][p] * r[j];
      EXPECT_NEAR(product, v[i] + (i == 2 ? 100.0 : 0.0), 1e-13);
    }
    EXPECT_EQ(particles.mass[p], 2700.0 / 8.0);
  }
}

}  // namespace
}  // namespace poreshock
