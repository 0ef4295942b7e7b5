#include "check_window.hpp"

#include <string>

#include "probe_table.hpp"

namespace poreshock::scene_text {
namespace {

constexpr int least_rows = 128;

/// Samples of which any layer can be made at any time.
bool comes_in_layers(const Sample& sample) {
  return sample.kind == SampleKind::solid || sample.kind == SampleKind::packed_grains ||
         (sample.kind == SampleKind::random_voids && !sample.overlap);
}

/// True where loading moves material along the shock axis only.
bool moves_straight(const Scene& scene) {
  for (int a = 0; a + 1 < scene.dimension; ++a) {
    if (scene.loading.frame[static_cast<std::size_t>(a)] != 0.0) return false;
  }
  return true;
}

/// Names every probe that looks at material, which may not be made yet or no longer be there.
void require_points(const Scene& scene, Report& report) {
  for (std::size_t i = 0; i < scene.probes.size(); ++i) {
    const ProbeKind kind = scene.probes[i].kind;
    if (kind == ProbeKind::point) continue;
    add_problem("probe." + std::to_string(i) + ".kind",
                "found \"" + name_in(probe_kinds(), kind) +
                    "\", allowed with time.follow = \"front\" only \"point\": the material that it "
                    "looks at may not be made yet, or handed over. Look at a point, or take a "
                    "domain of the whole sample without time.follow",
                report);
  }
}

}  // namespace

void check_window(const Scene& scene, Report& report) {
  if (!good(report, {"time", "domain", "boundary", "sample", "morphology"})) return;
  if (!follows_front(scene)) return;
  const auto require = [&](bool holds, const char* allowed) {
    if (holds) return;
    add_problem("time.follow", std::string("found \"front\", allowed only ") + allowed, report);
  };
  require(scene.domain.cells[scene.dimension - 1] >= least_rows,
          "with a domain of at least 128 cells along the shock axis");
  require(
      side_law(scene.boundary.low.kind).mirrors && !side_law(scene.boundary.high.kind).mirrors,
      "with boundary.low = \"wall\" or \"symmetry\", which drives the front, and high = \"free\"");
  require(comes_in_layers(scene.sample),
          "with sample.kind = \"solid\", \"random_voids\" without overlap, or \"packed_grains\"");
  require(scene.bodies.empty() && scene.voids.empty(), "without [[body]] and [[void]]");
  require(can_sleep(scene) && moves_straight(scene) && !scene.conduction.on,
          "where material ahead of the front only moves: without body force, conduction, lateral "
          "planes and a lateral loading.frame, and with time.sleep");
  require(!scene.contact.self, "with contact.self = false");
  require(scene.morphology.lattice == MapLattice::eulerian,
          "with morphology.lattice = \"eulerian\"");
  require_points(scene, report);
}

}  // namespace poreshock::scene_text
