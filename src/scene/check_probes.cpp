#include <algorithm>
#include <string>

#include "check_scene.hpp"
#include "rules.hpp"

namespace poreshock::scene_text {
namespace {

constexpr std::size_t longest_name = 40;
constexpr double tolerance = 1e-9;

std::string path_of(std::size_t index, const char* key) {
  return "probe." + std::to_string(index) + "." + key;
}

/// Part of a file name on any system.
bool plain_name(const std::string& name) {
  return !name.empty() && name.size() <= longest_name &&
         std::all_of(name.begin(), name.end(), [](char c) {
           return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                  c == '_' || c == '-';
         });
}

void check_name(const Scene& scene, std::size_t i, Report& report) {
  const std::string path = path_of(i, "name"), &name = scene.probes[i].name;
  if (has_problem(report, path)) return;
  if (!plain_name(name)) {
    add_problem(path,
                "found \"" + name +
                    "\", allowed 1 to 40 letters, digits, _ and -: it is part of "
                    "a file name",
                report);
    return;
  }
  const auto end = scene.probes.begin() + static_cast<std::ptrdiff_t>(i);
  if (std::any_of(scene.probes.begin(), end, [&](const Probe& p) { return p.name == name; })) {
    add_problem(path, "found \"" + name + "\" again, allowed a name of its own for each probe",
                report);
  }
}

void check_place(const Scene& scene, std::size_t i, Report& report) {
  const Probe& probe = scene.probes[i];
  const std::string path = path_of(i, "at");
  if (has_problem(report, path) || !good(report, {"domain.size"})) return;
  // A point stays in the laboratory while the grid may ride with a wall; heights count at the
  // start.
  const int axes = scene.dimension - (probe.kind == ProbeKind::surface ? 1 : 0);
  for (int axis = 0; axis < axes; ++axis) {
    const double size = scene.domain.size[axis];
    if (probe.at[axis] >= 0.0 && probe.at[axis] <= size) continue;
    if (probe.kind == ProbeKind::point && axis == scene.dimension - 1) continue;
    add_problem(path,
                "found " + plain_number(probe.at[axis]) + " m along " + "xyz"[axis] +
                    ", allowed 0 to domain.size = " + plain_number(size) + " m",
                report);
  }
}

}  // namespace

void check_probes(const Scene& scene, Report& report) {
  for (std::size_t i = 0; i < scene.probes.size(); ++i) {
    check_name(scene, i, report);
    check_place(scene, i, report);
    const std::string path = path_of(i, "width");
    if (has_problem(report, path) || !good(report, {"domain.cell"})) continue;
    if (scene.probes[i].width >= (1.0 - tolerance) * scene.domain.cell) continue;
    add_problem(path,
                "found " + plain_number(scene.probes[i].width) +
                    " m, allowed at least domain.cell = " + plain_number(scene.domain.cell) +
                    " m: nothing finer is resolved",
                report);
  }
}

}  // namespace poreshock::scene_text
