// Grains: packed, Voronoi and of islands; their numbers, materials and errors.
#include <gtest/gtest.h>

#include <map>
#include <numbers>
#include <set>

#include "filled.hpp"

namespace poreshock {
namespace {

using namespace testing;

/// Least distance between the surfaces of two grains, periodic in x.
double least_distance(const Scene& scene, const std::vector<Grain>& grains) {
  double least = 1.0;
  for (std::size_t i = 0; i < grains.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      double square = 0.0;
      for (int a = 0; a < scene.dimension; ++a) {
        double d = std::fabs(grains[i].center[a] - grains[j].center[a]);
        if (a + 1 < scene.dimension) d = std::min(d, scene.domain.size[a] - d);
        square += d * d;
      }
      least = std::min(least, std::sqrt(square) - grains[i].radius - grains[j].radius);
    }
  }
  return least;
}

// From loose to nearly jammed: the share is exact, nothing overlaps, all lie inside the block.
TEST(PackedGrains, MeetTheVoidFractionWithoutOverlap) {
  for (const double porosity : {0.46, 0.25, 0.19}) {
    Scene scene = grain_scene(SampleKind::packed_grains, porosity);
    scene.sample.grain_gap = 1e-6;
    const Filled<2> made = filled<2>(scene);
    const std::vector<Grain>& grains = made.report.grains;
    ASSERT_GT(grains.size(), 30U);
    double area = 0.0;
    for (const Grain& g : grains) {
      area += std::numbers::pi * g.radius * g.radius;
      EXPECT_GE(g.center[1], g.radius);
      EXPECT_LE(g.center[1], scene.sample.height - g.radius);
    }
    EXPECT_NEAR(area / 1e-6, 1.0 - porosity, 1e-12);
    EXPECT_NEAR(made.report.geometric_void_fraction, porosity, 1e-12);
    EXPECT_GE(least_distance(scene, grains), 1e-6 * (1.0 - 1e-9));
    EXPECT_NEAR(made.report.least_gap, least_distance(scene, grains), 1e-15);
    EXPECT_NEAR(made.report.particle_void_fraction, porosity, 0.004);
  }
}

TEST(PackedGrains, SizesSpreadAsAsked) {
  Scene scene = grain_scene(SampleKind::packed_grains, 0.4);
  scene.sample.grain_radius = 12e-6;
  scene.sample.grain_spread = 0.3;
  const std::vector<Grain> grains = filled<2>(scene).report.grains;
  ASSERT_GT(grains.size(), 800U);
  double mean = 0.0, square = 0.0;
  for (const Grain& g : grains) mean += std::log(g.radius) / static_cast<double>(grains.size());
  for (const Grain& g : grains) square += std::pow(std::log(g.radius) - mean, 2);
  EXPECT_NEAR(std::sqrt(square / static_cast<double>(grains.size())), 0.3, 0.03);
  EXPECT_NEAR(std::exp(mean), 12e-6, 0.4e-6);
}

TEST(PackedGrains, BallsIn3D) {
  const Scene scene = grain_scene(SampleKind::packed_grains, 0.5, 3);
  const Filled<3> made = filled<3>(scene);
  double volume = 0.0;
  for (const Grain& g : made.report.grains) volume += g.measure;
  EXPECT_NEAR(volume / 6.4e-11, 0.5, 1e-12);
  EXPECT_GE(least_distance(scene, made.report.grains), 0.0);
  EXPECT_NEAR(made.report.particle_void_fraction, 0.5, 0.005);
}

/// Least distance between particles of different grains up to `limit`, m; particles in id order.
double particle_gap(const Particles<2>& particles, double width, double limit) {
  double least = limit;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    for (std::size_t q = p; q-- > 0;) {
      if (particles.position[1][p] - particles.position[1][q] > limit) break;
      if (particles.grain[p] == particles.grain[q]) continue;
      double dx = std::fabs(particles.position[0][p] - particles.position[0][q]);
      dx = std::min(dx, width - dx);
      least = std::min(least, std::hypot(dx, particles.position[1][p] - particles.position[1][q]));
    }
  }
  return least;
}

// Solid fractions that no disc pack reaches, with a gap that is the same everywhere.
TEST(VoronoiGrains, MeetTheVoidFractionWithAUniformGap) {
  Scene scene = grain_scene(SampleKind::voronoi_grains, 0.077);
  const Filled<2> made = filled<2>(scene);
  EXPECT_NEAR(made.report.geometric_void_fraction, 0.077, 1e-4);
  EXPECT_NEAR(made.report.particle_void_fraction, 0.077, 0.006);
  EXPECT_NEAR(static_cast<double>(made.report.grains.size()), 1e-6 / (3.1416 * 3.6e-9), 12.0);
  // A gap between straight cells of mean area A takes about gap / 2 times their perimeter.
  const double cell = std::sqrt(1e-6 / static_cast<double>(made.report.grains.size()));
  EXPECT_NEAR(made.report.least_gap, 0.077 * cell / 1.95, 0.1 * 0.077 * cell);
  scene.sample.porosity = 0.3;
  const Filled<2> wide = filled<2>(scene);
  // Particles are points: their lattice may leave up to a diagonal more on each side.
  EXPECT_LE(particle_gap(wide.particles, 1e-3, 40e-6), wide.report.least_gap + 2.0 * 7.1e-6);
  EXPECT_GE(particle_gap(wide.particles, 1e-3, 40e-6), wide.report.least_gap);
}

