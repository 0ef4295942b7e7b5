#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <queue>

#include "poreshock/sample/fill.hpp"
#include "sample_scenes.hpp"

namespace poreshock {
namespace {

/// What flood filling the sample site by site finds.
struct Flooded {
  std::vector<std::int64_t> kept;  ///< ids of the largest piece, ascending
  std::int64_t islands = 0;
  std::int64_t island_particles = 0;
};

using Site = std::array<int, 3>;

struct Grid {
  const Scene& scene;
  Site count{1, 1, 1};
  double spacing = 0.0;

  std::int64_t number(const Site& s) const {
    return (static_cast<std::int64_t>(s[2]) * count[1] + s[1]) * count[0] + s[0];
  }

  bool solid(const Site& s, const std::vector<Void>& voids) const {
    for (const Void& v : voids) {
      double square = 0.0;
      for (int a = 0; a < scene.dimension; ++a) {
        double d = std::fabs((s[a] + 0.5) * spacing - v.center[a]);
        const bool wraps = a < scene.dimension - 1 && scene.domain.periodic[a];
        if (wraps) d = std::min(d, scene.domain.size[a] - d);
        square += d * d;
      }
      if (square <= v.radius * v.radius) return false;
    }
    return true;
  }

  /// Neighbour one step along an axis; false when it lies outside.
  bool step(Site& s, int axis, int way) const {
    s[axis] += way;
    const bool wraps = axis < scene.dimension - 1 && scene.domain.periodic[axis];
    if (wraps) s[axis] = (s[axis] + count[axis]) % count[axis];
    return s[axis] >= 0 && s[axis] < count[axis];
  }
};

std::vector<std::int64_t> flood(const Grid& grid, const Site& start,
                                std::map<std::int64_t, bool>& open) {
  std::vector<std::int64_t> piece;
  std::queue<Site> waiting({start});
  open.at(grid.number(start)) = false;
  while (!waiting.empty()) {
    const Site site = waiting.front();
    waiting.pop();
    piece.push_back(grid.number(site));
    for (int axis = 0; axis < grid.scene.dimension; ++axis) {
      for (const int way : {-1, 1}) {
        Site next = site;
        if (!grid.step(next, axis, way)) continue;
        bool& is_open = open.at(grid.number(next));
        if (is_open) waiting.push(next);
        is_open = false;
      }
    }
  }
  return piece;
}

Flooded flood_fill(const Scene& scene, const std::vector<Void>& voids) {
  const double spacing = scene.domain.cell / scene.sample.particles_per_cell;
  Grid grid{scene, {1, 1, 1}, spacing};
  for (int a = 0; a < scene.dimension; ++a) {
    grid.count[a] = scene.domain.cells[a] * scene.sample.particles_per_cell;
  }
  // The tests' heights are multiples of the spacing.
  grid.count[scene.dimension - 1] = static_cast<int>(std::lround(scene.sample.height / spacing));
  std::map<std::int64_t, bool> open;
  std::vector<Site> sites;
  for (int k = 0; k < grid.count[2]; ++k) {
    for (int j = 0; j < grid.count[1]; ++j) {
      for (int i = 0; i < grid.count[0]; ++i) {
        sites.push_back({i, j, k});
        open[grid.number({i, j, k})] = grid.solid({i, j, k}, voids);
      }
    }
  }
  Flooded result;
  std::int64_t solid_sites = 0;
  std::int64_t pieces = 0;
  for (const Site& site : sites) {
    if (!open.at(grid.number(site))) continue;
    const std::vector<std::int64_t> piece = flood(grid, site, open);
    ++pieces;
    solid_sites += static_cast<std::int64_t>(piece.size());
    if (piece.size() > result.kept.size()) result.kept = piece;
  }
  std::sort(result.kept.begin(), result.kept.end());
  result.islands = pieces - 1;
  result.island_particles = solid_sites - static_cast<std::int64_t>(result.kept.size());
  return result;
}

template <int Dim>
Flooded expect_flood_fill(const Scene& scene) {
  Particles<Dim> particles;
  SampleReport report;
  fill(scene, {0, lattice_layers(scene)}, MPI_COMM_SELF, particles, report);
  const Flooded expected = flood_fill(scene, report.voids);
  EXPECT_EQ(particles.id, expected.kept);
  EXPECT_EQ(report.islands, expected.islands);
  EXPECT_EQ(report.island_particles, expected.island_particles);
  return expected;
}

TEST(Islands, AgreeWithAFloodFillAt65PerCent) {
  for (const bool periodic : {true, false}) {
    for (const std::uint64_t seed : {1, 2, 3}) {
      Scene scene = testing::plane_scene(1e-3, 0.65);
      scene.domain.periodic = {periodic, false};
      scene.sample.overlap = true;
      scene.sample.seed = seed;
      const Flooded found = expect_flood_fill<2>(scene);
      EXPECT_GT(found.islands, 5);
      EXPECT_GT(found.island_particles, 50);
    }
  }
}

TEST(Islands, AgreeWithAFloodFillIn3D) {
  for (const bool periodic : {true, false}) {
    Scene scene = testing::space_scene(0.4e-3, 0.6);
    scene.domain.periodic = {periodic, periodic};
    scene.sample.overlap = true;
    EXPECT_GT(expect_flood_fill<3>(scene).islands, 5);
  }
}

TEST(Islands, StayWhereVoidsKeepTheirDistance) {
  Scene scene = testing::plane_scene(1e-3, 0.6);
  Particles<2> particles;
  SampleReport report;
  fill(scene, {0, lattice_layers(scene)}, MPI_COMM_SELF, particles, report);
  EXPECT_EQ(report.islands, 0);
  EXPECT_EQ(report.island_particles, 0);
}

TEST(Islands, ExplicitVoidsCutPiecesOffAndBodiesStay) {
  Scene scene = testing::plane_scene(1e-3, 0.05);
  scene.sample.overlap = true;
  scene.sample.keep_out = 0.2e-3;
  // A ditch under the top parts a strip of 1 mm x 0.1 mm from the rest: 200 x 20 sites.
  Region ditch;
  ditch.shape = BodyShape::box;
  ditch.low = {0.0, 0.85e-3, 0.0};
  ditch.high = {1e-3, 0.9e-3, 0.0};
  scene.voids = {ditch};
  Particles<2> particles;
  SampleReport report;
  fill(scene, {0, lattice_layers(scene)}, MPI_COMM_SELF, particles, report);
  EXPECT_EQ(report.islands, 1);
  EXPECT_EQ(report.island_particles, 4000);
  // A body over half of the strip keeps its own particles.
  Body body;
  body.region = ditch;
  body.region.low = {0.0, 0.9e-3, 0.0};
  body.region.high = {0.5e-3, 1e-3, 0.0};
  body.grain = 1;
  scene.bodies = {body};
  fill(scene, {0, lattice_layers(scene)}, MPI_COMM_SELF, particles, report);
  EXPECT_EQ(report.island_particles, 2000);
  EXPECT_EQ(std::count(particles.grain.begin(), particles.grain.end(), 1), 2000);
}

}  // namespace
}  // namespace poreshock
