#include "poreshock/physics/momentum.hpp"

#include "poreshock/transfer/node_views.hpp"

namespace poreshock {

template <int Dim>
void integrate_momentum(const Vector<Dim>& body_force, double dt, SlabGrid& grid) {
  const Lanes* const last = grid.nodes_from(grid.node_end());
  for (Lanes* node = grid.nodes_from(grid.first_row()); node != last; ++node) {
    const Lanes sums = *node;
    // As a template argument the type of Lanes forgets that it may lie at any address.
    alignas(sizeof(Lanes)) Lanes moved{};
    const SumNode<Dim> sum{sums};
    const MotionNode<Dim> motion{moved};
    // A mass that is no number goes on into the velocities, where the stress update finds it.
    if (!(sum.mass() <= 0.0)) {
      const double inverse_mass = 1.0 / sum.mass();
      for (int a = 0; a < Dim; ++a) {
        const double start = sum.momentum(a) * inverse_mass;
        motion.set_start(a, start);
        motion.set_end(a, start + dt * (sum.force(a) * inverse_mass + body_force[a]));
      }
      motion.set_mass(sum.mass());
    }
    *node = moved;
  }
}

template <int Dim>
void add_body_work(const Vector<Dim>& body_force, double dt, const SlabGrid& grid,
                   NodeLedger& ledger) {
  if (!(body_force.squaredNorm() > 0.0)) return;
  const Lanes* const last = grid.nodes_from(grid.last_row());
  for (const Lanes* at = grid.nodes_from(grid.first_row()); at != last; ++at) {
    const MotionNode<Dim, const Lanes> node{*at};
    const double mass = node.mass();
    double power = 0.0;
    for (int a = 0; a < Dim; ++a) {
      power += body_force[a] * node.middle(a);
      ledger.body_impulse[a] +=
          quantise(mass * body_force[a] * dt, ledger.inverse_momentum_quantum);
    }
    ledger.body_work += quantise(mass * power * dt, ledger.inverse_energy_quantum);
  }
}

template void integrate_momentum<2>(const Vector<2>&, double, SlabGrid&);
template void add_body_work<2>(const Vector<2>&, double, const SlabGrid&, NodeLedger&);
template void add_body_work<3>(const Vector<3>&, double, const SlabGrid&, NodeLedger&);
template void integrate_momentum<3>(const Vector<3>&, double, SlabGrid&);

}  // namespace poreshock
