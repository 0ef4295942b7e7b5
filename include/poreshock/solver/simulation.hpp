#pragma once
// A run in memory, and its step.

#include <memory>
#include <string>
#include <vector>

#include "poreshock/core/phase.hpp"
#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/output/checkpoint.hpp"
#include "poreshock/particles/cell_order.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/physics/heat.hpp"
#include "poreshock/physics/stress.hpp"
#include "poreshock/sample/fill.hpp"
#include "poreshock/solver/grain_fields.hpp"
#include "poreshock/solver/ledger.hpp"
#include "poreshock/solver/row_cost.hpp"
#include "poreshock/solver/time_step.hpp"
#include "poreshock/transfer/step_data.hpp"

namespace poreshock {

/// Everything a run needs between two steps. The grids are scratch: nothing on them survives a
/// step.
template <int Dim>
struct Simulation {
  Scene scene;
  std::string scene_text;  ///< resolved, as written to every file
  MPI_Comm communicator = MPI_COMM_NULL;
  std::vector<Material> materials;
  StressSettings<Dim> stress_settings;
  double sound_speed = 0.0;  ///< m/s, the largest of the materials at rest, longitudinal
  Vector<Dim> body_force = Vector<Dim>::Zero();
  Particles<Dim> particles;
  Clock clock;
  Ledger ledger;
  CellOrder cells;
  StepData<Dim> step_data;
  std::unique_ptr<SlabGrid> grid;
  GrainFields grain_fields;        ///< only used where grains of two colours exist
  std::unique_ptr<SlabGrid> heat;  ///< only with heat conduction
  HeatFlow<Dim> heat_flow;         ///< empty without heat conduction
  std::unique_ptr<SlabGrid> ends;  ///< only with material behind an end of the sample
  double conduction_limit = 0.0;   ///< s, infinite without heat conduction
  PhaseTable phases;
  WorkMeter work;
  SampleReport sample;
};

/// Makes the sample and distributes it over the ranks. Throws InputError. Collective.
template <int Dim>
Simulation<Dim> start(const Scene& scene, MPI_Comm communicator);

/// Continues from a checkpoint file under `scene` (the checkpoint's own, but for output settings).
/// Throws InputError. Collective.
template <int Dim>
Simulation<Dim> resume(const Scene& scene, const std::string& path, MPI_Comm communicator);

/// Advances the state by dt: heat conduction, particles to grid, momentum, boundaries, grid to
/// particles, stress. Afterwards the clock holds the stable next step of this rank's particles.
/// Collective.
template <int Dim>
void advance(Simulation<Dim>& sim, double dt);

/// State of the run besides its particles, for a checkpoint. Collective.
template <int Dim>
RunState run_state(const Simulation<Dim>& sim);

/// Displacement of the grid origin since the start, m.
template <int Dim>
Vector<Dim> grid_shift(const Simulation<Dim>& sim) {
  return grid_velocity<Dim>(sim.grid->shape()) * sim.clock.time;
}

}  // namespace poreshock
