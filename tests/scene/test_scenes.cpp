// What is read from a scene, and that a written scene reads back as the same.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "parsed_scene.hpp"
#include "poreshock/material/library.hpp"
#include "poreshock/scene/keys.hpp"
#include "poreshock/scene/particle_options.hpp"

namespace poreshock {
namespace {

TEST(Scenes, EveryKeyOf2D) {
  const Scene scene = parse(rich_2d);
  EXPECT_EQ(scene.title, "a \"quoted\" \\ title\twith a tab");
  EXPECT_EQ(scene.thermal, Thermal::paper);
  EXPECT_EQ(scene.boundary.low, (Side{SideKind::wall, -12.3456789012345678, {}}));
  EXPECT_EQ(scene.boundary.lateral[0], SideKind::symmetry);
  EXPECT_EQ(scene.materials.size(), 2u);
  EXPECT_EQ(scene.materials[0].plastic_heat, PlasticHeat::dissipation);
  EXPECT_EQ(scene.sample.material, 1);
  EXPECT_EQ(scene.sample.seed, 9223372036854775807u);
  ASSERT_EQ(scene.bodies.size(), 3u);
  EXPECT_EQ(scene.bodies[0].spin, (Triple{0.0, 0.0, 1e5}));
  EXPECT_EQ(scene.bodies[0].velocity, (Triple{1.0, -2.0, 0.0}));
  EXPECT_EQ(scene.bodies[0].material, 1);
  EXPECT_EQ(scene.bodies[0].grain, 3);
  EXPECT_EQ(scene.bodies[1].region.points[2], (Triple{0.0, 2.1e-4, 0.0}));
  EXPECT_EQ(scene.bodies[2].region.inner_radius, 2.1e-5);
  EXPECT_EQ(scene.bodies[2].region.radius, 2.2e-5);
  EXPECT_EQ(scene.bodies[2].material, 0);
  EXPECT_EQ(scene.voids[0].high, (Triple{1e-5, 1e-5, 0.0}));
  EXPECT_EQ(scene.loading, (Loading{1100.0, {0.1, 0.3, 0.0}}));
  EXPECT_EQ(scene.body_force, (Triple{0.0, -9.81, 0.0}));
  EXPECT_EQ(scene.transfer, (Transfer{.shape = ShapeFunction::quadratic,
                                      .velocity = VelocityTransfer::flip,
                                      .damping = 0.3,
                                      .gradient = Gradient::moments,
                                      .half_length = 0.5 / 3.0}));
  EXPECT_EQ(scene.viscosity, (Viscosity{.linear = 0.4, .quadratic = 1.5, .limited = false}));
  EXPECT_EQ(scene.time.cfl, 0.3);
  EXPECT_EQ(scene.materials[0].spall, 1e9);
  EXPECT_EQ(scene.materials[1].spall, 0.0);
  EXPECT_TRUE(particle_options(scene).failed);
  EXPECT_TRUE(scene.conduction.on);
  EXPECT_TRUE(conducts_heat(scene));
  EXPECT_EQ(scene.time.max_steps, 1000000000000);
  EXPECT_EQ(scene.output.fields, (std::vector<std::string>{"stress", "id"}));
  EXPECT_EQ(scene.output.precision, Precision::single_precision);
  EXPECT_EQ(scene.checkpoint, (Checkpoint{5, 4e-9, 600.0, 7}));
}

TEST(Scenes, EveryKeyOf3D) {
  const Scene scene = parse(rich_3d);
  EXPECT_EQ(scene.dimension, 3);
  EXPECT_EQ(scene.domain.cells, (std::array<int, 3>{10, 8, 30}));
  EXPECT_EQ(scene.domain.periodic, (std::array<bool, 2>{true, false}));
  EXPECT_EQ(scene.boundary.low, (Side{SideKind::symmetry, 0.0, {}}));
  EXPECT_EQ(scene.boundary.high, (Side{SideKind::free, 0.0, {}}));
  EXPECT_EQ(scene.boundary.lateral, (std::array<SideKind, 2>{SideKind::periodic, SideKind::wall}));
  EXPECT_EQ(scene.bodies[0].spin, (Triple{4.0, 5.0, 6.0}));
  EXPECT_EQ(scene.bodies[0].region.center, (Triple{5e-5, 4e-5, 1e-4}));
  EXPECT_EQ(scene.voids[0].shape, BodyShape::ring);
  EXPECT_EQ(scene.loading.frame, (Triple{1.0, 2.0, 3.0}));
}

TEST(Scenes, OneLateralKindServesAllAxesThatAreNotPeriodic) {
  const Scene scene = parse(rich_3d, {"boundary.lateral=free"});
  EXPECT_EQ(scene.boundary.lateral, (std::array<SideKind, 2>{SideKind::periodic, SideKind::free}));
}

TEST(Scenes, DatasetsFollowThePhysics) {
  const auto count = [](const std::vector<std::string>& overrides) {
    return parse(small_scene(), overrides).output.fields.size();
  };
  const std::string spall = "material.0.spall=1e9", on = "conduction.on=true",
                    conducts = "material.0.conductivity=1", paper = "thermal=paper";
  EXPECT_EQ(count({spall}), 15u);
  EXPECT_EQ(count({on, conducts}), 14u);
  EXPECT_EQ(count({on, paper}), 14u);
  EXPECT_EQ(count({on, conducts, paper}), 15u);
  EXPECT_EQ(count({on, conducts, paper, spall}), 16u);
  EXPECT_EQ(parse(small_scene(), {spall}).output.fields.back(), "failed");
}

TEST(Scenes, RoundTrips) {
  expect_round_trip(parse(small_scene()));
  expect_round_trip(parse(rich_2d));
  expect_round_trip(parse(rich_3d));
  expect_round_trip(parse(rich_3d, {"domain.periodic=true", "boundary.lateral=periodic"}));
}

TEST(Scenes, RoundTripKeepsEveryBit) {
  for (const double value : {0.1, 1.0 / 3.0, 5e-324, 1.7976931348623157e308, 123456789012345678.0,
                             9.3e18, 2.2250738585072014e-308}) {
    Scene scene = parse(small_scene());
    scene.viscosity.linear = value;
    EXPECT_EQ(parse(write_scene(scene)).viscosity.linear, value);
  }
}

TEST(Scenes, PorosityDefinition) {
  const std::vector<std::string> voids{"sample.kind=random_voids", "sample.void_radius=1e-5",
                                       "sample.porosity=0.25"};
  const Scene fraction = parse(small_scene(), voids);
  EXPECT_EQ(fraction.sample.porosity, 0.25);
  std::vector<std::string> distension = voids;
  distension.push_back("sample.porosity_definition=distension_minus_1");
  const Scene scene = parse(small_scene(), distension);
  EXPECT_EQ(scene.sample.porosity, 0.2);
  EXPECT_EQ(scene.sample.porosity_definition, PorosityDefinition::void_fraction);
  expect_round_trip(scene);
}

TEST(Scenes, Thresholds) {
  const std::string speed = "[morphology]\nfields = [\"speed\"]\nthresholds = ";
  const auto levels = [&](const std::string& text) {
    return parse(small_scene(speed + text + "\n")).morphology.fields.at(0).thresholds;
  };
  EXPECT_EQ(levels("[1, 2.5, 3]"), (std::vector<double>{1.0, 2.5, 3.0}));
  EXPECT_EQ(levels("{ from = 300, to = 330, step = 10 }"),
            (std::vector<double>{300.0, 310.0, 320.0, 330.0}));
  // 0.1 + 2 x 0.1 is more than 0.3 in binary: a value of 0.3 would not reach it.
  EXPECT_EQ(levels("{ from = 0.1, to = 0.3, step = 0.1 }"), (std::vector<double>{0.1, 0.2, 0.3}));
  EXPECT_EQ(levels("{ from = 0, to = 1, step = 0.3 }"), (std::vector<double>{0.0, 0.3, 0.6, 0.9}));
  EXPECT_EQ(levels("{ from = 298.15, to = 298.45, step = 0.1 }"),
            (std::vector<double>{298.15, 298.25, 298.35, 298.45}));
  EXPECT_EQ(levels("{ from = 5, to = 5, step = 1 }"), std::vector<double>{5.0});
  EXPECT_EQ(levels("{ speed = { from = 1, to = 2, step = 1 } }"), (std::vector<double>{1.0, 2.0}));

  const Scene shares = parse(small_scene(
      "[morphology]\nfields = [\"speed\", \"density\"]\nthresholds = { speed = { quantiles = [0, "
      "0.5, 1] }, density = { quantiles = { from = 0.25, to = 0.75, step = 0.25 } } }\n"));
  EXPECT_EQ(shares.morphology.fields[0].quantiles, (std::vector<double>{0.0, 0.5, 1.0}));
  EXPECT_EQ(shares.morphology.fields[1].quantiles, (std::vector<double>{0.25, 0.5, 0.75}));
  EXPECT_TRUE(shares.morphology.fields[1].thresholds.empty());
  expect_round_trip(shares);
  const Scene share = parse(small_scene(speed + "{ quantiles = [0.5] }\n"));
  EXPECT_EQ(share.morphology.fields[0].quantiles, std::vector<double>{0.5});

  const Scene scene = parse(rich_2d);
  ASSERT_EQ(scene.morphology.fields.size(), 2u);
  EXPECT_EQ(scene.morphology.fields[0].name, "pressure");
  EXPECT_EQ(scene.morphology.fields[0].thresholds, (std::vector<double>{-1e9, 0.0, 1e9}));
  EXPECT_EQ(scene.morphology.fields[1].name, "temperature");
  ASSERT_EQ(scene.morphology.fields[1].thresholds.size(), 101u);
  EXPECT_EQ(scene.morphology.fields[1].thresholds[100], 310.0 + 100 * 0.1);
  EXPECT_TRUE(scene.morphology.domains);
  EXPECT_TRUE(scene.morphology.fields[0].hot_spots.empty());
  EXPECT_EQ(scene.morphology.fields[1].hot_spots, (std::vector<double>{400.0, 500.0}));
  const Scene sites = parse(small_scene("[morphology]\nlattice = \"lagrangian\"\n"));
  EXPECT_EQ(sites.morphology.pixel, sites.domain.cell / sites.sample.particles_per_cell);
  expect_round_trip(sites);
  const Scene one = parse(small_scene(speed + "[1]\nhot_spots = [2, 3]\n"));
  EXPECT_FALSE(one.morphology.domains);
  EXPECT_EQ(one.morphology.fields[0].hot_spots, (std::vector<double>{2.0, 3.0}));
}

TEST(Scenes, Overrides) {
  EXPECT_EQ(parse(small_scene(), {"time.end=2e-7"}).time.end, 2e-7);
  EXPECT_EQ(parse(small_scene(), {"time.end=2e-7", "time.end=3e-7"}).time.end, 3e-7);
  EXPECT_EQ(parse(small_scene(), {"thermal=paper"}).thermal, Thermal::paper);
  EXPECT_EQ(parse(small_scene(), {"title=\"two words\""}).title, "two words");
  EXPECT_EQ(parse(small_scene(), {"material.0.yield=5"}).materials[0].yield, 5.0);
  EXPECT_EQ(parse(small_scene(), {"loading.velocity=7"}).loading.velocity, 7.0);
  const Scene moved =
      parse(small_scene(), {"boundary.low={kind=\"wall\", velocity=3}", "boundary.low.velocity=4"});
  EXPECT_EQ(moved.boundary.low, (Side{SideKind::wall, 4.0, {}}));
  EXPECT_EQ(parse(rich_2d, {"body.0.center.1=2.6e-4"}).bodies[0].region.center[1], 2.6e-4);
  const Scene step = parse(rich_2d, {"morphology.thresholds.temperature.step=5"});
  EXPECT_EQ(step.morphology.fields[1].thresholds, (std::vector<double>{310.0, 315.0, 320.0}));
}

TEST(Scenes, InputFolder) {
  int scenes = 0;
  const std::filesystem::path folder = std::filesystem::path(PORESHOCK_SOURCE_DIR) / "input";
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() != ".toml") continue;
    SCOPED_TRACE(entry.path().string());
    ++scenes;
    expect_round_trip(read_scene(entry.path().string()));
  }
  EXPECT_GE(scenes, 5);
}

