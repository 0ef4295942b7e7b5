// Numbers in other units than SI, and thresholds that say nothing, are told; good scenes are not.
#include <gtest/gtest.h>

#include "poreshock/material/library.hpp"
#include "poreshock/scene/scene_warnings.hpp"
#include "scene_text.hpp"

namespace poreshock {
namespace {

std::vector<std::string> warnings_of(const std::vector<std::string>& changes) {
  return scene_warnings(parse_scene(small_scene(), "s.toml", changes));
}

/// Exactly one warning, of these words.
void expect_one(const std::vector<std::string>& changes, const std::vector<std::string>& words) {
  const std::vector<std::string> warnings = warnings_of(changes);
  ASSERT_EQ(warnings.size(), 1U) << changes[0] << (warnings.empty() ? "" : ": " + warnings.back());
  for (const std::string& word : words) {
    EXPECT_NE(warnings[0].find(word), std::string::npos) << "'" << word << "' in: " << warnings[0];
  }
}

TEST(SceneWarnings, GoodScenesHaveNone) {
  EXPECT_TRUE(warnings_of({}).empty());
  // But for a body at 2 m/s, which gets nowhere.
  EXPECT_EQ(scene_warnings(parse_scene(rich_2d, "s.toml")).size(), 1U);
  for (const LibraryMaterial& m : material_library()) {
    const std::string name = m.parameters.name;
    for (const std::string strength : {"linear", "johnson_cook", "steinberg_guinan"}) {
      const std::string text = "[domain]\n" + good_domain + "[[material]]\nname = \"" + name +
                               "\"\nstrength = \"" + strength +
                               "\"\n[sample]\nkind = \"solid\"\n[time]\nend = 1e-7\n";
      if (problems(text).empty()) {
        EXPECT_TRUE(scene_warnings(parse_scene(text, "s.toml")).empty()) << name << strength;
      }
    }
  }
}

TEST(SceneWarnings, MaterialsInOtherUnits) {
  expect_one({"material.0.density=2.7"},
             {"material.0.density = 2.7 kg/m^3 is far from any solid", "1186 to 1.93e+04",
              "If it is in g/cm^3, write 2700 (kg/m^3)"});
  expect_one({"material.0.c0=5.35"}, {"c0 = 5.35 m/s", "in km/s, write 5350 (m/s)"});
  expect_one({"material.0.cv=0.88"}, {"cv = 0.88 J/(kg K)", "in J/(g K), write 880"});
  expect_one({"material.0.cv=8.8e6"}, {"cv = 8.8e+06 J/(kg K) is far from any solid"});
  expect_one({"material.0.young=69"}, {"young = 69 Pa", "in GPa, write 6.9e+10 (Pa)"});
  expect_one({"material.0.young=69e3"}, {"young = 6.9e+04 Pa", "in MPa, write 6.9e+10 (Pa)"});
  expect_one({"material.0.young=0.69"}, {"young = 0.69 Pa", "in Mbar, write 6.9e+10 (Pa)"});
  expect_one({"material.0.yield=120"}, {"yield = 120 Pa", "in MPa, write 1.2e+08 (Pa)"});
  expect_one({"material.0.yield=0.12"}, {"yield = 0.12 Pa", "in GPa, write 1.2e+08 (Pa)"});
  expect_one({"material.0.hardening=384"}, {"hardening = 384 Pa", "in MPa, write 3.84e+08 (Pa)"});
  expect_one({"material.0.spall=1.2"}, {"spall = 1.2 Pa", "in GPa, write 1.2e+09 (Pa)"});
  // All of a material in g/cm^3, km/s and GPa, which go with each other.
  EXPECT_EQ(warnings_of({"material.0.density=2.7", "material.0.c0=5.35", "material.0.young=69",
                         "material.0.yield=0.12"})
                .size(),
            4U);
  expect_one({"material.0.name=copper"},
             {"density = 2700 kg/m^3 is far from that of copper", "8930", "another name"});
  // Nothing is said of a fluid, nor of what never yields.
  EXPECT_TRUE(warnings_of({"material.0.young=0", "material.0.yield=0"}).empty());
  EXPECT_TRUE(warnings_of({"material.0.yield=1e30"}).empty());
}

TEST(SceneWarnings, StrengthModelsInOtherUnits) {
  const auto warnings = [](const std::string& lines) {
    return scene_warnings(parse_scene("[domain]\n" + good_domain +
                                          "[[material]]\nname = \"copper\"\n" + lines +
                                          "[sample]\nkind = \"solid\"\n[time]\nend = 1e-7\n",
                                      "s.toml"));
  };
  std::vector<std::string> found =
      warnings("strength = \"johnson_cook\"\njohnson_cook = { yield = 90, hardening = 292 }\n");
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NE(found[1].find("johnson_cook.hardening = 292 Pa"), std::string::npos) << found[1];
  found = warnings(
      "strength = \"steinberg_guinan\"\nsteinberg_guinan = { yield = 0.12, limit = 0.64 }\n");
  ASSERT_EQ(found.size(), 2U);
  EXPECT_NE(found[0].find("steinberg_guinan.yield = 0.12 Pa"), std::string::npos) << found[0];
}

TEST(SceneWarnings, VelocitiesInOtherUnits) {
  expect_one({"loading.velocity=1.1"},
             {"loading.velocity = 1.1 m/s is only 0.0002056 of the sound speed", "0.011 cells",
              "in km/s, write 1100 (m/s)"});
  expect_one({"loading.velocity=1.1e6"}, {"205.6 times the sound speed"});
  expect_one({"boundary.low={kind='wall', velocity=1.5}"},
             {"boundary.low.velocity = 1.5 m/s", "write 1500"});
  const std::string body = "[[body]]\nshape = \"disc\"\ncenter = [5e-5, 5e-5]\nradius = 2e-5\n";
  const auto found =
      scene_warnings(parse_scene(small_scene(body + "velocity = [0, -2]\n"), "s.toml"));
  ASSERT_EQ(found.size(), 1U);
  EXPECT_NE(found[0].find("body.0.velocity = 2 m/s"), std::string::npos) << found[0];
  // A slow impact that is given its time.
  EXPECT_TRUE(warnings_of({"loading.velocity=5", "time.end=3e-6"}).empty());
}

TEST(SceneWarnings, LengthsAndTimesInOtherUnits) {
  expect_one({"domain.size=[0.1, 0.2]", "domain.cell=0.01"},
             {"Sound gets only 0.0535 cells far until time.end = 1e-07 s", "10 um are 10e-6"});
  expect_one({"domain.size=[100, 200]", "domain.cell=10", "time.end=0.1"},
             {"domain.cell = 10 m; all numbers are SI"});
  expect_one({"time.end=1e-4"}, {"Sound crosses the domain 2675 times until time.end = 0.0001 s"});
  expect_one({"time.end=1e-10"}, {"Sound gets only 0.0535 cells far"});
}

TEST(SceneWarnings, ThresholdsThatAllMaterialExceeds) {
  const auto with = [&](const std::string& fields, const std::string& thresholds) {
    return std::vector<std::string>{"morphology.every=5e-9", "morphology.fields=" + fields,
                                    "morphology.thresholds=" + thresholds};
  };
  expect_one(with("['temperature']", "{from=300, to=900, step=100}"),
             {"1 of 7 morphology.thresholds of temperature is not above T0 = 300 K of aluminium",
              "hot there from the start"});
  expect_one(with("['temperature']", "[25, 50, 400]"), {"2 of 3 ", "are not above T0 = 300 K"});
  expect_one(with("['von_mises', 'plastic_strain']", "{von_mises=[0, 1e8], plastic_strain=[0.1]}"),
             {"1 of 2 morphology.thresholds of von_mises is not above 0"});
  std::vector<std::string> spots = with("['temperature']", "[310, 400]");
  spots.emplace_back("morphology.hot_spots=[290, 400]");
  expect_one(spots, {"1 of 2 morphology.hot_spots of temperature"});
  std::vector<std::string> cold = with("['temperature']", "[300, 400]");
  cold.emplace_back("material.0.T0=77");
  EXPECT_TRUE(warnings_of(cold).empty());
  EXPECT_TRUE(warnings_of(with("['pressure']", "[-1e9, 0, 1e9]")).empty());
  EXPECT_TRUE(
      warnings_of({"morphology.fields=['temperature']", "morphology.thresholds=[300]"}).empty());
}

}  // namespace
}  // namespace poreshock
