// Keys that contradict each other: the texts that users read then.
#include <gtest/gtest.h>

#include <string>

#include "scene_text.hpp"

namespace poreshock {
namespace {

TEST(Contradictions, OverrideThatBreaksAnotherKey) {
  EXPECT_EQ(
      override_problems("domain.cell=3e-5"),
      "s.toml:2:8: domain.size: found 0.0001 m along x, allowed whole multiples of domain.cell "
      "= 3e-05 m\n"
      "s.toml:2:8: domain.size: found 0.0002 m along y, allowed whole multiples of domain.cell "
      "= 3e-05 m");
}

TEST(Contradictions, TooFewCells) {
  EXPECT_EQ(
      problems(scene_with("size = [3e-5, 7e-5]\ncell = 1e-5\n")),
      "s.toml:2:8: domain.size: found 3e-05 m along x, allowed at least 4 cells along a lateral "
      "axis (4e-05 m)\n"
      "s.toml:2:8: domain.size: found 7e-05 m along y, allowed at least 8 cells along the shock "
      "axis (8e-05 m)");
}

TEST(Contradictions, Walls) {
  const std::string moving = "[boundary]\nlow = { kind = \"wall\", velocity = 100 }\n";
  EXPECT_EQ(problems(small_scene(moving + "high = \"wall\"\n")),
            "s.toml:20:8: boundary.high: found a wall at 0 m/s opposite to a moving wall, allowed "
            "\"free\" or a wall at 100 m/s too");
  EXPECT_EQ(problems(small_scene(moving + "high = \"symmetry\"\n")),
            "s.toml:20:8: boundary.high: found a symmetry plane opposite to a moving wall, allowed "
            "\"free\" or a wall at 100 m/s too");
  EXPECT_EQ(problems(small_scene(moving + "high = { kind = \"wall\", velocity = 100 }\n")), "");
  EXPECT_EQ(problems(small_scene(moving + "high = \"free\"\n")), "");
  EXPECT_EQ(
      problems(small_scene("[boundary]\nlow = { kind = \"symmetry\", velocity = 3.5 }\n")),
      "s.toml:19:39: boundary.low.velocity: found 3.5 m/s, allowed only with kind = \"wall\"");
  EXPECT_EQ(problems(small_scene("[boundary]\nlow = \"wal\"\n")),
            "s.toml:19:7: boundary.low.kind: found \"wal\", allowed \"wall\", \"free\" or "
            "\"symmetry\", did you mean \"wall\"?");
}

TEST(Contradictions, LateralSides) {
  const std::string periodic = good_domain + "periodic = true\n";
  EXPECT_EQ(problems(scene_with(periodic, "[boundary]\nlateral = \"wall\"\n")),
            "s.toml:20:11: boundary.lateral: found \"wall\", allowed only with an axis for which "
            "domain.periodic is false");
  EXPECT_EQ(problems(small_scene("[boundary]\nlateral = \"periodic\"\n")),
            "s.toml:19:11: boundary.lateral: found \"periodic\", allowed \"wall\", \"free\" or "
            "\"symmetry\"");
  EXPECT_EQ(problems(scene_with(good_domain + "periodic = [true, false]\n")),
            "s.toml:4:12: domain.periodic: found an array of 2, allowed true or false, or an array "
            "with one of them per lateral axis, here 1");
}

TEST(Contradictions, Sample) {
  EXPECT_EQ(
      override_problems("sample.kind=random_voids"),
      "s.toml:14:1: sample.void_radius: missing, give a number > 0 (m) with kind = "
      "\"random_voids\"\n"
      "s.toml:14:1: sample.porosity: missing, give a void fraction > 0 and <= 0.65 with kind = "
      "\"random_voids\"");
  EXPECT_EQ(
      problems(small_scene(),
               {"sample.kind=random_voids", "sample.void_radius=1e-5", "sample.porosity=3",
                "sample.porosity_definition=distension_minus_1"}),
      "--set sample.porosity=3: sample.porosity: found a void fraction of 0.75, allowed a void "
      "fraction > 0 and <= 0.65 with kind = \"random_voids\"");
  EXPECT_EQ(problems(small_scene(),
                     {"sample.kind=random_voids", "sample.void_radius=1e-5", "sample.porosity=0.2",
                      "sample.overlap=true", "sample.ligament=1e-6"}),
            "--set sample.ligament=1e-6: sample.ligament: found 1e-06 m, allowed 0 with overlap = "
            "true");
  EXPECT_EQ(
      override_problems("sample.height=3e-4"),
      "--set sample.height=3e-4: sample.height: found 0.0003 m, allowed up to the domain height "
      "of 0.0002 m, or more with time.follow = \"front\"");
  EXPECT_EQ(override_problems("sample.material=aluminum"),
            "--set sample.material=aluminum: sample.material: found \"aluminum\", allowed "
            "\"aluminium\", did you mean \"aluminium\"?");
  EXPECT_EQ(
      override_problems("sample.particles_per_cell=9"),
      "--set sample.particles_per_cell=9: sample.particles_per_cell: found 9, allowed a whole "
      "number from 1 to 8");
  EXPECT_EQ(override_problems("sample.kind=none"),
            "s.toml:14:1: sample: found no material in the domain, allowed a [sample] with a kind "
            "other than \"none\", or "
            "at least one [[body]]");
}

TEST(Contradictions, MaterialNamesAreUnique) {
  std::string second = small_scene();
  second = second.substr(second.find("[[material]]"));
  second = second.substr(0, second.find("[sample]"));
  EXPECT_EQ(
      problems(small_scene(second)),
      "s.toml:19:8: material.1.name: found \"aluminium\" again, allowed a name of its own for "
      "each material");
}

TEST(Contradictions, Bodies) {
  EXPECT_EQ(problems(small_scene("[[body]]\nshape = \"ring\"\ncenter = [0, 0]\ninner = 2e-5\n"
                                 "outer = 1e-5\n")),
            "s.toml:21:9: body.0.inner: found 2e-05 m, allowed less than outer = 1e-05 m");
  EXPECT_EQ(problems(small_scene("[[void]]\nshape = \"box\"\nlow = [0, 0]\nhigh = [1e-5, 0]\n")),
            "s.toml:21:8: void.0.high: found 0 m along y, allowed more than low, 0 m");
  EXPECT_EQ(problems(small_scene("[[void]]\nshape = \"ball\"\nradius = 1\n")),
            "s.toml:19:9: void.0.shape: found \"ball\", allowed \"disc\", \"box\", \"ring\" or "
            "\"polygon\"");
  EXPECT_EQ(problems(small_scene("[[void]]\nshape = \"polygon\"\npoints = [[0, 0], [1, 1]]\n")),
            "s.toml:20:10: void.0.points: found an array of 2, allowed at least 3 points, each an "
            "array of 2 numbers (m)");
  EXPECT_EQ(
      problems(small_scene("[[void]]\nshape = \"polygon\"\npoints = [[0, 0], [1, 1], [2, 2]]\n")),
      "s.toml:20:10: void.0.points: found no area, allowed corners in order around an area");
  EXPECT_EQ(problems(small_scene("[[void]]\nshape = \"disc\"\ncenter = [0, 0]\nradius = 1e-5\n"
                                 "velocity = [0, 0]\n")),
            "s.toml:22:1: void.0.velocity: unknown key, allowed shape, center, radius");
}

TEST(Contradictions, GradientsByMomentsOfAHat) {
  EXPECT_EQ(problems(small_scene(), {"transfer.preset=lineage", "transfer.gradient=moments"}),
            "--set transfer.gradient=moments: transfer.gradient: found \"moments\", allowed with "
            "transfer.shape = \"quadratic\" or \"cubic\": the moments of the others depend on the "
            "place in a cell");
  EXPECT_EQ(problems(small_scene(), {"transfer.gradient=moments"}), "");
}

TEST(Contradictions, DampingOfWhatIsNotKept) {
  for (const std::string name : {"pic", "apic", "polypic"}) {
    const std::string velocity = "transfer.velocity=" + name;
    EXPECT_EQ(problems(small_scene(), {velocity, "transfer.damping=0.1"}),
              "--set transfer.damping=0.1: transfer.damping: found 0.1, allowed 0 with "
              "transfer.velocity = \"" +
                  name + "\", which keeps nothing that could be damped");
    EXPECT_EQ(problems(small_scene(), {velocity, "transfer.damping=0"}), "");
  }
  for (const std::string name : {"flip", "aflip", "iapic", "polyflip", "ipolypic"}) {
    EXPECT_EQ(problems(small_scene(), {"transfer.velocity=" + name, "transfer.damping=10"}), "");
  }
}

TEST(Contradictions, LimitedViscosityNeedsCubicSplines) {
  for (const std::string shape : {"linear", "gimp", "quadratic"}) {
    EXPECT_EQ(problems(small_scene(), {"transfer.shape=" + shape, "viscosity.limited=true"}),
              "--set viscosity.limited=true: viscosity.limited: found true, allowed with "
              "transfer.shape = \"cubic\": a particle of the others sees no three jumps in a row");
    EXPECT_EQ(problems(small_scene(), {"transfer.shape=" + shape, "viscosity.limited=false"}), "");
  }
  EXPECT_EQ(problems(small_scene(), {"viscosity.limited=true"}), "");
}

TEST(Contradictions, LargestStepOfAScheme) {
  const auto refused = [](const std::string& name) {
    return "--set time.cfl=1: time.cfl: found 1, allowed up to 0.9 with transfer.velocity = \"" +
           name + "\"";
  };
  for (const std::string name : {"pic", "flip"}) {
    EXPECT_EQ(problems(small_scene(), {"transfer.velocity=" + name, "time.cfl=1"}), refused(name));
    EXPECT_EQ(problems(small_scene(), {"transfer.velocity=" + name, "time.cfl=0.9"}), "");
  }
  EXPECT_EQ(problems(small_scene(), {"transfer.preset=lineage", "time.cfl=1"}), refused("flip"));
  for (const std::string name : {"apic", "aflip", "iapic", "polypic", "polyflip", "ipolypic"}) {
    EXPECT_EQ(problems(small_scene(), {"transfer.velocity=" + name, "time.cfl=1.5"}), "");
  }
}

TEST(Contradictions, SchemesThatCannotWork) {
  EXPECT_EQ(problems(small_scene(), {"transfer.shape=linear", "transfer.velocity=apic"}),
            "--set transfer.velocity=apic: transfer.velocity: found \"apic\", which "
            "transfer.shape = \"linear\" cannot carry, allowed \"flip\" with it");
  EXPECT_EQ(problems(small_scene(), {"transfer.preset=lineage"}), "");
  EXPECT_EQ(problems(small_scene(), {"transfer.shape=gimp", "transfer.velocity=pic"}),
            "--set transfer.velocity=pic: transfer.velocity: found \"pic\", which "
            "transfer.shape = \"gimp\" cannot carry, allowed \"flip\" with it");
  for (const std::string name : {"polypic", "polyflip", "ipolypic"}) {
    EXPECT_EQ(problems(small_scene(), {"transfer.shape=quadratic", "transfer.velocity=" + name}),
              "--set transfer.velocity=" + name + ": transfer.velocity: found \"" + name +
                  "\", which transfer.shape = \"quadratic\" cannot carry, allowed \"pic\", "
                  "\"flip\", \"apic\", \"aflip\" or \"iapic\" with it");
  }
  for (const std::string name : {"pic", "flip", "apic", "aflip", "iapic"}) {
    EXPECT_EQ(problems(small_scene(), {"transfer.shape=quadratic", "transfer.velocity=" + name}),
              "");
  }
  EXPECT_EQ(problems(small_scene(), {"transfer.preset=lineage", "conduction.on=true"}),
            "--set conduction.on=true: conduction.on: found true, allowed with transfer.shape = "
            "\"quadratic\" or \"cubic\": the spread of the others depends on the place in a cell");
}

TEST(Contradictions, Beat) {
  for (const std::string key : {"snapshot", "history"}) {
    const std::string change = "output." + key + "=7.5e-9";
    EXPECT_EQ(override_problems(change),
              "--set " + change + ": output." + key + ": found 7.5e-09 s, allowed " +
                  (key == "snapshot" ? "0 or " : "") + "whole multiples of output.beat = 5e-09 s");
  }
  EXPECT_EQ(override_problems("profile.every=1e-9"),
            "--set profile.every=1e-9: profile.every: found 1e-09 s, allowed 0 or whole multiples "
            "of output.beat = 5e-09 s");
  EXPECT_EQ(override_problems("checkpoint.every_time=1e-9"),
            "--set checkpoint.every_time=1e-9: checkpoint.every_time: found 1e-09 s, allowed 0 or "
            "whole multiples of output.beat = 5e-09 s");
  EXPECT_EQ(problems(small_scene(), {"output.beat=1e-9", "output.snapshot=7e-9"}), "");
}

TEST(Contradictions, SpallTime) {
  EXPECT_EQ(override_problems("material.0.spall_time=4e-8"),
            "--set material.0.spall_time=4e-8: material.0.spall_time: found 4e-08 s, allowed only "
            "with spall > 0: else the material never opens");
  EXPECT_EQ(problems(small_scene(), {"material.0.spall_time=4e-8", "material.0.spall=1e9"}), "");
}

TEST(Contradictions, OutputFields) {
  // A dataset of physics that the scene does not ask for.
  EXPECT_NE(override_problems("output.fields=[\"id\", \"failed\"]")
                .find("output.fields: found \"failed\", allowed \"id\", \"grain\""),
            std::string::npos);
  EXPECT_EQ(problems(small_scene(), {"output.fields=[\"failed\"]", "material.0.spall=1e9"}), "");
  EXPECT_EQ(override_problems("output.fields=[\"id\", \"id\"]"),
            "--set output.fields=[\"id\", \"id\"]: output.fields: found \"id\", allowed each name "
            "once");
  EXPECT_EQ(
      override_problems("output.fields=[]"),
      "--set output.fields=[]: output.fields: found an empty list, allowed at least one name, "
      "or no such key");
}

TEST(Contradictions, Melting) {
  const std::string melts = "melting = \"simon_glatzel\"\n";
  const auto with = [&](const std::string& keys) {
    std::string text = small_scene();
    text.insert(text.find("[sample]"), keys);
    return problems(text);
  };
  EXPECT_EQ(with(melts + "[material.melt]\ntemperature = 200\nlatent_heat = 4e5\n"),
            "s.toml:15:1: material.0.melt.pressure: missing, give a number > 0 (Pa)\n"
            "s.toml:15:1: material.0.melt.exponent: missing, give a number > 0");
  EXPECT_EQ(with("kinematic_share = 0.5\nmelting = \"lindemann\"\n"
                 "melt = { temperature = 200, latent_heat = 4e5 }\n"),
            "s.toml:14:19: material.0.kinematic_share: found 0.5, allowed 0 where the material "
            "melts: a liquid keeps no back stress\n"
            "s.toml:16:24: material.0.melt.temperature: found 200 K, allowed more than T0 = 300 K: "
            "it starts solid");
  EXPECT_EQ(problems("thermal = \"paper\"\n" + small_scene(),
                     {"material.0.melting=lindemann",
                      "material.0.melt={temperature=900, latent_heat=4e5}"}),
            "--set material.0.melting=lindemann: material.0.melting: found a melt curve, allowed "
            "only with thermal = \"conserving\": in paper mode not all heat is in the temperature");
  EXPECT_EQ(problems(small_scene("[morphology]\nfields = [\"molten\"]\nthresholds = [0.5]\n")),
            "s.toml:19:10: morphology.fields: found \"molten\", allowed only where a material "
            "melts: set material.melting");
}

TEST(Contradictions, BehindAFreeSide) {
  const auto with = [&](const std::string& high) {
    return problems(small_scene("[boundary]\nhigh = " + high + "\n"));
  };
  EXPECT_EQ(with("{ kind = \"free\", behind = \"aluminium\" }"), "");
  EXPECT_EQ(with("{ kind = \"free\", behind = \"water\" }"),
            "s.toml:19:34: boundary.high.behind: found \"water\", allowed the name of a "
            "[[material]]");
  EXPECT_EQ(with("{ kind = \"wall\", behind = \"aluminium\" }"),
            "s.toml:19:34: boundary.high.behind: found \"aluminium\", allowed only with kind = "
            "\"free\"");
}

}  // namespace
}  // namespace poreshock
