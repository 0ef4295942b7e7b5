#pragma once
// Private to solver: what a step tells the clock and the ledger.

#include <algorithm>

#include "poreshock/solver/simulation.hpp"
#include "poreshock/transfer/grid_to_particles.hpp"

namespace poreshock {

/// Of all particles of this rank.
struct StepReport {
  TransferReport transfer;
  StressReport stress;
};

/// Takes over limit of the step, bad particles, guards and heats.
template <int Dim>
inline void take_report(const StepReport& report, Simulation<Dim>& sim) {
  sim.clock.limit = std::min(report.stress.dt_limit, sim.conduction_limit);
  sim.clock.bad = report.stress.bad;
  sim.ledger.guards.compression += report.stress.compression_guard;
  sim.ledger.guards.sound_speed += report.stress.sound_speed_guard;
  sim.ledger.guards.negative_heat += report.transfer.negative;
  sim.ledger.viscous_heat += report.stress.viscous_heat;
  sim.ledger.transfer_heat += report.transfer.heat;
  sim.ledger.shortened += report.transfer.shortened;
}

}  // namespace poreshock
