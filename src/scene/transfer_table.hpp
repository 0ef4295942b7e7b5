#pragma once
// The keys of [transfer]; their defaults depend on each other.

#include "poreshock/scene/scene.hpp"
#include "rules.hpp"

namespace poreshock::scene_text {

template <typename Visitor>
void visit_transfer(Visitor& visitor, Transfer& transfer) {
  const Names<ShapeFunction> shapes{{"linear", ShapeFunction::linear},
                                    {"gimp", ShapeFunction::gimp},
                                    {"quadratic", ShapeFunction::quadratic},
                                    {"cubic", ShapeFunction::cubic}};
  const Names<VelocityTransfer> transfers{{"pic", VelocityTransfer::pic},
                                          {"flip", VelocityTransfer::flip},
                                          {"apic", VelocityTransfer::apic}};
  bool lineage = false;
  const Names<bool> presets{{"none", false}, {"lineage", true}};
  choice(visitor, "preset", lineage, presets,
         {"lineage: gimp, flip, no averaging by default, the common scheme of 2008-2010"});
  if (lineage) {
    visitor.fallback(transfer.shape, ShapeFunction::gimp);
    visitor.fallback(transfer.velocity, VelocityTransfer::flip);
  }
  choice(visitor, "shape", transfer.shape, shapes,
         {"between particles and grid: hat, uniform GIMP, quadratic or cubic B-spline"});
  choice(visitor, "velocity", transfer.velocity, transfers, {"transfer of velocity"});
  const bool hat = is_hat(transfer.shape);
  visitor.number("damping", transfer.damping,
                 {not_negative, "1/s", "of FLIP velocity noise; with flip only"});
  visitor.fallback(transfer.averaging, hat ? 0.0 : 1.0);
  visitor.number("averaging", transfer.averaging,
                 {share, "", "share of the averaged dilatation, by default 1, 0 with hats"});
}

}  // namespace poreshock::scene_text
