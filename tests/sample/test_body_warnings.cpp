// What of bodies and voids can hardly be meant, and what can.
#include <gtest/gtest.h>

#include "poreshock/sample/fill.hpp"
#include "sample_scenes.hpp"

namespace poreshock {
namespace {

/// Bodies in a domain of 1 x 1.2 mm, periodic in x, with sites 5 um apart; 3-D 0.4 x 0.4 x 1.2 mm.
Scene body_scene(std::vector<Body> bodies, int dimension = 2) {
  Scene scene = dimension == 2 ? testing::plane_scene(1e-3, 0.0) : testing::space_scene(1e-3, 0.0);
  scene.sample.kind = SampleKind::none;
  scene.bodies = std::move(bodies);
  return scene;
}

Region box_of(const Triple& low, const Triple& high) {
  return {.shape = BodyShape::box, .low = low, .high = high, .points = {}};
}

Body body_of(const Region& region, const Triple& velocity = {}, int grain = 0) {
  return {.region = region, .grain = grain, .velocity = velocity};
}

Region disc_of(const Triple& center, double radius) {
  return {.center = center, .radius = radius, .points = {}};
}

template <int Dim>
std::vector<std::string> warnings_in(const Scene& scene) {
  Particles<Dim> particles;
  SampleReport report;
  fill<Dim>(scene, own_layers(lattice_layers(scene), MPI_COMM_WORLD), MPI_COMM_WORLD, particles,
            report);
  return body_warnings(scene, total(report, MPI_COMM_WORLD));
}

std::vector<std::string> warnings_of(const Scene& scene) {
  return scene.dimension == 2 ? warnings_in<2>(scene) : warnings_in<3>(scene);
}

void expect_only(const Scene& scene, const std::vector<std::string>& words) {
  const std::vector<std::string> warnings = warnings_of(scene);
  ASSERT_EQ(warnings.size(), 1U) << (warnings.size() > 1 ? warnings[1] : "none");
  for (const std::string& word : words) {
    EXPECT_NE(warnings[0].find(word), std::string::npos) << "'" << word << "' in: " << warnings[0];
  }
}

const Region block = box_of({0.0, 0.0, 0.0}, {0.4e-3, 0.2e-3, 0.4e-3});

TEST(BodyWarnings, OutsideOfTheDomain) {
  for (const int dimension : {2, 3}) {
    const Scene scene =
        body_scene({body_of(block), body_of(disc_of({0.2e-3, -1e-3, -1e-3}, 1e-4))}, dimension);
    expect_only(scene,
                {"body.1 lies outside of the domain", "0 to 0.0012 m along ", "raise domain.size"});
  }
  Scene scene = body_scene({body_of(block)});
  scene.voids = {box_of({2e-3, 0, 0}, {3e-3, 1e-4, 0}), box_of({0, 2e-3, 0}, {1e-4, 3e-3, 0})};
  expect_only(scene, {"void.0, void.1 lie outside"});
}

TEST(BodyWarnings, SmallerThanAParticle) {
  const Region speck = disc_of({0.7e-3, 0.7e-3, 0.0}, 1e-6);
  std::vector<Body> bodies(6, body_of(speck));
  bodies[0] = body_of(block);
  expect_only(body_scene(bodies), {"body.1, body.2, body.3 and 2 more are smaller than a particle",
                                   "at least 5e-06 m wide"});
  Scene scene = body_scene({body_of(block)});
  scene.voids = {disc_of({0.1e-3, 0.1e-3, 0.0}, 1e-6)};
  expect_only(scene, {"void.0 is smaller than a particle"});
}

TEST(BodyWarnings, CutByTheDomain) {
  expect_only(body_scene({body_of(box_of({-1e-4, 0, 0}, {1e-4, 1e-4, 0}))}),
              {"body.0 reaches out of the domain", "at periodic sides", "moved by domain.size"});
  expect_only(body_scene({body_of(disc_of({0.5e-3, 1.2e-3, 0}, 1e-4))}), {"body.0 reaches out"});
  // Less than a layer of particles is nothing.
  EXPECT_TRUE(warnings_of(body_scene({body_of(box_of({-2e-6, 0, 0}, {1e-4, 1e-4, 0}))})).empty());
  EXPECT_TRUE(warnings_of(body_scene({body_of(box_of({0, 0, 0}, {1e-3, 1.2e-3, 0}))})).empty());
}

TEST(BodyWarnings, ReplacingWhatLiesUnderIt) {
  // 20 x 20 sites of the corner that both have.
  const Region other = box_of({0.3e-3, 0.1e-3, 0}, {0.6e-3, 0.6e-3, 0});
  Scene scene = body_scene({body_of(block), body_of(other)});
  EXPECT_TRUE(warnings_of(scene).empty());  // of one piece
  scene.materials.push_back(scene.materials[0]);
  scene.bodies[1].material = 1;
  expect_only(scene, {"body.1 replaces 400 particles that lie under it"});
  scene.bodies[1].region = block;
  const std::vector<std::string> warnings = warnings_of(scene);
  ASSERT_EQ(warnings.size(), 2U);
  EXPECT_NE(warnings[1].find("body.0 has no particle left"), std::string::npos) << warnings[1];
  scene.bodies[1].region = box_of({0.0, 0.2025e-3, 0}, {0.4e-3, 0.4e-3, 0});
  scene.bodies[0].region.high[1] = 0.2025e-3;  // sites on the face
  EXPECT_TRUE(warnings_of(scene).empty());
  scene.bodies = {body_of(disc_of({0.5e-3, 0.5e-3, 0}, 1e-4), {}, 2)};
  scene.sample.kind = SampleKind::solid;
  expect_only(scene, {"body.0 replaces ", "of the sample or of a [[body]] before it"});
  scene.bodies[0].region.center[1] = 1.05e-3;
  scene.sample.height = 0.5e-3;
  EXPECT_TRUE(warnings_of(scene).empty());
}

TEST(BodyWarnings, VoidsWhereNothingIs) {
  Scene scene = body_scene({body_of(block)});
  scene.voids = {disc_of({0.7e-3, 0.7e-3, 0.0}, 1e-4)};
  expect_only(scene, {"void.0 takes nothing away"});
  scene.voids = {disc_of({0.2e-3, 0.2e-3, 0.0}, 1e-4)};
  EXPECT_TRUE(warnings_of(scene).empty());
}

TEST(BodyWarnings, PolygonsThatCrossThemselves) {
  const auto polygon = [](std::vector<Triple> points) {
    for (Triple& p : points) p = {1e-4 * p[0], 1e-4 * p[1], 0.0};
    return Region{.shape = BodyShape::polygon, .points = std::move(points)};
  };
  const Region bow = polygon({{1, 1}, {5, 5}, {5, 1}, {1, 6}});
  expect_only(body_scene({body_of(bow)}),
              {"body.0 crosses itself: the edges from points 0 and 2 meet", "in their order"});
  const Region star = polygon({{3, 1}, {4.5, 5.5}, {0.7, 2.7}, {5.4, 2.7}, {1.5, 5.5}});
  Scene scene = body_scene({body_of(block)});
  scene.voids = {star, bow};
  expect_only(scene, {"void.0, void.1 cross themselves"});
  const Region hook = polygon({{1, 1}, {5, 1}, {5, 5}, {4, 5}, {4, 2}, {2, 2}, {2, 5}, {1, 5}});
  EXPECT_TRUE(warnings_of(body_scene({body_of(hook)})).empty());
}

TEST(BodyWarnings, OneGrainOfDifferentVelocities) {
  const Region flyer = box_of({0.0, 0.3e-3, 0.0}, {0.4e-3, 0.4e-3, 0.4e-3});
  for (const int dimension : {2, 3}) {
    Triple down{};
    down[static_cast<std::size_t>(dimension - 1)] = -200.0;
    expect_only(body_scene({body_of(block), body_of(flyer, down)}, dimension),
                {"body.0 and body.1 have different velocities, but are one grain, number 0", "weld",
                 "a grain of its own, 1 or more"});
    EXPECT_TRUE(
        warnings_of(body_scene({body_of(block), body_of(flyer, down, 1)}, dimension)).empty());
    EXPECT_TRUE(
        warnings_of(body_scene({body_of(block, down), body_of(flyer, down)}, dimension)).empty());
  }
  // A grain that has contact with itself does not weld.
  Scene scene = body_scene({body_of(block), body_of(flyer, {0.0, -200.0, 0.0})});
  scene.contact.self = true;
  EXPECT_TRUE(warnings_of(scene).empty());
  scene = body_scene({body_of(flyer, {0.0, -200.0, 0.0})});
  scene.sample.kind = SampleKind::solid;
  scene.sample.height = 0.2e-3;
  expect_only(scene, {"the sample and body.0 have different velocities"});
  scene = body_scene({body_of(block, {}, 3), body_of(flyer, {}, 3)});
  scene.bodies[1].spin[2] = 1e5;
  expect_only(scene, {"body.0 and body.1", "number 3"});
}

}  // namespace
}  // namespace poreshock
