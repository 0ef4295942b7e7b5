#pragma once
// timings.json: where the time of a run went, and what it was warned of at its start.

#include <mpi.h>

#include <cstdint>
#include <string>
#include <vector>

#include "poreshock/core/phase.hpp"

namespace poreshock {

/// Time of one phase over the ranks, s.
struct PhaseTiming {
  std::string name;
  double min = 0.0;
  double avg = 0.0;
  double max = 0.0;
  std::int64_t calls = 0;  ///< most of any rank
};

struct Timings {
  int ranks = 1;
  double wall_seconds = 0.0;
  std::int64_t steps = 0;
  std::int64_t particle_steps = 0;
  std::int64_t sleeping_steps = 0;  ///< those of them whose particle only moved
  std::int64_t cuts = 0;            ///< times the slabs were cut anew
  double bytes_per_particle = 0.0;  ///< peak memory beyond that at the start, sum of all ranks
  double bytes_at_once = 0.0;  ///< the most of all ranks at one time, without code of libraries
  double rate_per_core = 0.0;  ///< particle steps per second and rank
  std::vector<PhaseTiming> phases;
  std::vector<std::string> warnings;  ///< of the scene and its sample; none of a restarted run
};

/// Least, mean and largest time of every phase that was called on any rank. Collective.
std::vector<PhaseTiming> gather_phases(const PhaseTable& table, MPI_Comm communicator);

/// Writes timings.json under a temporary name and renames it. Rank 0's timings count, and rank 0
/// works; SystemError on all ranks when it cannot write. Collective.
void write_timings(const std::string& path, const Timings& timings, MPI_Comm communicator);

}  // namespace poreshock
