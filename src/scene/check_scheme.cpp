#include <string>

#include "check_scene.hpp"
#include "rules.hpp"

namespace poreshock::scene_text {
namespace {

constexpr double greatest_hat_averaging = 0.5;

/// Combinations that cannot work, with the reason.
void check_combination(const Transfer& transfer, Report& report) {
  const bool linear = transfer.shape == ShapeFunction::linear;
  const bool spline = !is_hat(transfer.shape);
  if (!spline && transfer.velocity != VelocityTransfer::flip) {
    add_problem("transfer.velocity",
                std::string("found a transfer that needs B-splines, allowed \"flip\" with "
                            "transfer.shape = \"") +
                    (linear ? "linear" : "gimp") + "\"",
                report);
  }
  // Slopes that jump where a particle crosses a cell feed what the average hides, and it grows.
  if (!spline && transfer.averaging > greatest_hat_averaging) {
    add_problem("transfer.averaging",
                "found " + plain_number(transfer.averaging) +
                    ", allowed up to 0.5 with transfer.shape = \"linear\" or \"gimp\": more is "
                    "unstable when material crosses cells",
                report);
  }
}

/// The largest cfl of a scheme: the noise of FLIP and of hats grows at large steps.
void check_step(const Scene& scene, Report& report) {
  const Transfer& transfer = scene.transfer;
  if (!good(report, {"transfer.velocity", "time.cfl"})) return;
  constexpr double most = 0.9;
  if (transfer.velocity == VelocityTransfer::apic || scene.time.cfl <= most) return;
  add_problem("time.cfl",
              "found " + plain_number(scene.time.cfl) + ", allowed up to " + plain_number(most) +
                  " unless transfer.velocity = \"apic\"",
              report);
}

void check_transfer(const Scene& scene, Report& report) {
  const Transfer& transfer = scene.transfer;
  if (!good(report, {"transfer.velocity", "transfer.damping"})) return;
  if (transfer.damping > 0.0 && transfer.velocity != VelocityTransfer::flip) {
    add_problem("transfer.damping",
                "found " + plain_number(transfer.damping) +
                    " 1/s, allowed 0 unless transfer.velocity = \"flip\"",
                report);
  }
  if (!good(report, {"transfer.shape", "transfer.averaging"})) return;
  check_combination(transfer, report);
  check_step(scene, report);
}

void check_conduction(const Scene& scene, Report& report) {
  if (!good(report, {"conduction", "transfer.shape"}) || !scene.conduction.on) return;
  if (!is_hat(scene.transfer.shape)) return;
  add_problem("conduction.on",
              "found true, allowed with transfer.shape = \"quadratic\" or \"cubic\": the slopes of "
              "the others jump where particles cross cells",
              report);
}

/// Self-contact where it cannot work, with the reason.
void check_self_contact(const Scene& scene, Report& report) {
  if (!good(report, {"contact.self"}) || !scene.contact.self) return;
  std::string allowed;
  if (scene.dimension == 3) {
    allowed = "false in 3-D: the sides of a void wall are told apart in the plane only";
  } else if (makes_grains(scene.sample.kind)) {
    allowed = "false with a sample of grains: each grain has one velocity field";
  } else if (scene.contact.normal == ContactNormal::regression) {
    allowed = "false with contact.normal = \"regression\": that parts grains, not sides of one";
  }
  if (!allowed.empty()) add_problem("contact.self", "found true, allowed " + allowed, report);
}

}  // namespace

void check_scheme(const Scene& scene, Report& report) {
  check_transfer(scene, report);
  check_conduction(scene, report);
  check_self_contact(scene, report);
}

}  // namespace poreshock::scene_text
