#pragma once
// Private to solver: what a step tells the clock and the ledger.

#include <algorithm>

#include "poreshock/physics/stress.hpp"
#include "poreshock/solver/ledger.hpp"
#include "poreshock/solver/time_step.hpp"
#include "poreshock/transfer/grid_to_particles.hpp"

namespace poreshock {

/// Of all particles of this rank.
struct StepReport {
  TransferReport transfer;
  StressReport stress;
};

/// Takes over limit of the step, bad particles, guards and heats.
inline void take_report(const StepReport& report, double conduction_limit, Clock& clock,
                        Ledger& ledger) {
  clock.limit = std::min(report.stress.dt_limit, conduction_limit);
  clock.bad = report.stress.bad;
  ledger.guards.compression += report.stress.compression_guard;
  ledger.guards.sound_speed += report.stress.sound_speed_guard;
  ledger.guards.negative_heat += report.transfer.negative;
  ledger.viscous_heat += report.stress.viscous_heat;
  ledger.compression_work += report.stress.compression_work;
  // What squeezes particles is no heat, and the stress update meets it as work that is missing.
  ledger.step_heat += report.stress.step_heat + report.transfer.squeezing;
  ledger.failure_heat += report.stress.failure_heat;
  ledger.transfer_heat += report.transfer.heat - report.transfer.squeezing;
  ledger.shortened += report.transfer.shortened;
}

}  // namespace poreshock
