#pragma once
// The keys of [transfer]; their defaults depend on each other.

#include "poreshock/scene/transfer_scheme.hpp"
#include "rules.hpp"

namespace poreshock::scene_text {

template <typename Visitor>
void visit_transfer(Visitor& visitor, Transfer& transfer) {
  const Names<ShapeFunction> shapes{{"linear", ShapeFunction::linear},
                                    {"gimp", ShapeFunction::gimp},
                                    {"quadratic", ShapeFunction::quadratic},
                                    {"cubic", ShapeFunction::cubic}};
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
  visitor.fallback(transfer.velocity,
                   is_hat(transfer.shape) ? VelocityTransfer::flip : VelocityTransfer::aflip);
  choice(visitor, "velocity", transfer.velocity, transfers, {"transfer of velocity"});
  visitor.fallback(transfer.damping, scheme_of(transfer.velocity).damping);
  visitor.number("damping", transfer.damping,
                 {{.low = 0.0, .high = 10.0},
                  "",
                  "of what the grid does not see of a particle's motion, while sound crosses a "
                  "cell; 0 with transfers that keep nothing of it"});
}

}  // namespace poreshock::scene_text
