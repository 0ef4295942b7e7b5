#include "poreshock/physics/momentum.hpp"

#include "poreshock/transfer/node_lanes.hpp"

namespace poreshock {

template <int Dim>
void integrate_momentum(const Vector<Dim>& body_force, double dt, SlabGrid& grid) {
  using Sum = SumLane<Dim>;
  using Motion = MotionLane<Dim>;
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    Lanes* nodes = grid.row(row);
    for (int i = 0; i < grid.shape().row_size; ++i) {
      const Lanes sum = nodes[i];
      const double mass = sum[Sum::mass];
      if (!(mass > 0.0)) {
        nodes[i] = Lanes{};
        continue;
      }
      Lanes motion{};
      const double inverse_mass = 1.0 / mass;
      for (int a = 0; a < Dim; ++a) {
        const double start = sum[Sum::momentum + a] * inverse_mass;
        const double end = start + dt * (sum[Sum::force + a] * inverse_mass + body_force[a]);
        motion[Motion::start_velocity + a] = start;
        motion[Motion::end_velocity + a] = end;
      }
      motion[Motion::mass] = mass;
      nodes[i] = motion;
    }
  }
}

template <int Dim>
void add_body_work(const Vector<Dim>& body_force, double dt, const SlabGrid& grid,
                   NodeLedger& ledger) {
  using Motion = MotionLane<Dim>;
  if (!(body_force.squaredNorm() > 0.0)) return;
  for (int row = grid.first_row(); row < grid.last_row(); ++row) {
    const Lanes* nodes = grid.row(row);
    for (int i = 0; i < grid.shape().row_size; ++i) {
      double power = 0.0;
      for (int a = 0; a < Dim; ++a) {
        power += body_force[a] * 0.5 *
                 (nodes[i][Motion::start_velocity + a] + nodes[i][Motion::end_velocity + a]);
        ledger.body_impulse[a] +=
            quantise(nodes[i][Motion::mass] * body_force[a] * dt, ledger.inverse_momentum_quantum);
      }
      ledger.body_work +=
          quantise(nodes[i][Motion::mass] * power * dt, ledger.inverse_energy_quantum);
    }
  }
}

template void integrate_momentum<2>(const Vector<2>&, double, SlabGrid&);
template void add_body_work<2>(const Vector<2>&, double, const SlabGrid&, NodeLedger&);
template void add_body_work<3>(const Vector<3>&, double, const SlabGrid&, NodeLedger&);
template void integrate_momentum<3>(const Vector<3>&, double, SlabGrid&);

}  // namespace poreshock