TEST(Scenes, PaperFigure1) {
  const std::string folder = std::string(PORESHOCK_SOURCE_DIR) + "/input/paper/";
  const Scene scene = read_scene(folder + "fig1.toml");
  EXPECT_EQ(scene.domain.cells, (std::array<int, 3>{200, 1100, 0}));
  EXPECT_EQ(scene.boundary.lateral[0], SideKind::periodic);
  EXPECT_EQ(scene.boundary.low, (Side{SideKind::wall, 0.0, {}}));
  EXPECT_EQ(scene.thermal, Thermal::paper);
  EXPECT_EQ(2.0 * scene.sample.void_radius / scene.domain.cell, 16.0);
  const std::vector<double>& levels = scene.morphology.fields.at(0).thresholds;
  ASSERT_EQ(levels.size(), 70u);
  EXPECT_EQ(levels.front(), 310.0);
  EXPECT_EQ(levels.back(), 1000.0);
  Scene coarse = read_scene(folder + "fig1_coarse.toml", {"domain.cell=5e-6"});
  coarse.title = scene.title;
  EXPECT_TRUE(coarse == scene);
}

TEST(Presets, LineageSetsDefaultsThatKeysOverride) {
  const Transfer plain = parse_scene(small_scene(), "s.toml", {"transfer.preset=lineage"}).transfer;
  EXPECT_EQ(plain.shape, ShapeFunction::gimp);
  EXPECT_EQ(plain.velocity, VelocityTransfer::flip);
  EXPECT_EQ(plain.damping, 0.0);
  EXPECT_EQ(plain.half_length, 0.25);
  const Scene scene =
      parse_scene(small_scene(), "s.toml", {"transfer.preset=lineage", "transfer.shape=linear"});
  EXPECT_EQ(scene.transfer.shape, ShapeFunction::linear);
  EXPECT_EQ(scene.transfer.velocity, VelocityTransfer::flip);
  EXPECT_EQ(parse_scene(write_scene(scene), "again"), scene);
}

