#pragma once
// A whole run: the time loop with its records, checkpoints and progress rows.

#include <mpi.h>

#include <string>

#include "poreshock/scene/scene.hpp"

namespace poreshock {

/// Progress rows: none, one every two seconds, or one for every beat of the output.
enum class ProgressRows { none, timed, every_beat };

/// How a run is to be carried out; the scene says what is computed.
struct RunOptions {
  std::string folder;
  std::string restart;      ///< checkpoint file; empty = from the start
  bool continues = false;   ///< the checkpoint lies in `folder`, whose records go on
  bool force = false;       ///< replace our files in an existing folder
  double wall_limit = 0.0;  ///< s, 0 = none: checkpoint and stop after it
  ProgressRows rows = ProgressRows::timed;
  bool quiet = false;  ///< no table of timings at the end
};

enum class RunEnd { finished, stopped };

/// Runs the scene into an output folder, which is prepared once the sample or the checkpoint is in
/// memory. Prints on rank 0. Throws InputError, StateError (failed.h5 is written first) or
/// SystemError on all ranks. Collective.
template <int Dim>
RunEnd run(const Scene& scene, const RunOptions& options, MPI_Comm communicator);

}  // namespace poreshock
