#include "poreshock/physics/transmit.hpp"

#include <algorithm>
#include <cmath>

#include "poreshock/transfer/node_views.hpp"

namespace poreshock {

Backing make_backing(const MaterialParameters& p) {
  Backing backing{p.density, p.c0, p.lambda, 0.0, 0.0};
  const double shear = p.young / (2.0 * (1.0 + p.poisson));
  const double longitudinal = std::sqrt(p.c0 * p.c0 + 4.0 / 3.0 * shear / p.density);
  backing.shear_impedance = p.density * (longitudinal - p.c0);
  double yield = p.yield;
  for_each_flow_law(p, [&](StrengthModel model, const auto& law) {
    if (p.strength == model) yield = law.yield;
  });
  backing.strength = 2.0 / 3.0 * yield;
  return backing;
}

double backing_stress(const Backing& b, double w) {
  const double size = w < 0.0 ? -w : w;
  const double longitudinal = b.c0 + b.shear_impedance / b.density;
  // Up to its elastic limit it is stiff; what follows runs into what the precursor has moved.
  const double rise = b.shear_impedance * (1.0 + b.c0 / longitudinal);
  const double limit = rise > 0.0 ? b.strength / rise : 0.0;
  const double elastic = size < limit ? size : limit, plastic = size - elastic;
  const double steep = w > 0.0 ? b.lambda : 0.0;
  const double stress = b.density * (elastic * (longitudinal + steep * elastic) +
                                     plastic * (b.c0 + steep * (size + elastic)));
  return w < 0.0 ? -stress : stress;
}

double front_stress(const Backing& b, double w, double viscous_pressure) {
  const double most = w > 0.0 ? b.density * b.lambda * w * w : 0.0;
  return std::min(0.5 * viscous_pressure, most);
}

template <int Dim>
void push_ends(const SlabGrid& ends, double dt, SlabGrid& grid, NodeLedger& ledger) {
  constexpr int axis = Dim - 1;
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    const Lanes* forces = ends.row(row);
    for (int i = 0; i < grid.shape().row_size; ++i) {
      Lanes* const at = grid.find(0, row, i);
      if (at == nullptr) continue;
      const MotionNode<Dim> node{*at};
      const double impulse = dt * forces[i][end_force];
      if (!(node.mass() > 0.0) || impulse == 0.0) continue;
      node.set_end(axis, node.end(axis) + impulse / node.mass());
      if (row >= grid.last_row()) continue;
      ledger.wall_impulse[axis] += quantise(impulse, ledger.inverse_momentum_quantum);
      ledger.wall_work += quantise(impulse * node.middle(axis), ledger.inverse_energy_quantum);
    }
  }
}

template void push_ends<2>(const SlabGrid&, double, SlabGrid&, NodeLedger&);
template void push_ends<3>(const SlabGrid&, double, SlabGrid&, NodeLedger&);

}  // namespace poreshock
