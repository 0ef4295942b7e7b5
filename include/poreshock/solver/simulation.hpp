#pragma once
// A run in memory, and its step.

#include <memory>
#include <string>
#include <vector>

#include "poreshock/core/phase.hpp"
#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/particles/cell_order.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/physics/heat.hpp"
#include "poreshock/physics/stress.hpp"
#include "poreshock/sample/fill.hpp"
#include "poreshock/solver/end_surfaces.hpp"
#include "poreshock/solver/grain_fields.hpp"
#include "poreshock/solver/ledger.hpp"
#include "poreshock/solver/row_cost.hpp"
#include "poreshock/solver/time_step.hpp"
#include "poreshock/solver/window.hpp"
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
  EndSurfaces ends;
  double conduction_limit = 0.0;  ///< s, infinite without heat conduction
  PhaseTable phases;
  WorkMeter work;
  SampleReport sample;
  Window window;
};

/// Settings of the stress update of a step.
template <int Dim>
StressSettings<Dim> stress_settings(const Simulation<Dim>& sim);

/// Advances the state by dt: heat conduction, particles to grid, momentum, boundaries, grid to
/// particles, stress. Afterwards the clock holds the stable next step of this rank's particles.
/// Collective.
template <int Dim>
void advance(Simulation<Dim>& sim, double dt);

/// Displacement of the grid origin since the start, m.
template <int Dim>
Vector<Dim> grid_shift(const Simulation<Dim>& sim) {
  return grid_velocity<Dim>(sim.grid->shape()) * sim.clock.time;
}

/// Low corner of the domain in the laboratory, m.
template <int Dim>
Vector<Dim> low_corner(const Simulation<Dim>& sim) {
  Vector<Dim> corner = grid_shift(sim);
  corner[Dim - 1] += sim.window.first * sim.scene.domain.cell;
  return corner;
}

}  // namespace poreshock
