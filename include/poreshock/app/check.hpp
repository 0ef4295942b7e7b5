#pragma once
// What a scene means before it runs.

#include <mpi.h>

#include <string>

#include "poreshock/scene/scene.hpp"

namespace poreshock {

/// Prints the resolved scene, the numbers that follow from it (cells per void, particles, time
/// step, steps, memory, disk, time to go) and warnings. Makes the sample, runs nothing. Throws
/// InputError. Collective.
void check_scene(const Scene& scene, MPI_Comm communicator);

/// Makes the sample, prints what was achieved, prepares the folder (`force` replaces our files in
/// an existing one) and writes the sample into it as snapshot_000000.h5. Throws InputError.
/// Collective.
void write_sample(const Scene& scene, const std::string& folder, bool force, MPI_Comm communicator);

}  // namespace poreshock
