#pragma once
// Timing of named phases of a run: a PETSc log event (so that -log_view shows it) and our own
// table.

#include <petscsys.h>

#include <array>
#include <cstdint>
#include <initializer_list>
#include <string_view>

namespace poreshock {

/// Phases of a run, in the order of the table at its end.
enum class PhaseName {
  sort,
  particles_to_grid,
  exchange,
  grid_update,
  contact,
  grid_to_particles,
  conduction,
  stress,
  time_step,
  migrate,
  rebalance,
  morphology,
  profile,
  history,
  snapshot,
  checkpoint,
  count
};

/// Printable name of a phase.
std::string_view phase_name(PhaseName phase);

/// Seconds and calls per phase on this rank.
struct PhaseTable {
  std::array<double, static_cast<int>(PhaseName::count)> seconds{};
  std::array<long, static_cast<int>(PhaseName::count)> calls{};
  std::array<PetscLogEvent, static_cast<int>(PhaseName::count)> events{};
};

/// Seconds this rank has spent in some phases together.
double seconds_in(const PhaseTable& table, std::initializer_list<PhaseName> phases);

/// Makes a table and registers its PETSc log events. Collective.
PhaseTable make_phase_table();

/// Counts the time between its construction and destruction to one phase. Not collective.
class Phase {
 public:
  Phase(PhaseTable& table, PhaseName name);
  ~Phase();
  Phase(const Phase&) = delete;
  Phase& operator=(const Phase&) = delete;

 private:
  PhaseTable& table_;
  int index_;
  double start_;
};

/// Calls run() within a phase.
template <class Run>
void timed(PhaseTable& table, PhaseName name, Run&& run) {
  const Phase phase(table, name);
  run();
}

}  // namespace poreshock