/// A scene of one material, whose table holds these lines.
std::string scene_of_material(const std::string& lines) {
  return "[domain]\n" + good_domain + "[[material]]\n" + lines +
         "[sample]\nkind = \"solid\"\n[time]\nend = 1e-7\n";
}

TEST(Library, ANameTakesAllAndKeysOverride) {
  const Scene scene = parse(scene_of_material("name = \"copper\"\nyield = 1e8\nT0 = 400\n"));
  MaterialParameters expected = library_material("copper")->parameters;
  expected.yield = 1e8;
  expected.T0 = 400.0;
  EXPECT_TRUE(scene.materials[0] == expected);
  expect_round_trip(scene);
}

TEST(Library, StrengthModels) {
  const Scene cook = parse(scene_of_material(
      "name = \"copper\"\nstrength = \"johnson_cook\"\n[material.johnson_cook]\nrate = 0.01\n"));
  EXPECT_EQ(cook.materials[0].johnson_cook.rate, 0.01);
  EXPECT_EQ(cook.materials[0].johnson_cook.hardening, 292e6);
  expect_round_trip(cook);
  const Scene guinan =
      parse(scene_of_material("name = \"tungsten\"\n"), {"material.0.strength=steinberg_guinan"});
  EXPECT_EQ(guinan.materials[0].steinberg_guinan.limit, 4e9);
  expect_round_trip(guinan);
}

