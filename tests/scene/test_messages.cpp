// The texts that users read when a scene is wrong.
#include <gtest/gtest.h>

#include <filesystem>
#include <string>

#include "poreshock/core/error.hpp"
#include "poreshock/scene/read_scene.hpp"
#include "scene_text.hpp"

namespace poreshock {
namespace {

const std::string top_keys =
    "title, thermal, domain, boundary, material, sample, body, void, loading, body_force, "
    "transfer, "
    "viscosity, conduction, contact, time, output, morphology, profile, probe, checkpoint";

TEST(Messages, GoodSceneHasNone) {
  EXPECT_EQ(problems(small_scene()), "");
}

TEST(Messages, UnknownKeyWithHint) {
  EXPECT_EQ(problems(scene_with("size = [1e-4, 2e-4]\ncell = 1e-5\n  periodik = true\n")),
            "s.toml:4:3: domain.periodik: unknown key, allowed size, cell, periodic, did you mean "
            "\"periodic\"?");
}

TEST(Messages, UnknownKeyFarFromAll) {
  EXPECT_EQ(problems(small_scene("[loading]\nspeed_of_light = 1\n")),
            "s.toml:19:1: loading.speed_of_light: unknown key, allowed velocity, frame");
}

TEST(Messages, KeysOfFormerSchemes) {
  for (const std::string key : {"averaging", "order", "update"}) {
    EXPECT_EQ(problems(small_scene("[transfer]\n" + key + " = 1\n")),
              "s.toml:19:1: transfer." + key +
                  ": unknown key, allowed preset, shape, velocity, gradient, damping");
  }
}

TEST(Messages, NamesOfTransfers) {
  const std::string names =
      "\"pic\", \"flip\", \"apic\", \"aflip\", \"iapic\", \"polypic\", \"polyflip\" or "
      "\"ipolypic\"";
  EXPECT_EQ(problems(small_scene("[transfer]\nvelocity = \"fmpm\"\n")),
            "s.toml:19:12: transfer.velocity: found \"fmpm\", allowed " + names);
  EXPECT_EQ(problems(small_scene("[transfer]\nvelocity = \"polyflop\"\n")),
            "s.toml:19:12: transfer.velocity: found \"polyflop\", allowed " + names +
                ", did you mean \"polyflip\"?");
}

TEST(Messages, UnknownTable) {
  EXPECT_EQ(
      problems(small_scene("[trasnfer]\nshape = \"cubic\"\n")),
      "s.toml:18:2: trasnfer: unknown table, allowed " + top_keys + ", did you mean \"transfer\"?");
  EXPECT_EQ(problems("titel = \"x\"\n" + small_scene()),
            "s.toml:1:1: titel: unknown key, allowed " + top_keys + ", did you mean \"title\"?");
}

TEST(Messages, WrongTypes) {
  EXPECT_EQ(problems(scene_with("size = [1e-4, 2e-4]\ncell = \"10 um\"\n")),
            "s.toml:3:8: domain.cell: found \"10 um\", allowed a number > 0 (m)");
  EXPECT_EQ(problems(scene_with("size = 1e-4\ncell = 1e-5\n")),
            "s.toml:2:8: domain.size: found 1e-04, allowed an array of 2 or 3 numbers > 0 (m)");
  EXPECT_EQ(problems(small_scene("max_steps = 3.0\n")),
            "s.toml:18:13: time.max_steps: found 3.0, allowed a whole number >= 0");
  EXPECT_EQ(override_problems("sample.overlap=1"),
            "--set sample.overlap=1: sample.overlap: found 1, allowed true or false");
  EXPECT_EQ(problems(small_scene("[[loading]]\nvelocity = 1\n")),
            "s.toml:18:1: loading: found an array of 1, allowed a table [loading]");
  EXPECT_EQ(problems(small_scene("[body]\nshape = \"box\"\n")),
            "s.toml:18:1: body: found a table, allowed tables that each begin with [[body]]");
  EXPECT_EQ(problems(small_scene("[loading]\nframe = [1, 2, 3]\n")),
            "s.toml:19:9: loading.frame: found an array of 3, allowed an array of 2 numbers (m/s)");
}

TEST(Messages, OutOfRange) {
  EXPECT_EQ(problems(small_scene("cfl = 2\n")),
            "s.toml:18:7: time.cfl: found 2, allowed a number > 0 and <= 1.5");
  EXPECT_EQ(problems(small_scene("[loading]\nvelocity = -1100.5\n")),
            "s.toml:19:12: loading.velocity: found -1100.5, allowed a number >= 0 (m/s)");
  EXPECT_EQ(problems(small_scene("[viscosity]\nlinear = nan\n")),
            "s.toml:19:10: viscosity.linear: found nan, allowed a number >= 0");
  EXPECT_EQ(problems(small_scene("[viscosity]\nquadratic = inf\n")),
            "s.toml:19:13: viscosity.quadratic: found inf, allowed a number >= 0");
  EXPECT_EQ(problems(small_scene("[transfer]\ndamping = 10.5\n")),
            "s.toml:19:11: transfer.damping: found 10.5, allowed a number from 0 to 10");
  EXPECT_EQ(problems(small_scene("[transfer]\ndamping = -0.1\n")),
            "s.toml:19:11: transfer.damping: found -0.1, allowed a number from 0 to 10");
  EXPECT_EQ(problems(small_scene("[[body]]\nshape = \"box\"\nlow = [0, 0]\nhigh = [1, 1]\n"
                                 "grain = 2147483648\n")),
            "s.toml:22:9: body.0.grain: found 2147483648, allowed a whole number from 0 to "
            "1000000");
}

TEST(Messages, MaterialRanges) {
  EXPECT_EQ(
      override_problems("material.0.poisson=0.5"),
      "--set material.0.poisson=0.5: material.0.poisson: found 0.5, allowed a number >= 0 and "
      "< 0.5");
  EXPECT_EQ(
      override_problems("material.0.lambda=0.99"),
      "--set material.0.lambda=0.99: material.0.lambda: found 0.99, allowed a number from 1 to 20");
  EXPECT_EQ(override_problems("material.0.model=\"elastic\""),
            "--set material.0.model=\"elastic\": material.0.model: found \"elastic\", allowed "
            "\"j2_mie_gruneisen\"");
  EXPECT_EQ(override_problems("material.0.young=0"), "");
}

/// A scene of one material, whose table begins at line 4 and holds these lines.
std::string with_material(const std::string& lines) {
  return "[domain]\n" + good_domain + "[[material]]\n" + lines +
         "[sample]\nkind = \"solid\"\n[time]\nend = 1e-7\n";
}

TEST(Messages, MaterialsOfTheLibrary) {
  const std::string names =
      "\"paper_aluminium\", \"aluminium_6061_t6\", \"copper\", \"tungsten\", \"magnesium_az31b\", "
      "\"steel_304\", \"pmma\" or \"hmx\"";
  EXPECT_EQ(problems(with_material("name = \"coper\"\n")),
            "s.toml:5:8: material.0.name: found \"coper\", allowed " + names +
                ", did you mean \"copper\"?");
  EXPECT_EQ(problems(with_material("yield = 1e8\n")),
            "s.toml:4:1: material.0.name: missing, give " + names);
  EXPECT_EQ(
      problems(with_material("name = \"pmma\"\nrate = 0.1\n")),
      "s.toml:6:1: material.0.rate: unknown key, allowed name, model, density, young, poisson, "
      "strength, yield, hardening, kinematic_share, plastic_heat, c0, lambda, gamma, cv, "
      "conductivity, T0, spall, spall_time, melting");
}

TEST(Messages, StrengthModels) {
  EXPECT_EQ(problems(with_material("name = \"pmma\"\nstrength = \"jonson_cook\"\n")),
            "s.toml:6:12: material.0.strength: found \"jonson_cook\", allowed \"linear\", "
            "\"johnson_cook\" or \"steinberg_guinan\", did you mean \"johnson_cook\"?");
  const std::string cook = "name = \"copper\"\nstrength = \"johnson_cook\"\n";
  EXPECT_EQ(
      problems(with_material(cook + "johnson_cook = { exponent = 1.5 }\n")),
      "s.toml:7:29: material.0.johnson_cook.exponent: found 1.5, allowed a number > 0 and <= 1");
  EXPECT_EQ(problems(with_material(cook + "johnson_cook = { melting = 200 }\n")),
            "s.toml:7:28: material.0.johnson_cook.melting: found 200 K, allowed more than "
            "reference_temperature = 294 K");
  EXPECT_EQ(problems(with_material("name = \"copper\"\nstrength = \"steinberg_guinan\"\n"
                                   "steinberg_guinan = { limit = 1e6 }\n")),
            "s.toml:7:30: material.0.steinberg_guinan.limit: found 1000000 Pa, allowed at least "
            "yield = 120000000 Pa");
  const std::string missing =
      problems(with_material("name = \"tungsten\"\nstrength = \"johnson_cook\"\n"));
  EXPECT_EQ(missing.substr(0, missing.find('\n')),
            "s.toml:4:1: material.0.johnson_cook.yield: missing, give a number > 0 (Pa)");
}

TEST(Messages, MissingKeys) {
  EXPECT_EQ(problems(scene_with("size = [1e-4, 2e-4]\n")),
            "s.toml:1:1: domain.cell: missing, give a number > 0 (m)");
  EXPECT_EQ(problems(small_scene("[[body]]\nshape = \"disc\"\ncenter = [0, 0]\n")),
            "s.toml:18:1: body.0.radius: missing, give a number > 0 (m)");
  EXPECT_EQ(problems(""),
            "s.toml:1:1: domain.size: missing, give an array of 2 or 3 numbers > 0 (m)\n"
            "s.toml:1:1: domain.cell: missing, give a number > 0 (m)\n"
            "s.toml:1:1: time.end: missing, give a number > 0 (s)\n"
            "s.toml:1:1: material: missing, give at least one table [[material]]\n"
            "s.toml:1:1: sample: found no material in the domain, allowed a [sample] with a kind "
            "other than \"none\", or "
            "at least one [[body]]");
}

TEST(Messages, SeveralProblemsInTheOrderOfTheFile) {
  EXPECT_EQ(problems("thermal = \"papers\"\n" + scene_with("size = [1e-4, 0]\ncel = 1e-5\n") +
                         "cfl = 0\n[output]\nsnapshot = 7e-9\n",
                     {"time.end=-1"}),
            "s.toml:1:11: thermal: found \"papers\", allowed \"paper\" or \"conserving\", did you "
            "mean \"paper\"?\n"
            "s.toml:2:1: domain.cell: missing, give a number > 0 (m)\n"
            "s.toml:3:15: domain.size: found 0, allowed a number > 0 (m)\n"
            "s.toml:4:1: domain.cel: unknown key, allowed size, cell, periodic, did you mean "
            "\"cell\"?\n"
            "s.toml:19:7: time.cfl: found 0, allowed a number > 0 and <= 1.5\n"
            "s.toml:21:12: output.snapshot: found 7e-09 s, allowed 0 or whole multiples of "
            "output.beat = 5e-09 s\n"
            "--set time.end=-1: time.end: found -1, allowed a number > 0 (s)");
}

TEST(Messages, SyntaxErrors) {
  EXPECT_EQ(problems("[domain]\nsize = [1, 2\ncell = 3\n"),
            "s.toml:3:1: not valid TOML: Error while parsing array: expected comma or closing ']', "
            "saw 'c'");
  EXPECT_EQ(
      problems("[time]\nend = 1\nend = 2\n"),
      "s.toml:3:7: not valid TOML: Error while parsing key-value pair: cannot redefine existing "
      "integer 'end'");
}

TEST(Messages, OverridesSayHowToWriteThem) {
  const std::vector<std::pair<std::string, std::string>> cases = {
      {"morphology.thresholds=310:900:10",
       "found a range, allowed {from, to, step}; write --set "
       "'morphology.thresholds={from = 310, to = 900, step = 10}'"},
      {"morphology.thresholds=10:50:10",
       "found a range, allowed {from, to, step}; write --set "
       "'morphology.thresholds={from = 10, to = 50, step = 10}'"},
      {"morphology.thresholds=1e9..5e9",
       "found a range, allowed {from, to, step}; write --set "
       "'morphology.thresholds={from = 1e9, to = 5e9, step = 10}'"},
      {"morphology.thresholds={temperature=310:900:10, pressure=[1e9]}",
       "found a range, allowed {from, to, step}; write --set 'morphology.thresholds={temperature="
       "{from = 310, to = 900, step = 10}, pressure=[1e9]}'"},
      {"loading.velocity=900:1100:100",
       "found a range, allowed one value; tools/sweep runs a scene with several"},
      {"title=v = 3, or so", "found a text without quotes; write --set 'title=\"v = 3, or so\"'"},
      {"title=v = 3", "found a text without quotes; write --set 'title=\"v = 3\"'"},
      {"title=a first run", "found a text without quotes; write --set 'title=\"a first run\"'"},
      {"sample.image=../bed 2/label.png",
       "found a text without quotes; write --set 'sample.image=\"../bed 2/label.png\"'"},
      {"boundary.low={kind=wall, velocity=1e2}",
       "found a text without quotes; write --set 'boundary.low={kind=\"wall\", velocity=1e2}'"},
      {"output.fields=[temperature, \"pressure\"]",
       "found a text without quotes; write --set 'output.fields=[\"temperature\", "
       "\"pressure\"]'"},
      {"output.fields=temperature,pressure",
       "found a text without quotes; found a list without brackets; write --set "
       "'output.fields=[\"temperature\",\"pressure\"]'"},
      {"domain.size=1e-4,2e-4",
       "found a list without brackets; write --set 'domain.size=[1e-4,2e-4]'"}};
  EXPECT_EQ(problems(small_scene(""), {"title=\"310:900:10\"", "title='10:50:10'"}), "");
  for (const auto& [change, message] : cases) {
    EXPECT_EQ(problems(small_scene(""), {change}), "--set " + change + ": " + message);
  }
}

TEST(Messages, UnreadableFile) {
  const auto message = [](const std::string& path) -> std::string {
    try {
      read_scene(path);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(
      message("no_such_scene.toml"),
      "no_such_scene.toml: cannot be read (No such file or directory), give the path of a scene "
      "file such as input/porous_aluminium.toml");
  const std::string folder = std::filesystem::temp_directory_path().string();
  EXPECT_EQ(message(folder), folder +
                                 ": cannot be read (it is a folder), give the path of a scene file "
                                 "such as input/porous_aluminium.toml");
}

TEST(Messages, Overrides) {
  EXPECT_EQ(override_problems("time.end=soon"),
            "--set time.end=soon: time.end: found \"soon\", allowed a number > 0 (s)");
  EXPECT_EQ(override_problems("time.ends=1e-7"),
            "--set time.ends=1e-7: time.ends: unknown key, allowed end, cfl, max_steps, sleep, "
            "follow, did "
            "you mean \"end\"?");
  EXPECT_EQ(override_problems("time.end"),
            "--set time.end: found no value, allowed table.key=value such as time.end=2e-7");
  EXPECT_EQ(override_problems("time.end="),
            "--set time.end=: found nothing after the =, allowed a value such as time.end=2e-7");
  EXPECT_EQ(override_problems("material.1.yield=0"),
            "--set material.1.yield=0: material: found the entry \"1\", allowed the index 0");
  EXPECT_EQ(override_problems("material.yield=0"),
            "--set material.yield=0: material: found the entry \"yield\", allowed the index 0");
  EXPECT_EQ(override_problems("time.end.late=1"),
            "--set time.end.late=1: time.end: found a key inside it, but it is not a table");
}

}  // namespace
}  // namespace poreshock
