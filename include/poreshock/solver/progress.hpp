#pragma once
// The progress rows of a run and the table at its end.

#include <mpi.h>

#include <cstdint>
#include <string>

#include "poreshock/core/phase.hpp"
#include "poreshock/output/timings.hpp"
#include "poreshock/solver/time_step.hpp"

namespace poreshock {

/// What the next progress row is computed from.
struct Progress {
  double start_wall = 0.0;              ///< s, MPI_Wtime at the start of the run
  std::int64_t start_memory = 0;        ///< bytes, peak_memory at the start of the run
  double row_wall = 0.0;                ///< s, at the last row
  std::int64_t particle_steps = 0;      ///< of this rank since the start
  std::int64_t sleeping_steps = 0;      ///< those of them in rows asleep
  std::int64_t row_particle_steps = 0;  ///< at the last row
  std::int64_t first_step = 0;
  double row_communication = 0.0;       ///< s, at the last row
  double row_compute = 0.0;             ///< s, at the last row
  double row_time = 0.0;                ///< s of simulated time, at the last row
  std::int64_t row_step = 0;            ///< at the last row
  std::int64_t row_sleeping_steps = 0;  ///< at the last row
  double cost = 0.0;        ///< s of wall time per work and simulated time, of the last rows
  double first_work = 0.0;  ///< work of a step in the first row, in awake particles of all ranks
  double first_work_time = -1.0;  ///< s of simulated time, in the middle of it; < 0 = none yet
};

/// What the time to go is estimated from. The work of a step is counted in awake particles; asleep
/// ones count little.
struct WorkGrowth {
  double work = 0.0;   ///< of a step now
  double slope = 0.0;  ///< 1/s, its growth over simulated time
  double most = 0.0;   ///< of a step where all are awake
};

/// Integral of the work over `span` (s) of simulated time from now on: it grows evenly until all
/// are awake.
double work_ahead(const WorkGrowth& growth, double span);

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

/// Timings and memory of the whole run; `particles` are this rank's. Collective.
Timings final_timings(const Clock& clock, const PhaseTable& phases, std::int64_t particles,
                      const Progress& progress, MPI_Comm communicator);

/// Table of phases: least, mean and largest seconds over the ranks, share of the whole.
std::string timings_table(const Timings& timings);

}  // namespace poreshock
