#pragma once
// The keys of [transfer]; their defaults depend on each other.

#include "poreshock/scene/scene.hpp"
#include "poreshock/scene/transfer_scheme.hpp"
#include "rules.hpp"

namespace poreshock::scene_text {

template <typename Visitor>
void visit_transfer(Visitor& visitor, Scene& scene) {
  Transfer& transfer = scene.transfer;
  Names<ShapeFunction> shapes;
  for (const ShapeFunction shape : shape_functions) {
    shapes.emplace_back(of_shape(shape, [](const auto& s) { return s.name; }), shape);
  }
  Names<VelocityTransfer> transfers;
  for (const TransferScheme& one : transfer_schemes) {
    transfers.emplace_back(one.name, one.velocity);
  }
  bool lineage = false;
  const Names<bool> presets{{"none", false}, {"lineage", true}};
  choice(visitor, "preset", lineage, presets,
         {"lineage: gimp and flip by default, the common scheme of 2008-2010"});
  if (lineage) {
    visitor.fallback(transfer.shape, ShapeFunction::gimp);
  }
  choice(visitor, "shape", transfer.shape, shapes,
         {"between particles and grid: hat, uniform GIMP, quadratic or cubic B-spline"});
  const TransferScheme& best = scheme_of(VelocityTransfer::aflip);
  visitor.fallback(transfer.velocity,
                   suits(best, transfer.shape) ? best.velocity : VelocityTransfer::flip);
  choice(visitor, "velocity", transfer.velocity, transfers, {"transfer of velocity"});
  // Beside other grains forces on nodes of little mass should be small.
  const bool spreads = of_shape(transfer.shape, []<class S>(const S&) { return has_inertia<S>; });
  visitor.fallback(transfer.gradient,
                   has_grains(scene) && spreads ? Gradient::moments : Gradient::slopes);
  const Names<Gradient> gradients{{"slopes", Gradient::slopes}, {"moments", Gradient::moments}};
  choice(visitor, "gradient", transfer.gradient, gradients,
         {"of the velocity, and of the stress likewise, by slopes of the shape function or by its "
          "first moments: the latter keeps more of the speed of grains that meet"});
  // What a tie withholds from the particles decays with their residual. Where grains meet
  // everywhere that should be slow; in plates it keeps the noise of traces small.
  visitor.fallback(transfer.damping,
                   scheme_of(transfer.velocity).damping / (makes_grains(scene.sample) ? 5.0 : 1.0));
  visitor.number("damping", transfer.damping,
                 {{.low = 0.0, .high = 10.0},
                  "",
                  "of what the grid does not see of a particle's motion, while sound crosses a "
                  "cell; 0 with transfers that keep nothing of it"});
}

}  // namespace poreshock::scene_text
