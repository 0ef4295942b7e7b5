#include <string>

#include "check_scene.hpp"
#include "rules.hpp"

namespace poreshock::scene_text {
namespace {

std::string path_of(std::size_t index, const char* key) {
  return "material." + std::to_string(index) + "." + key;
}

void check_name(const Scene& scene, std::size_t i, Report& report) {
  const std::string& name = scene.materials[i].name;
  for (std::size_t j = 0; j < i; ++j) {
    if (name.empty() || scene.materials[j].name != name) continue;
    add_problem(path_of(i, "name"),
                "found \"" + name + "\" again, allowed a name of its own for each material",
                report);
    return;
  }
}

void check_strength(const MaterialParameters& m, std::size_t i, Report& report) {
  const JohnsonCookParameters& cook = m.johnson_cook;
  if (m.strength == StrengthModel::johnson_cook &&
      !has_problem(report, path_of(i, "johnson_cook")) &&
      cook.melting <= cook.reference_temperature) {
    add_problem(path_of(i, "johnson_cook.melting"),
                "found " + plain_number(cook.melting) +
                    " K, allowed more than reference_temperature = " +
                    plain_number(cook.reference_temperature) + " K",
                report);
  }
  const SteinbergGuinanParameters& guinan = m.steinberg_guinan;
  if (m.strength == StrengthModel::steinberg_guinan &&
      !has_problem(report, path_of(i, "steinberg_guinan")) && guinan.limit < guinan.yield) {
    add_problem(path_of(i, "steinberg_guinan.limit"),
                "found " + plain_number(guinan.limit) +
                    " Pa, allowed at least yield = " + plain_number(guinan.yield) + " Pa",
                report);
  }
}

void check_melting(const Scene& scene, std::size_t i, Report& report) {
  const MaterialParameters& m = scene.materials[i];
  if (m.melting == MeltingLaw::none || has_problem(report, path_of(i, "melting"))) return;
  if (scene.thermal == Thermal::paper && good(report, {"thermal"})) {
    add_problem(path_of(i, "melting"),
                "found a melt curve, allowed only with thermal = \"conserving\": in paper mode not "
                "all heat is in the temperature",
                report);
  }
  if (m.kinematic_share > 0.0 && !has_problem(report, path_of(i, "kinematic_share"))) {
    add_problem(path_of(i, "kinematic_share"),
                "found " + plain_number(m.kinematic_share) +
                    ", allowed 0 where the material melts: a liquid keeps no back stress",
                report);
  }
  if (!has_problem(report, path_of(i, "melt")) && !(m.melt.temperature > m.T0)) {
    add_problem(path_of(i, "melt.temperature"),
                "found " + plain_number(m.melt.temperature) +
                    " K, allowed more than T0 = " + plain_number(m.T0) + " K: it starts solid",
                report);
  }
}

void check_spall(const MaterialParameters& m, std::size_t i, Report& report) {
  if (!(m.spall_time > 0.0) || m.spall > 0.0 || has_problem(report, path_of(i, "spall"))) return;
  add_problem(path_of(i, "spall_time"),
              "found " + plain_number(m.spall_time) +
                  " s, allowed only with spall > 0: else the material never opens",
              report);
}

}  // namespace

void check_materials(const Scene& scene, Report& report) {
  if (scene.materials.empty() && !has_problem(report, "material")) {
    add_problem("material", "missing, give at least one table [[material]]", report);
  }
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    check_name(scene, i, report);
    check_strength(scene.materials[i], i, report);
    check_melting(scene, i, report);
    check_spall(scene.materials[i], i, report);
  }
}

}  // namespace poreshock::scene_text
