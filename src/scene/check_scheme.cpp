#include <string>

#include "check_scene.hpp"
#include "check_window.hpp"
#include "poreshock/scene/transfer_scheme.hpp"
#include "rules.hpp"

namespace poreshock::scene_text {
namespace {

std::string name_of(ShapeFunction shape) {
  return std::string(of_shape(shape, [](const auto& s) { return s.name; }));
}

/// Names of the shapes of which allows(shape function) is true, in words.
template <class Allows>
std::string shapes_with(Allows&& allows) {
  std::vector<std::string> names;
  for (const ShapeFunction shape : shape_functions) {
    if (of_shape(shape, allows)) names.push_back(name_of(shape));
  }
  return allowed_names(names);
}

/// Combinations that cannot work, with the reason.
void check_combination(const Transfer& transfer, Report& report) {
  const TransferScheme& scheme = scheme_of(transfer.velocity);
  if (!suits(scheme, transfer.shape)) {
    std::vector<std::string> allowed;
    for (const TransferScheme& one : transfer_schemes) {
      if (suits(one, transfer.shape)) allowed.emplace_back(one.name);
    }
    add_problem("transfer.velocity",
                "found \"" + std::string(scheme.name) + "\", which transfer.shape = \"" +
                    name_of(transfer.shape) + "\" cannot carry, allowed " + allowed_names(allowed) +
                    " with it",
                report);
  }
  if (scheme.keeps == Keeps::nothing && transfer.damping > 0.0) {
    add_problem("transfer.damping",
                "found " + plain_number(transfer.damping) +
                    ", allowed 0 with transfer.velocity = \"" + std::string(scheme.name) +
                    "\", which keeps nothing that could be damped",
                report);
  }
}

void check_gradient(const Transfer& transfer, Report& report) {
  const auto spreads = []<class Shape>(const Shape&) { return has_inertia<Shape>; };
  if (transfer.gradient == Gradient::slopes || of_shape(transfer.shape, spreads)) return;
  add_problem("transfer.gradient",
              "found \"moments\", allowed with transfer.shape = " + shapes_with(spreads) +
                  ": the moments of the others depend on the place in a cell",
              report);
}

/// The largest cfl of a scheme.
void check_step(const Scene& scene, Report& report) {
  if (!good(report, {"transfer.velocity", "time.cfl"})) return;
  const TransferScheme& scheme = scheme_of(scene.transfer.velocity);
  if (scene.time.cfl <= scheme.largest_cfl) return;
  add_problem("time.cfl",
              "found " + plain_number(scene.time.cfl) + ", allowed up to " +
                  plain_number(scheme.largest_cfl) + " with transfer.velocity = \"" +
                  std::string(scheme.name) + "\"",
              report);
}

void check_viscosity(const Scene& scene, Report& report) {
  if (!good(report, {"viscosity.limited", "transfer.shape"}) || !scene.viscosity.limited) return;
  const auto sees_jumps = [](const auto& s) { return s.width > 3; };
  if (of_shape(scene.transfer.shape, sees_jumps)) return;
  add_problem("viscosity.limited",
              "found true, allowed with transfer.shape = " + shapes_with(sees_jumps) +
                  ": a particle of the others sees no three jumps in a row",
              report);
}

void check_transfer(const Scene& scene, Report& report) {
  if (!good(report, {"transfer.velocity", "transfer.damping", "transfer.shape"})) {
    return;
  }
  check_combination(scene.transfer, report);
  if (good(report, {"transfer.gradient"})) check_gradient(scene.transfer, report);
  check_step(scene, report);
  check_viscosity(scene, report);
}

void check_conduction(const Scene& scene, Report& report) {
  if (!good(report, {"conduction", "transfer.shape"}) || !scene.conduction.on) return;
  const auto spreads = []<class Shape>(const Shape&) { return has_inertia<Shape>; };
  if (of_shape(scene.transfer.shape, spreads)) return;
  add_problem("conduction.on",
              "found true, allowed with transfer.shape = " + shapes_with(spreads) +
                  ": the spread of the others depends on the place in a cell",
              report);
}

/// Self-contact where it cannot work, with the reason.
void check_self_contact(const Scene& scene, Report& report) {
  if (!good(report, {"contact.self"}) || !scene.contact.self) return;
  std::string allowed;
  if (scene.dimension == 3) {
    allowed = "false in 3-D: the sides of a void wall are told apart in the plane only";
  } else if (makes_grains(scene.sample)) {
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
  check_window(scene, report);
}

}  // namespace poreshock::scene_text
