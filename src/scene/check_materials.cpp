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

}  // namespace

void check_materials(const Scene& scene, Report& report) {
  if (scene.materials.empty() && !has_problem(report, "material")) {
    add_problem("material", "missing, give at least one table [[material]]", report);
  }
  for (std::size_t i = 0; i < scene.materials.size(); ++i) {
    check_name(scene, i, report);
    check_strength(scene.materials[i], i, report);
  }
}

}  // namespace poreshock::scene_text
