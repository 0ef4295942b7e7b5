// Keys of maps that contradict each other or the domain: the texts that users read then.
#include <gtest/gtest.h>

#include <string>

#include "scene_text.hpp"

namespace poreshock {
namespace {

TEST(MorphologyKeys, FieldsAndCadence) {
  const std::string on = "[morphology]\nevery = 5e-9\n";
  EXPECT_EQ(problems(small_scene(on)),
            "s.toml:18:1: morphology.fields: missing, give at least one field, or every = 0");
  EXPECT_EQ(problems(small_scene(on + "fields = [\"temprature\"]\nthresholds = [310]\n")),
            "s.toml:20:11: morphology.fields: found \"temprature\", allowed \"temperature\", "
            "\"pressure\", \"density\", \"speed\", \"von_mises\", \"plastic_strain\" or "
            "\"molten\", did you mean "
            "\"temperature\"?");
  EXPECT_EQ(
      problems(small_scene(on + "fields = [\"speed\"]\n")),
      "s.toml:18:1: morphology.thresholds: missing, give numbers in ascending order, {from = , "
      "to = , step = } or {quantiles = }, by field name if several");
  EXPECT_EQ(
      problems(small_scene(on + "fields = [\"speed\"]\nthresholds = [1, 2, 2]\n")),
      "s.toml:21:21: morphology.thresholds: found 2, allowed numbers in ascending order, here > "
      "2");
  EXPECT_EQ(problems(small_scene(on + "fields = [\"speed\"]\nthresholds = [1, nan]\n")),
            "s.toml:21:18: morphology.thresholds: found nan, allowed a number");
  EXPECT_EQ(
      problems(small_scene(on + "fields = [\"speed\", \"density\"]\nthresholds = [1]\n")),
      "s.toml:21:14: morphology.thresholds: found thresholds of one field, allowed a table by "
      "field name, because morphology.fields names 2");
  EXPECT_EQ(
      problems(small_scene(on + "fields = [\"speed\", \"density\"]\n" +
                           "thresholds = { speed = [1], densty = [2] }\n")),
      "s.toml:21:14: morphology.thresholds.density: missing, give its thresholds, or take it "
      "out of morphology.fields\n"
      "s.toml:21:29: morphology.thresholds.densty: unknown key, allowed speed, density, did you "
      "mean \"density\"?");
}

TEST(MorphologyKeys, HotSpots) {
  const std::string two =
      "[morphology]\nevery = 5e-9\nfields = [\"speed\", \"density\"]\n"
      "thresholds = { speed = [1], density = [2] }\n";
  EXPECT_EQ(problems(small_scene(two + "hot_spots = { density = [3] }\n")), "");
  EXPECT_EQ(problems(small_scene(two + "hot_spots = [3]\n")),
            "s.toml:22:13: morphology.hot_spots: found thresholds of one field, allowed a table by "
            "field name, because morphology.fields names 2");
  EXPECT_EQ(problems(small_scene(two + "hot_spots = { densty = [3], speed = [2, 1] }\n")),
            "s.toml:22:15: morphology.hot_spots.densty: unknown key, allowed speed, density, did "
            "you mean \"density\"?\n"
            "s.toml:22:41: morphology.hot_spots.speed: found 1, allowed numbers in ascending "
            "order, here > 2");
}

TEST(MorphologyKeys, ThresholdRanges) {
  const std::string speed = "[morphology]\nfields = [\"speed\"]\nthresholds = ";
  EXPECT_EQ(
      problems(small_scene(speed + "{ from = 2, to = 1, step = 1 }\n")),
      "s.toml:20:14: morphology.thresholds: found from 2 to 1 by 1, allowed to >= from and at "
      "most 65534 thresholds");
  EXPECT_EQ(
      problems(small_scene(speed + "{ from = 0, to = 1, step = 1e-6 }\n")),
      "s.toml:20:14: morphology.thresholds: found from 0 to 1 by 1e-06, allowed to >= from and "
      "at most 65534 thresholds");
  EXPECT_EQ(problems(small_scene(speed + "{ from = 2, to = 3, step = 0 }\n")),
            "s.toml:20:41: morphology.thresholds.step: found 0, allowed a number > 0");
  const std::string shares = "allowed shares of the material from 0 to 1";
  EXPECT_EQ(problems(small_scene(speed + "{ quantiles = [0.5, 1.5] }\n")),
            "s.toml:20:28: morphology.thresholds.quantiles: found 1.5, " + shares);
  EXPECT_EQ(problems(small_scene(speed + "{ quantiles = [-0.5, 1.5] }\n")),
            "s.toml:20:28: morphology.thresholds.quantiles: found -0.5, " + shares);
  EXPECT_EQ(problems(small_scene(speed + "{ quantiles = [0.5], step = 1 }\n")),
            "s.toml:20:35: morphology.thresholds.step: unknown key, allowed quantiles");
  EXPECT_EQ(problems(small_scene(speed + "[1]\nhot_spots = { quantiles = [0.5], from = 0, to = 1, "
                                         "step = 1 }\n")),
            "s.toml:21:15: morphology.hot_spots.quantiles: unknown key, allowed from, to, step");
}

TEST(MorphologyKeys, Pixel) {
  EXPECT_EQ(override_problems("morphology.pixel=3e-5"),
            "--set morphology.pixel=3e-5: morphology.pixel: found 3e-05 m, allowed domain.cell = "
            "1e-05 m times 1/8, 1/4, 1/2, 1, 2, 4, 8 or 16");
  EXPECT_EQ(
      override_problems("morphology.pixel=3.2e-4"),
      "--set morphology.pixel=3.2e-4: morphology.pixel: found 0.00032 m, allowed domain.cell = "
      "1e-05 m times 1/8, 1/4, 1/2, 1, 2, 4, 8 or 16");
  EXPECT_EQ(
      override_problems("morphology.pixel=4e-5"),
      "--set morphology.pixel=4e-5: morphology.pixel: found 4e-05 m, allowed whole parts of the "
      "domain, 0.0001 m along x");
  EXPECT_NE(override_problems("morphology.pixel=1.6e-4")
                .find("allowed whole parts of the domain, 0.0002 m along y"),
            std::string::npos);
  EXPECT_EQ(override_problems("morphology.pixel=1.25e-6"), "");
  EXPECT_EQ(problems(small_scene("[morphology]\nlattice = \"lagrangian\"\n")), "");
  EXPECT_EQ(problems(small_scene("[morphology]\nlattice = \"lagrangian\"\npixel = 1e-5\n")),
            "s.toml:20:9: morphology.pixel: found 1e-05 m, allowed with lattice = \"lagrangian\" "
            "only the site, domain.cell / sample.particles_per_cell = 5e-06 m");
}

}  // namespace
}  // namespace poreshock
