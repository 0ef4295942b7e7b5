#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <numbers>
#include <set>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/sample/fill.hpp"
#include "sample_scenes.hpp"

namespace poreshock {
namespace {

using testing::plane_scene;
using testing::space_scene;

template <int Dim>
Particles<Dim> filled(const Scene& scene, LatticeRange range, SampleReport& report,
                      MPI_Comm communicator = MPI_COMM_SELF) {
  Particles<Dim> particles;
  fill(scene, range, communicator, particles, report);
  return particles;
}

template <int Dim>
Particles<Dim> filled(const Scene& scene) {
  SampleReport report;
  return filled<Dim>(scene, {0, lattice_layers(scene)}, report);
}

Region box(Triple low, Triple high) {
  Region region;
  region.shape = BodyShape::box;
  region.low = low;
  region.high = high;
  return region;
}

/// An empty domain of 10 x 10 cells of 1 m with one material.
Scene small_scene() {
  Scene scene = plane_scene(10.0, 0.0);
  scene.sample.kind = SampleKind::none;
  scene.domain.cell = 1.0;
  scene.domain.size = {10.0, 10.0, 0.0};
  scene.domain.cells = {10, 10, 0};
  return scene;
}

TEST(Fill, SolidBlockIsTheWholeLatticeBelowItsHeight) {
  Scene scene = small_scene();
  scene.sample.kind = SampleKind::solid;
  scene.sample.height = 3.3;  // centres at 0.25, 0.75, ... 3.25: seven layers
  scene.loading.velocity = 1100.0;
  scene.loading.frame = {3.0, 5.0, 0.0};
  SampleReport report;
  const Particles<2> particles = filled<2>(scene, {0, lattice_layers(scene)}, report);
  ASSERT_EQ(particles.size(), 140U);
  EXPECT_EQ(report.lattice_sites, 140);
  EXPECT_EQ(report.particle_void_fraction, 0.0);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    EXPECT_EQ(particles.id[p], static_cast<std::int64_t>(p));
    const std::size_t column = p % 20, layer = p / 20;
    EXPECT_EQ(particles.position[0][p], 0.25 + 0.5 * static_cast<double>(column));
    EXPECT_EQ(particles.position[1][p], 0.25 + 0.5 * static_cast<double>(layer));
    EXPECT_EQ(particles.velocity[0][p], 3.0);
    EXPECT_EQ(particles.velocity[1][p], -1095.0);
    EXPECT_EQ(particles.mass[p], 675.0);
    EXPECT_EQ(particles.density[p], 2700.0);
    EXPECT_EQ(particles.pressure[p], 0.0);
    EXPECT_EQ(particles.grain[p], 0);
  }
}

TEST(Fill, ASiteAtTheVeryHeightIsOutside) {
  Scene scene = small_scene();
  scene.sample.kind = SampleKind::solid;
  scene.sample.height = 3.25;
  EXPECT_EQ(filled<2>(scene).size(), 120U);
}

TEST(Fill, TheVoidFractionOfParticlesFollowsTheGeometry) {
  const Scene scene = testing::refined(plane_scene(2e-3, 0.3));
  SampleReport report;
  const Particles<2> particles = filled<2>(scene, {0, lattice_layers(scene)}, report);
  EXPECT_NEAR(report.geometric_void_fraction, 0.3, 1e-14);
  // 119 voids of 804 sites each; a random lattice offset leaves about 6 sites of error a void.
  EXPECT_NEAR(report.particle_void_fraction, 0.3, 4.0 * 6.0 * std::sqrt(119.0) / 320000.0);
  EXPECT_EQ(report.lattice_sites, 320000);
  EXPECT_EQ(report.block_particles, static_cast<std::int64_t>(particles.size()));
  EXPECT_GE(report.least_gap, 0.0);
  // No particle lies in a void or in an image of one.
  for (std::size_t p = 0; p < particles.size(); ++p) {
    for (const Void& v : report.voids) {
      double dx = std::fabs(particles.position[0][p] - v.center[0]);
      dx = std::min(dx, 1e-3 - dx);
      const double dy = particles.position[1][p] - v.center[1];
      ASSERT_GT(std::sqrt(dx * dx + dy * dy), v.radius * (1.0 - 1e-12));
    }
  }
}

template <int Dim>
void expect_same_for_any_split(const Scene& scene) {
  SampleReport whole;
  const Particles<Dim> all = filled<Dim>(scene, {0, lattice_layers(scene)}, whole);
  Particles<Dim> joined;
  SampleReport sum;
  std::int64_t first = 0;
  for (const std::int64_t last : {std::int64_t{1}, std::int64_t{17}, std::int64_t{18},
                                  std::int64_t{50}, lattice_layers(scene)}) {
    SampleReport part;
    const Particles<Dim> some = filled<Dim>(scene, {first, last}, part);
    const std::size_t start = joined.size();
    resize(joined, start + some.size());
    auto copy = [&](auto& to, const auto& from) {
      std::copy(from.begin(), from.end(), to.begin() + static_cast<std::ptrdiff_t>(start));
    };
    copy(joined.id, some.id);
    copy(joined.mass, some.mass);
    for (std::size_t a = 0; a < Dim; ++a) copy(joined.position[a], some.position[a]);
    for (std::size_t a = 0; a < Dim; ++a) copy(joined.velocity[a], some.velocity[a]);
    sum.lattice_sites += part.lattice_sites;
    sum.particles += part.particles;
    sum.islands += part.islands;
    sum.island_particles += part.island_particles;
    EXPECT_EQ(part.least_gap, whole.least_gap);
    EXPECT_EQ(part.geometric_void_fraction, whole.geometric_void_fraction);
    first = last;
  }
  EXPECT_EQ(joined.id, all.id);
  EXPECT_EQ(joined.position, all.position);
  EXPECT_EQ(joined.velocity, all.velocity);
  EXPECT_EQ(joined.mass, all.mass);
  EXPECT_EQ(sum.lattice_sites, whole.lattice_sites);
  EXPECT_EQ(sum.particles, whole.particles);
  EXPECT_EQ(sum.islands, whole.islands);
  EXPECT_EQ(sum.island_particles, whole.island_particles);
}

TEST(Fill, AnySplitOfTheLatticeGivesTheSameParticles) {
  Scene scene = plane_scene(1e-3, 0.4);
  expect_same_for_any_split<2>(scene);
  scene.sample.porosity = 0.6;
  scene.sample.overlap = true;
  expect_same_for_any_split<2>(scene);
  expect_same_for_any_split<3>(space_scene(0.3e-3, 0.25));
}

TEST(Fill, RanksTogetherMakeTheWholeSample) {
  const MPI_Comm world = MPI_COMM_WORLD;
  Scene scene = plane_scene(1e-3, 0.6);
  scene.sample.overlap = true;
  SampleReport whole;
  const Particles<2> all = filled<2>(scene, {0, lattice_layers(scene)}, whole);
  SampleReport part;
  const Particles<2> some = filled<2>(scene, own_layers(lattice_layers(scene), world), part, world);
  EXPECT_EQ(gather_all(some.id, world), all.id);
  const SampleReport report = total(part, world);
  EXPECT_EQ(report.particles, static_cast<std::int64_t>(all.size()));
  EXPECT_EQ(report.lattice_sites, whole.lattice_sites);
  EXPECT_EQ(report.block_particles, whole.block_particles);
  EXPECT_EQ(report.islands, whole.islands);
  EXPECT_EQ(report.island_particles, whole.island_particles);
  EXPECT_EQ(report.particle_void_fraction, whole.particle_void_fraction);
  EXPECT_EQ(sum(static_cast<std::int64_t>(some.size()), world), report.particles);
}

TEST(Fill, NothingAtAllIsAnErrorOnEveryRank) {
  const Scene scene = small_scene();
  SampleReport report;
  const Particles<2> particles = filled<2>(scene, {0, lattice_layers(scene)}, report);
  EXPECT_EQ(particles.size(), 0U);
  EXPECT_THROW(total(report, MPI_COMM_WORLD), InputError);
}

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
  const Particles<2> particles = filled<2>(scene);
  EXPECT_EQ(std::count(particles.grain.begin(), particles.grain.end(), 1), 200 * 100);
}

