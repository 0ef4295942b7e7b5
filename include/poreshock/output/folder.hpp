#pragma once
// The output folder of a run.

#include <mpi.h>

#include <cstdint>
#include <memory>
#include <string>

#include "poreshock/output/folder_lock.hpp"

namespace poreshock {

/// Throws the InputError with which prepare_output_folder would refuse what exists at `path`, and
/// changes nothing: to be asked before long work. Rank 0 works. Collective.
void require_output_folder(const std::string& path, bool force, bool restart,
                           MPI_Comm communicator);

/// Makes an output folder and takes its lock, which proves that it can be written to; rank 0 holds
/// the lock for as long as it writes. An existing folder that is not empty is refused with
/// InputError, unless `force` (our own files in it are removed, others stay) or `restart` (nothing
/// is removed but unfinished files of a killed run); so is always one that another run holds, and
/// one with a scene.toml of the user's. Rank 0 works. Collective.
[[nodiscard]] std::unique_ptr<FolderLock> prepare_output_folder(const std::string& path, bool force,
                                                                bool restart,
                                                                MPI_Comm communicator);

/// Removes snapshots, morphology and profile files of record `first` and later, which a restarted
/// run is about to write again. Rank 0 works. Collective.
void remove_records_from(const std::string& folder, std::int64_t first, MPI_Comm communicator);

/// Forces the snapshots, morphology and profile files of record `first` and later to disk: what a
/// restart from a checkpoint written after them builds on. SystemError on all ranks when it fails.
/// Rank 0 works. Collective.
void sync_records(const std::string& folder, std::int64_t first, MPI_Comm communicator);

}  // namespace poreshock