TEST(VoronoiGrains, In3D) {
  const Filled<3> made = filled<3>(grain_scene(SampleKind::voronoi_grains, 0.2, 3));
  EXPECT_NEAR(made.report.geometric_void_fraction, 0.2, 1e-4);
  EXPECT_NEAR(made.report.particle_void_fraction, 0.2, 0.02);
}

// Slabs of a sample are the parts of the whole one, and the sample depends on nothing but its keys.
TEST(Grains, AreTheSameOnAnyNumberOfRanks) {
  for (const SampleKind kind : {SampleKind::packed_grains, SampleKind::voronoi_grains}) {
    Scene scene = grain_scene(kind, 0.3);
    const Filled<2> whole = filled<2>(scene), parts = filled<2>(scene, 3);
    EXPECT_EQ(whole.particles.id, parts.particles.id);
    EXPECT_EQ(whole.particles.grain, parts.particles.grain);
    EXPECT_EQ(whole.particles.material, parts.particles.material);
    const Filled<2> fine = filled<2>(testing::refined(scene));
    ASSERT_EQ(fine.report.grains.size(), whole.report.grains.size());
    for (std::size_t g = 0; g < fine.report.grains.size(); ++g) {
      EXPECT_EQ(fine.report.grains[g].center, whole.report.grains[g].center);
    }
    scene.sample.seed = 8;
    EXPECT_NE(filled<2>(scene).particles.grain, whole.particles.grain);
  }
}

TEST(Grains, TakeTheirMaterialsByVolume) {
  Scene scene = grain_scene(SampleKind::packed_grains, 0.4);
  MaterialParameters tungsten;
  tungsten.name = "tungsten";
  tungsten.density = 19224.0;
  scene.materials.push_back(tungsten);
  scene.sample.mixture = {{0, 0.7}, {1, 0.3}};
  const Filled<2> made = filled<2>(scene);
  double all = 0.0, heavy = 0.0;
  for (const Grain& g : made.report.grains) {
    all += g.measure;
    if (g.material == 1) heavy += g.measure;
  }
  EXPECT_NEAR(heavy / all, 0.3, 0.02);
  for (std::size_t p = 0; p < made.particles.size(); ++p) {
    const std::size_t g = static_cast<std::size_t>(made.particles.grain[p] - 1);
    ASSERT_EQ(made.particles.material[p], made.report.grains[g].material);
    ASSERT_EQ(made.particles.density[p], made.particles.material[p] == 1 ? 19224.0 : 2700.0);
  }
}

// Generated grains are numbered after those of the bodies, which cut into them.
TEST(Grains, KeepApartFromBodies) {
  Scene scene = grain_scene(SampleKind::packed_grains, 0.4);
  Body plate;
  plate.region.shape = BodyShape::box;
  plate.region.low = {0.0, 0.9e-3, 0.0};
  plate.region.high = {1e-3, 1.1e-3, 0.0};
  plate.grain = 5;
  scene.bodies = {plate};
  EXPECT_EQ(first_grain_number(scene), 6);
  const Filled<2> made = filled<2>(scene);
  for (std::size_t p = 0; p < made.particles.size(); ++p) {
    const bool plated = made.particles.position[1][p] > 0.9e-3;
    ASSERT_EQ(made.particles.grain[p] == 5, plated);
    ASSERT_GE(made.particles.grain[p], 5);
  }
}

TEST(Grains, JammedPackingSaysWhere) {
  Scene scene = grain_scene(SampleKind::packed_grains, 0.14);
  const std::string text = error_of(scene);
  expect_words(text, {"sample.porosity = 0.14 cannot be packed", "6e-05 m",
                      "jam at a void fraction", "voronoi_grains"});
  const std::string mark = "void fraction of ";
  const double reached = std::stod(text.substr(text.find(mark) + mark.size()));
  EXPECT_GT(reached, 0.14);
  EXPECT_LT(reached, 0.25);
  scene.sample.grain_radius = 0.7e-3;
  expect_words(error_of(scene), {"grains in the sample block"});
}

