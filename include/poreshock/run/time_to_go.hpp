#pragma once
// How long a run still takes, from the rows of progress it has printed.

#include <cstdint>

namespace poreshock {

/// Where a run was when a row ended, and what it had taken since its start.
struct RunSoFar {
  double time = 0.0;  ///< s, simulated
  std::int64_t step = 0;
  double wall = 0.0;            ///< s
  double recorded = 0.0;        ///< s of the wall time that went into records
  double particle_steps = 0.0;  ///< of all ranks
  double sleeping_steps = 0.0;  ///< those of them in rows asleep
};

/// What the rows have told. `start` and `row` begin as the start of the run.
struct TimeToGo {
  RunSoFar start, row;       ///< the start, and the last row
  double cost = 0.0;         ///< s of wall time per work, of the last rows
  double first_work = 0.0;   ///< work of a step in the first row
  double first_time = -1.0;  ///< s, simulated, in the middle of it; < 0 = none yet
  double asleep = 0.0;       ///< work of a particle asleep, in that of one awake
};

/// How the work of a step grows, counted in awake particles; asleep ones count little.
struct WorkGrowth {
  double work = 0.0;   ///< of a step now
  double slope = 0.0;  ///< 1/s, its growth over simulated time
  double most = 0.0;   ///< of a step where all are awake
};

/// Integral of the work of a step over `span` (s) of simulated time from now on: it grows evenly
/// until all are awake.
double work_ahead(const WorkGrowth& growth, double span);

/// Seconds from the row that ends at `now` until the simulated time `end`; 0 before the first step.
/// A wave that wakes up row after row makes steps dearer: the first row and this one say how fast.
/// The length of a step jumps with each void that collapses: the mean over the run tells the number
/// of steps ahead. Records cost the same whatever is awake, so they are counted apart.
double seconds_to_go(const RunSoFar& now, double end, TimeToGo& estimate);

}  // namespace poreshock
