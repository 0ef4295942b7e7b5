#pragma once
// How a run in memory begins: from a scene, or from what an earlier one left.

#include "poreshock/output/checkpoint.hpp"
#include "poreshock/solver/simulation.hpp"

namespace poreshock {

/// Makes the sample and distributes it over the ranks. Throws InputError. Collective.
template <int Dim>
Simulation<Dim> start(const Scene& scene, MPI_Comm communicator);

/// Continues from a checkpoint file under `scene` (the checkpoint's own, but for output settings).
/// Throws InputError. Collective.
template <int Dim>
Simulation<Dim> resume(const Scene& scene, const std::string& path, MPI_Comm communicator);

/// State of the run besides its particles, for a checkpoint. Collective.
template <int Dim>
RunState run_state(const Simulation<Dim>& sim);

}  // namespace poreshock