TEST(Fill, ADiscIsFilledToItsArea) {
  Scene scene = small_scene();
  scene.sample.particles_per_cell = 40;
  Body disc;
  disc.region.center = {5.0, 5.0, 0.0};
  disc.region.radius = 2.0;
  scene.bodies = {disc};
  const Particles<2> particles = filled<2>(scene);
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
  EXPECT_EQ(filled<2>(scene).size(), 4U * (8U + 6U));
}

TEST(Fill, SpinTurnsABodyAboutItsCentroidIn2D) {
  Scene scene = small_scene();
  Body body;
  body.region = box({2.0, 2.0, 0.0}, {4.0, 6.0, 0.0});
  body.velocity = {10.0, 20.0, 0.0};
  body.spin = {7.0, 7.0, 3.0};  // only z counts in 2-D
  scene.bodies = {body};
  scene.loading.velocity = 100.0;
  const Particles<2> particles = filled<2>(scene);
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
  const Particles<3> particles = filled<3>(scene);
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

TEST(Fill, LatticeIdsRunXFirstIn3D) {
  Scene scene = small_scene();
  scene.dimension = 3;
  scene.domain.size = {2.0, 3.0, 4.0};
  scene.domain.cells = {2, 3, 4};
  scene.sample.particles_per_cell = 1;
  scene.sample.kind = SampleKind::solid;
  scene.sample.height = 4.0;
  SampleReport report;
  const Particles<3> particles = filled<3>(scene, {1, 3}, report);
  ASSERT_EQ(particles.size(), 12U);
  EXPECT_EQ(particles.id.front(), 6);
  EXPECT_EQ(particles.id.back(), 17);
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double id = particles.position[0][p] - 0.5 + 2.0 * (particles.position[1][p] - 0.5) +
                      6.0 * (particles.position[2][p] - 0.5);
    EXPECT_EQ(static_cast<double>(particles.id[p]), id);
  }
}

TEST(Fill, BallsLeaveRoundHolesIn3D) {
  const Scene scene = space_scene(0.4e-3, 0.3);
  SampleReport report;
  filled<3>(scene, {0, lattice_layers(scene)}, report);
  EXPECT_NEAR(report.geometric_void_fraction, 0.3, 1e-14);
  EXPECT_EQ(report.lattice_sites, 80 * 80 * 80);
  // 72 balls of 2145 sites each; a random lattice offset leaves about 20 sites of error a ball.
  EXPECT_NEAR(report.particle_void_fraction, 0.3, 4.0 * 20.0 * std::sqrt(72.0) / 512000.0);
}

TEST(Fill, ColumnsOfModesNotInUseStayEmpty) {
  Scene scene = small_scene();
  scene.sample.kind = SampleKind::solid;
  scene.sample.height = 1.0;
  Particles<2> particles;
  particles.options.affine = false;
  SampleReport report;
  fill(scene, {0, lattice_layers(scene)}, MPI_COMM_SELF, particles, report);
  EXPECT_EQ(particles.size(), 40U);
  EXPECT_TRUE(particles.affine[0].empty());
  EXPECT_TRUE(particles.quadratic[0].empty());
}

}  // namespace
}  // namespace poreshock