// Every key that is read is listed once, with what the table of keys shows.
TEST(Keys, ListTheTables) {
  const std::vector<SceneKey> keys = scene_keys();
  const auto find = [&](const std::string& table, const std::string& key) {
    std::vector<SceneKey> found;
    for (const SceneKey& k : keys) {
      if (k.table == table && k.key == key) found.push_back(k);
    }
    EXPECT_EQ(found.size(), 1u) << table << "." << key;
    return found.empty() ? SceneKey{} : found.front();
  };
  EXPECT_EQ(find("time", "cfl").standard, "");
  EXPECT_EQ(find("time", "cfl").allowed, "a number > 0 and <= 1.5");
  EXPECT_EQ(find("transfer", "velocity").standard, "");
  EXPECT_EQ(find("transfer", "velocity").allowed,
            "\"pic\", \"flip\", \"apic\", \"aflip\", \"iapic\", \"polypic\", \"polyflip\" or "
            "\"ipolypic\"");
  EXPECT_EQ(find("transfer", "damping").allowed, "a number from 0 to 10");
  EXPECT_EQ(find("viscosity", "limited").standard, "");
  EXPECT_EQ(find("domain", "cell").standard, "required");
  EXPECT_EQ(find("profile", "every").standard, "");
  EXPECT_EQ(find("material.johnson_cook", "melting").allowed, "a number > 0 (K)");
  EXPECT_EQ(find("material.steinberg_guinan", "limit").allowed, "a number > 0 (Pa)");
  EXPECT_TRUE(find("material", "yield").repeated);
  for (const char* key : {"radius", "inner", "high", "points"}) find("body", key);
}

}  // namespace
}  // namespace poreshock
