#include "poreshock/physics/momentum.hpp"

#include "poreshock/transfer/node_lanes.hpp"

namespace poreshock {

template <int Dim>
void integrate_momentum(const Vector<Dim>& body_force, double dt, SlabGrid& grid) {
  using Sum = SumLane<Dim>;
  using Motion = MotionLane<Dim>;
  const Lanes* const end = grid.nodes_from(grid.node_end());
  for (Lanes* node = grid.nodes_from(grid.first_row()); node != end; ++node) {
    const Lanes sum = *node;
    const double mass = sum[Sum::mass];
    if (!(mass > 0.0)) {
      *node = Lanes{};
      continue;
    }
    Lanes motion{};
    const double inverse_mass = 1.0 / mass;
    for (int a = 0; a < Dim; ++a) {
      const double start = sum[Sum::momentum + a] * inverse_mass;
      motion[Motion::start_velocity + a] = start;
      motion[Motion::end_velocity + a] =
          start + dt * (sum[Sum::force + a] * inverse_mass + body_force[a]);
    }
    motion[Motion::mass] = mass;
    *node = motion;
  }
}

template <int Dim>
void add_body_work(const Vector<Dim>& body_force, double dt, const SlabGrid& grid,
                   NodeLedger& ledger) {
  using Motion = MotionLane<Dim>;
  if (!(body_force.squaredNorm() > 0.0)) return;
  const Lanes* const end = grid.nodes_from(grid.last_row());
  for (const Lanes* node = grid.nodes_from(grid.first_row()); node != end; ++node) {
    const double mass = (*node)[Motion::mass];
    double power = 0.0;
    for (int a = 0; a < Dim; ++a) {
      power += body_force[a] * 0.5 *
               ((*node)[Motion::start_velocity + a] + (*node)[Motion::end_velocity + a]);
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