TEST(Grains, TooLargeForTheBlockSaysWhatToLower) {
  Scene scene = grain_scene(SampleKind::packed_grains, 0.4);
  scene.sample.keep_out = 0.45e-3;
  expect_words(error_of(scene), {"The largest grain", "but the sample block is",
                                 "Lower sample.grain_radius", "sample.grain_spread"});
  // A single Voronoi grain would be as large as the block and as wide as no side of it.
  scene = grain_scene(SampleKind::voronoi_grains, 0.077);
  scene.sample.grain_radius = 0.53e-3;
  expect_words(error_of(scene), {"The largest grain, of radius 0.00056", "is 0.001 m wide"});
}

TEST(Grains, OverlappingBodiesOfTwoGrainsAreRefused) {
  Scene scene = grain_scene(SampleKind::none, 0.0);
  Body a, b;
  a.region = {.center = {0.3e-3, 0.3e-3, 0.0}, .radius = 0.1e-3, .points = {}};
  b.region = {.center = {0.49e-3, 0.3e-3, 0.0}, .radius = 0.1e-3, .points = {}};
  a.grain = 1;
  b.grain = 2;
  scene.bodies = {a, b};
  expect_words(error_of(scene),
               {"body.0 (grain 1) and body.1 (grain 2) overlap", "0.00039", "the same grain"});
  scene.bodies[1].grain = 1;
  EXPECT_EQ(error_of(scene), "");
  scene.bodies[1].grain = 2;
  scene.bodies[1].region.center[0] = 0.505e-3;
  EXPECT_EQ(error_of(scene), "");
}

/// Text of the error of two regions as bodies of two grains.
std::string error_of_two(const Region& one, const Region& other, int dimension = 2) {
  Scene scene =
      dimension == 2 ? testing::plane_scene(1e-3, 0.0) : testing::space_scene(0.4e-3, 0.0);
  scene.sample.kind = SampleKind::none;
  scene.bodies.resize(2);
  scene.bodies[0].region = one;
  scene.bodies[1].region = other;
  scene.bodies[0].grain = 1;
  scene.bodies[1].grain = 2;
  return error_of(scene);
}

Region box_of(const Triple& low, const Triple& high) {
  return {.shape = BodyShape::box, .low = low, .high = high, .points = {}};
}

Region polygon_of(std::vector<Triple> points) {
  return {.shape = BodyShape::polygon, .points = std::move(points)};
}

TEST(Grains, BodiesThatTouchWhereSitesLieDoNotOverlap) {
  // Sites lie at 2.5 um, 7.5 um, ...
  const Region lower = box_of({1e-4, 1e-4, 1e-4}, {3e-4, 2.025e-4, 3e-4});
  const Region upper = box_of({1e-4, 2.025e-4, 1e-4}, {3e-4, 3e-4, 3e-4});
  for (const int dimension : {2, 3}) EXPECT_EQ(error_of_two(lower, upper, dimension), "");
  Region higher = upper;
  higher.low[1] -= 4e-9;  // a face to four digits: less than a thousandth of a site
  EXPECT_EQ(error_of_two(lower, higher), "");
  higher.low[1] = 2.02e-4;
  EXPECT_NE(error_of_two(lower, higher), "");
  const Region left = polygon_of({{1e-4, 1e-4, 0}, {9e-4, 1e-4, 0}, {1e-4, 9e-4, 0}});
  EXPECT_EQ(error_of_two(left, polygon_of({{9e-4, 1e-4, 0}, {9e-4, 9e-4, 0}, {1e-4, 9e-4, 0}})),
            "");
  const Region disc = {.center = {3.025e-4, 3.025e-4, 3.025e-4}, .radius = 1e-4, .points = {}};
  const Region ring = {.shape = BodyShape::ring,
                       .center = disc.center,
                       .radius = 1.5e-4,
                       .inner_radius = 1e-4,
                       .points = {}};
  for (const int dimension : {2, 3}) EXPECT_EQ(error_of_two(disc, ring, dimension), "");
  Region larger = disc;
  larger.radius = 1.03e-4;
  for (const int dimension : {2, 3}) EXPECT_NE(error_of_two(larger, ring, dimension), "");
}

TEST(Islands, BecomeGrains) {
  Scene scene = testing::plane_scene(1e-3, 0.6);
  scene.sample.overlap = true;
  const Filled<2> removed = filled<2>(scene);
  scene.sample.islands = Islands::grains;
  const Filled<2> kept = filled<2>(scene, 2);
  ASSERT_GT(removed.report.islands, 2);
  ASSERT_EQ(static_cast<std::int64_t>(kept.report.grains.size()), removed.report.islands);
  ASSERT_EQ(static_cast<std::int64_t>(kept.particles.size()),
            removed.report.particles + removed.report.island_particles);
  std::map<int, double> area;
  for (const int g : kept.particles.grain) area[g] += 25e-12;
  for (std::size_t g = 0; g < kept.report.grains.size(); ++g) {
    EXPECT_NEAR(area[static_cast<int>(g) + 1], kept.report.grains[g].measure, 1e-18);
  }
  EXPECT_EQ(area.size(), kept.report.grains.size() + 1);
}

}  // namespace
}  // namespace poreshock
