#include <gtest/gtest.h>

#include <algorithm>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/sample/fill.hpp"
#include "small_blocks.hpp"

namespace poreshock {
namespace {

using namespace testing;

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
  EXPECT_EQ(filled<2>(scene).particles.size(), 120U);
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
