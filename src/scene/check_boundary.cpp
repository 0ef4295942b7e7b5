#include <algorithm>
#include <string>

#include "check_scene.hpp"
#include "rules.hpp"

namespace poreshock::scene_text {
namespace {

void check_behind(const Scene& scene, const Side& side, const std::string& path, Report& report) {
  if (side.behind.empty() || has_problem(report, path)) return;
  const std::string found = "found \"" + side.behind + "\", allowed ";
  if (!side_law(side.kind).lets_out) {
    add_problem(path, found + "only with kind = \"free\"", report);
  } else if (std::none_of(scene.materials.begin(), scene.materials.end(),
                          [&](const MaterialParameters& m) { return m.name == side.behind; })) {
    add_problem(path, found + "the name of a [[material]]", report);
  } else if (scene.sample.kind == SampleKind::none || scene.contact.self || has_grains(scene)) {
    add_problem(path, found + "only behind a [sample] of one grain, to whose ends it is bonded",
                report);
  }
}

void check_side(const Side& side, const std::string& path, Report& report) {
  if (side_law(side.kind).drives) return;
  if (side.velocity != 0.0) {
    add_problem(path + ".velocity",
                "found " + plain_number(side.velocity) + " m/s, allowed only with kind = \"wall\"",
                report);
  }
  if (side.friction != 0.0) {
    add_problem(path + ".friction",
                "found " + plain_number(side.friction) + ", allowed only with kind = \"wall\"",
                report);
  }
}

}  // namespace

void check_boundary(const Scene& scene, Report& report) {
  const Side& low = scene.boundary.low;
  const Side& high = scene.boundary.high;
  check_side(low, "boundary.low", report);
  check_side(high, "boundary.high", report);
  check_behind(scene, low, "boundary.low.behind", report);
  check_behind(scene, high, "boundary.high.behind", report);
  if (!good(report, {"boundary.low", "boundary.high"})) return;
  const bool low_moves = low.velocity != 0.0;
  const bool high_moves = high.velocity != 0.0;
  if (!low_moves && !high_moves) return;
  const Side& moving = low_moves ? low : high;
  const Side& other = low_moves ? high : low;
  // The background grid rides with a moving wall, so the other side may not stay behind.
  if (!side_law(other.kind).mirrors) return;
  if (side_law(other.kind).drives && other.velocity == moving.velocity) return;
  const std::string found = side_law(other.kind).drives
                                ? "a wall at " + plain_number(other.velocity) + " m/s"
                                : "a symmetry plane";
  add_problem(low_moves ? "boundary.high" : "boundary.low",
              "found " + found + " opposite to a moving wall, allowed \"free\" or a wall at " +
                  plain_number(moving.velocity) + " m/s too",
              report);
}

}  // namespace poreshock::scene_text
