#pragma once
// The progress rows of a run and the table at its end.

#include <mpi.h>

#include <cstdint>
#include <string>
#include <vector>

#include "poreshock/core/phase.hpp"
#include "poreshock/output/timings.hpp"
#include "poreshock/run/time_to_go.hpp"
#include "poreshock/solver/row_cost.hpp"
#include "poreshock/solver/time_step.hpp"

namespace poreshock {

/// What the next progress row is computed from.
struct Progress {
  double start_wall = 0.0;            ///< s, MPI_Wtime at the start of the run
  std::int64_t start_memory = 0;      ///< bytes, peak_memory at the start of the run
  std::int64_t start_own = 0;         ///< bytes, own_memory at the start of the run
  std::int64_t most_own = 0;          ///< bytes beyond it, of all ranks at one time
  std::int64_t particle_steps = 0;    ///< of this rank since the start
  std::int64_t sleeping_steps = 0;    ///< those of them in rows asleep
  TimeToGo to_go;                     ///< with the last row
  double row_communication = 0.0;     ///< s, of all ranks up to the last row
  double row_compute = 0.0;           ///< s, of this rank up to the last row
  double row_all_compute = 0.0;       ///< s, of all ranks up to the last row
  std::vector<std::string> warnings;  ///< of the scene and its sample, for timings.json
};

/// Line with the names of the columns.
std::string progress_header();

/// Energies for the row, J.
struct EnergyStatus {
  double kinetic = 0.0, internal = 0.0, drift = 0.0;  ///< drift relative to the first total
};

/// One row of at most 100 columns: step, time, dt, energies, drift, million particle-steps per
/// second and core, share of communication, imbalance, time to go. Collective; the same text on
/// every rank.
std::string progress_row(const Clock& clock, double end, const EnergyStatus& energy,
                         const PhaseTable& phases, Progress& progress, MPI_Comm communicator);

/// Notes the memory that all ranks hold now, if it is the most so far; called at records and
/// rebalances. Collective.
void note_memory(MPI_Comm communicator, Progress& progress);

/// Timings and memory of the whole run; `particles` are this rank's. Collective.
Timings final_timings(const Clock& clock, const PhaseTable& phases, const WorkMeter& work,
                      std::int64_t particles, const Progress& progress, MPI_Comm communicator);

/// Table of phases: least, mean and largest seconds over the ranks, share of the whole.
std::string timings_table(const Timings& timings);

}  // namespace poreshock
