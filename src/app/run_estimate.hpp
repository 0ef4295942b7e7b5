#pragma once
// What a run will need, estimated from its scene, and what of that deserves a warning.

#include <mpi.h>

#include <string>
#include <vector>

#include "poreshock/solver/simulation.hpp"

namespace poreshock {

/// Estimated before the run.
struct RunEstimate {
  double mechanical_step = 0.0;   ///< s, typical step of the motion
  double conduction_step = 0.0;   ///< s, largest stable one of heat conduction
  double free_steps = 0.0;        ///< that these two ask for
  double steps = 0.0;             ///< with those that the beat adds
  double particle_bytes = 0.0;    ///< memory of one particle
  double memory = 0.0;            ///< bytes, of all ranks
  double snapshots = 0.0;         ///< how many
  double snapshot_bytes = 0.0;    ///< of one
  double checkpoint_bytes = 0.0;  ///< of one
  double disk = 0.0;              ///< bytes, snapshots and the checkpoints that lie side by side
  double seconds = 0.0;
};

/// What there is.
struct Resources {
  double memory = 0.0;  ///< bytes, of the machines the ranks are on together
  double disk = 0.0;    ///< bytes free where the program was called
  int ranks = 1;
};

/// Rate the time is estimated with, particle-steps per second and core.
double assumed_rate(int dimension);

/// Distance heat gets until the end, m: sqrt(4 a t).
double diffusion_length(const Scene& scene, const MaterialParameters& material);

/// Throws InputError when the sample alone, as its height and porosity tell, would not fit into the
/// memory. Not collective.
void require_memory(const Scene& scene, const Resources& resources);

/// Estimate for the started run. Collective.
template <int Dim>
RunEstimate estimate_run(const Simulation<Dim>& sim);

/// Memory and disk of this run's machines. Collective.
Resources find_resources(MPI_Comm communicator);

/// Plain sentences about heat conduction, memory, disk and time; each names the keys to change. Not
/// collective.
std::vector<std::string> run_warnings(const Scene& scene, const RunEstimate& estimate,
                                      const Resources& resources);

}  // namespace poreshock
