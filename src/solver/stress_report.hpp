#pragma once
// Private to solver: what the stress update tells the clock and the ledger.

#include <algorithm>

#include "poreshock/solver/simulation.hpp"

namespace poreshock {

/// Takes over limit of the step, bad particles, guards and viscous heat.
template <int Dim>
inline void take_report(const StressReport& report, Simulation<Dim>& sim) {
  sim.clock.limit = std::min(report.dt_limit, sim.conduction_limit);
  sim.clock.bad = report.bad;
  sim.ledger.guards.compression += report.compression_guard;
  sim.ledger.guards.sound_speed += report.sound_speed_guard;
  sim.ledger.viscous_heat += report.viscous_heat;
}

}  // namespace poreshock
