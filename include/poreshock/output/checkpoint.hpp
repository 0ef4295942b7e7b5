#pragma once
// Checkpoints: the complete state of a run, exact to the bit, readable on any number of ranks.

#include <mpi.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "poreshock/particles/particles.hpp"

namespace poreshock {

/// State of a run besides its particles.
struct RunState {
  std::int64_t step = 0;
  double time = 0.0;                   ///< s
  double last_dt = 0.0;                ///< s
  std::int64_t beat = 0;               ///< index of the last beat landed on
  std::int64_t record = 0;             ///< number of the next record
  std::vector<std::int64_t> integers;  ///< accumulators, opaque here
  std::optional<double> first_total;   ///< J, energy at the start of the run; files older than it
                                       ///< do not tell

  bool operator==(const RunState&) const = default;
};

/// What a checkpoint says before its particles are read.
struct CheckpointHeader {
  int dimension = 0;
  std::int64_t step = 0;
  double time = 0.0;  ///< s
  std::int64_t particles = 0;
  std::string scene_text;
};

/// File name of a checkpoint in its folder: checkpoint_NNNNNNNNN.h5.
std::string checkpoint_name(std::int64_t step);

/// Writes all columns of all ranks, and the state (rank 0's counts), into one sealed file; an older
/// file of that name is replaced. SystemError on all ranks when the disk is full. Collective.
template <int Dim>
void write_checkpoint(const std::string& path, const std::string& scene_text, const RunState& state,
                      const Particles<Dim>& particles, MPI_Comm communicator);

/// Verifies a checkpoint and reads it: every rank gets an equal contiguous share of the rows of the
/// file, whatever slab they belong to, and particles.options as they were. InputError on all ranks
/// for a file that is foreign, damaged, truncated, newer, or of another dimension. Collective.
template <int Dim>
void read_checkpoint(const std::string& path, MPI_Comm communicator, std::string& scene_text,
                     RunState& state, Particles<Dim>& particles);

/// Header of a checkpoint, which is verified before. InputError as above. Collective.
CheckpointHeader checkpoint_header(const std::string& path, MPI_Comm communicator);

/// Newest checkpoint of a folder that passes verify(), older ones when newer ones do not. `note`
/// gets one line for each file passed over, and is empty when there was none. InputError when none
/// is good. Collective.
std::string latest_checkpoint(const std::string& folder, MPI_Comm communicator, std::string& note);

/// Removes the checkpoints of steps after `step`, which a run restarted there is about to compute
/// again. Rank 0 works. Collective.
void remove_checkpoints_after(const std::string& folder, std::int64_t step, MPI_Comm communicator);

/// Removes all but the newest `keep` checkpoints of a folder (at least one is kept). Rank 0 works.
/// Collective.
void prune_checkpoints(const std::string& folder, int keep, MPI_Comm communicator);

}  // namespace poreshock
