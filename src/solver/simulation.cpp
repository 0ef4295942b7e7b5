#include "poreshock/solver/simulation.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/physics/boundary.hpp"
#include "poreshock/physics/momentum.hpp"
#include "poreshock/scene/read_scene.hpp"
#include "poreshock/solver/check_state.hpp"
#include "poreshock/solver/ownership.hpp"
#include "poreshock/solver/sleep.hpp"
#include "poreshock/transfer/average.hpp"
#include "poreshock/transfer/grid_to_particles.hpp"
#include "poreshock/transfer/particles_to_grid.hpp"
#include "poreshock/transfer/remap.hpp"
#include "poreshock/transfer/shape.hpp"
#include "poreshock/transfer/sweep.hpp"
#include "poreshock/transfer/velocity_filter.hpp"

namespace poreshock {

namespace {

/// Velocity of the background grid: it rides with walls, so that they stay on a line of nodes.
template <int Dim>
Vector<Dim> grid_velocity(const Scene& scene) {
  Vector<Dim> velocity = Vector<Dim>::Zero();
  for (int a = 0; a + 1 < Dim; ++a) {
    const SideKind kind = scene.boundary.lateral[a];
    if (kind == SideKind::wall || kind == SideKind::symmetry) velocity[a] = scene.loading.frame[a];
  }
  const Side& low = scene.boundary.low;
  const Side& high = scene.boundary.high;
  const Side& fixed = low.kind == SideKind::free ? high : low;
  if (fixed.kind != SideKind::free) {
    velocity[Dim - 1] = fixed.velocity + scene.loading.frame[Dim - 1];
  }
  return velocity;
}

template <int Dim>
Simulation<Dim> prepare(const Scene& scene, MPI_Comm communicator) {
  Simulation<Dim> sim;
  make_grid_shape(scene);  // refuses a grid that PETSc cannot count, before anything is made
  sim.scene = scene;
  sim.scene_text = write_scene(scene);
  sim.communicator = communicator;
  for (const MaterialParameters& parameters : scene.materials) {
    sim.materials.push_back(make_material(parameters));
    if (parameters.kinematic_share > 0.0) sim.particles.options.back_stress = true;
  }
  sim.particles.options.affine = scene.transfer.velocity == VelocityTransfer::apic;
  sim.stress_settings.thermal = scene.thermal;
  sim.stress_settings.viscosity = scene.viscosity;
  sim.stress_settings.averaging = scene.transfer.averaging > 0.0;
  sim.stress_settings.cell = scene.domain.cell;
  sim.stress_settings.cfl = scene.time.cfl;
  sim.stress_settings.grid_velocity = grid_velocity<Dim>(scene);
  for (int a = 0; a < Dim; ++a) sim.body_force[a] = scene.body_force[a];
  sim.particles.options.failed = can_fail(scene);
  const bool conducts = conducts_heat(scene);
  sim.particles.options.conducted_heat = conducts && scene.thermal == Thermal::paper;
  sim.conduction_limit =
      conducts ? conduction_limit(sim.materials, scene.transfer.shape, Dim, scene.domain.cell)
               : std::numeric_limits<double>::infinity();
  sim.phases = make_phase_table();
  return sim;
}

/// Number of integers that run_state() puts into a checkpoint.
template <int Dim>
std::size_t run_state_integers(const Simulation<Dim>& sim) {
  return 5 + save(sim.ledger, MPI_COMM_SELF).size();
}

template <int Dim>
void take_report(const StressReport& report, Simulation<Dim>& sim) {
  sim.clock.limit = std::min(report.dt_limit, sim.conduction_limit);
  sim.clock.bad = report.bad;
  sim.ledger.guards.compression += report.compression_guard;
  sim.ledger.guards.sound_speed += report.sound_speed_guard;
  sim.ledger.viscous_heat += report.viscous_heat;
}

/// Calls visit(rows) for chunks of the rows that are awake, so small that what the stress update
/// takes from the grid stays in the cache. MUSL needs all particles moved before their stress
/// follows.
template <class Visit>
void for_each_chunk(const Transfer& transfer, const CellOrder& cells, const SlabGrid& grid,
                    Visit&& visit) {
  constexpr std::uint32_t chunk = 1024;  // particles
  const RowRange awake = awake_rows(cells, grid);
  // Collective there, so also where nothing is awake.
  if (transfer.update == VelocityUpdate::musl) return visit(awake);
  const auto place = [&](int row) { return first_place(cells, grid, row); };
  for (RowRange rows = {awake.first, awake.first}; rows.first < awake.last;
       rows.first = rows.last) {
    do {
      ++rows.last;
    } while (rows.last < awake.last && place(rows.last) - place(rows.first) < chunk);
    visit(rows);
  }
}

/// MUSL: the velocity that the updated particles give the nodes, under the same walls. Its impulses
/// move nothing and belong to no ledger.
template <int Dim>
void update_from_particles(double dt, Simulation<Dim>& sim) {
  SlabGrid& grid = *sim.grid;
  const Vector<Dim>& grid_velocity = sim.stress_settings.grid_velocity;
  remap_velocity(sim.particles, sim.cells, sim.scene.transfer, grid);
  grid.exchange();
  NodeLedger scratch;
  integrate_momentum<Dim>(Vector<Dim>::Zero(), false, 0.0, grid, scratch);
  apply_boundaries<Dim>(sim.scene.boundary, grid_velocity, grid, scratch);
  grid.fill_periodic_images();
  gather_remapped(grid, sim.cells, sim.scene.transfer, grid_velocity, dt, sim.particles,
                  sim.step_data);
}

/// Nodes to particles and stress of the particles of some rows in one velocity field.
template <int Dim>
void update_particles(const CellOrder& cells, RowRange rows, const SlabGrid& grid,
                      const SlabGrid* averages, double dt, Simulation<Dim>& sim,
                      StressReport& report) {
  const Transfer& transfer = sim.scene.transfer;
  {
    const Phase phase(sim.phases, PhaseName::grid_to_particles);
    grid_to_particles(grid, averages, cells, rows, transfer, sim.stress_settings.grid_velocity, dt,
                      sim.ledger.nodes.inverse_energy_quantum, sim.particles, sim.step_data,
                      sim.ledger.transfer_heat);
  }
  if (transfer.update == VelocityUpdate::musl) {
    const Phase phase(sim.phases, PhaseName::remap);
    update_from_particles(dt, sim);
  }
  const Phase phase(sim.phases, PhaseName::stress);
  const std::uint32_t first = first_place(cells, grid, rows.first);
  const std::span places(cells.order.data() + first, first_place(cells, grid, rows.last) - first);
  update_stress<Dim>(sim.materials, sim.stress_settings, sim.step_data, dt, places, sim.particles,
                     report);
}

/// Momentum, contact and boundaries on the nodes of all velocity fields.
template <int Dim>
void update_grids(double dt, Simulation<Dim>& sim) {
  NodeLedger& ledger = sim.ledger.nodes;
  const Transfer& transfer = sim.scene.transfer;
  {
    const Phase phase(sim.phases, PhaseName::grid_update);
    for_each_field(sim, [&](const CellOrder&, SlabGrid& grid, SlabGrid*) {
      integrate_momentum<Dim>(sim.body_force, projects(transfer.velocity), dt, grid, ledger);
    });
  }
  {
    const Phase phase(sim.phases, PhaseName::contact);
    collide(dt, sim);
  }
  const Phase phase(sim.phases, PhaseName::grid_update);
  for_each_field(sim, [&](const CellOrder&, SlabGrid& grid, SlabGrid*) {
    apply_boundaries<Dim>(sim.scene.boundary, sim.stress_settings.grid_velocity, grid, ledger);
    if (sim.body_force.squaredNorm() > 0.0) add_body_work<Dim>(sim.body_force, dt, grid, ledger);
  });
  finish_contact(sim);
  for_each_field(sim, [&](const CellOrder&, SlabGrid& grid, SlabGrid*) {
    prepare_gather<Dim>(transfer, damped_share(transfer, dt), grid);
  });
}

}  // namespace

template <int Dim>
Simulation<Dim> start(const Scene& scene, MPI_Comm communicator) {
  Simulation<Dim> sim = prepare<Dim>(scene, communicator);
  const std::int64_t layers = lattice_layers(scene);
  const std::int64_t me = rank(communicator), ranks = size(communicator);
  SampleReport report;
  fill<Dim>(scene, {layers * me / ranks, layers * (me + 1) / ranks}, sim.particles, report);
  sim.sample = total(report, communicator);
  find_grains(sim);
  rebalance(0.0, sim);
  release_spare(sim.particles);
  sim.ledger = make_ledger<Dim>(scene, sim.materials, sim.particles, communicator);
  sim.stress_settings.inverse_energy_quantum = sim.ledger.nodes.inverse_energy_quantum;
  StressReport stress;
  initialise_stress<Dim>(sim.materials, sim.stress_settings, sim.particles, stress);
  take_report(stress, sim);
  sim.clock.disturbed = disturbed_rows(sim);
  agree_on_step(false, sim.clock, communicator);
  return sim;
}

template <int Dim>
Simulation<Dim> resume(const Scene& scene, const std::string& path, MPI_Comm communicator) {
  Simulation<Dim> sim = prepare<Dim>(scene, communicator);
  std::string stored_scene;
  RunState state;
  const ParticleOptions expected = sim.particles.options;
  read_checkpoint<Dim>(path, communicator, stored_scene, state, sim.particles);
  require_sound_state(path, scene, expected, state, sim.particles, communicator);
  if (state.integers.size() != run_state_integers(sim)) {
    throw InputError(path + ": written by another version of this program, its ledger has " +
                     std::to_string(state.integers.size()) + " numbers instead of " +
                     std::to_string(run_state_integers(sim)) + "; restart with that version");
  }
  sim.clock.step = state.step;
  sim.clock.time = state.time;
  sim.clock.allowed = state.last_dt;
  sim.clock.beat = state.beat;
  sim.clock.limit = std::bit_cast<double>(state.integers.at(0));
  sim.clock.first_limit = std::bit_cast<double>(state.integers.at(1));
  set_quanta(std::bit_cast<double>(state.integers.at(2)),
             std::bit_cast<double>(state.integers.at(3)), sim.ledger);
  sim.ledger.row_time = std::bit_cast<double>(state.integers.at(4));
  restore({state.integers.begin() + 5, state.integers.end()}, rank(communicator) == 0, sim.ledger);
  sim.stress_settings.inverse_energy_quantum = sim.ledger.nodes.inverse_energy_quantum;
  find_grains(sim);
  rebalance(0.0, sim);
  sim.clock.disturbed = disturbed_rows(sim);
  agree_on_step(false, sim.clock, communicator);
  return sim;
}

template <int Dim>
RunState run_state(const Simulation<Dim>& sim) {
  RunState state;
  state.step = sim.clock.step;
  state.time = sim.clock.time;
  state.last_dt = sim.clock.allowed;
  state.beat = sim.clock.beat;
  state.record = sim.clock.beat + 1;
  // Before agree_on_step every rank knows only its own particles' limit; the next step needs all.
  double limit = sim.clock.limit;
  check_mpi(MPI_Allreduce(MPI_IN_PLACE, &limit, 1, MPI_DOUBLE, MPI_MIN, sim.communicator),
            "MPI_Allreduce of the time step");
  for (const double x : {limit, sim.clock.first_limit, sim.ledger.energy_quantum,
                         sim.ledger.momentum_quantum, sim.ledger.row_time}) {
    state.integers.push_back(std::bit_cast<std::int64_t>(x));
  }
  const std::vector<std::int64_t> ledger = save(sim.ledger, sim.communicator);
  state.integers.insert(state.integers.end(), ledger.begin(), ledger.end());
  return state;
}

template <int Dim>
void advance(Simulation<Dim>& sim, double dt) {
  const Transfer& transfer = sim.scene.transfer;
  const bool averaging = transfer.averaging > 0.0;
  sort_particles(sim);
  sim.cells.awake = awake_around(sim.clock.disturbed, sim.grid->shape());
  split_by_colour(sim);
  if (transfer.velocity == VelocityTransfer::fmpm) {
    const Phase phase(sim.phases, PhaseName::filter);
    for_each_field(sim, [&](const CellOrder& cells, SlabGrid& grid, SlabGrid*) {
      filter_velocity(cells, transfer, sim.ledger.nodes.inverse_energy_quantum, grid, sim.particles,
                      sim.step_data, sim.ledger.transfer_heat);
    });
  }
  if (sim.heat) {
    // At the start of the step density, energy and position belong together and the sort holds; the
    // stress update at its end then sees the heat in the energy that pressure follows from.
    const Phase phase(sim.phases, PhaseName::conduction);
    conduct_heat(sim.materials, sim.scene.thermal, transfer.shape, sim.cells, dt,
                 sim.ledger.nodes.inverse_energy_quantum, *sim.heat, sim.heat_flow, sim.particles,
                 sim.ledger.conduction);
  }
  for_each_field(sim, [&](const CellOrder& cells, SlabGrid& grid, SlabGrid* averages) {
    if (averaging) {
      const Phase phase(sim.phases, PhaseName::average);
      average_pressure(sim.particles, cells, transfer, *averages);
    }
    {
      const Phase phase(sim.phases, PhaseName::particles_to_grid);
      particles_to_grid(sim.particles, cells, transfer, averages, grid);
    }
    const Phase phase(sim.phases, PhaseName::exchange);
    grid.exchange();
  });
  update_grids(dt, sim);
  StressReport report;
  for_each_field(sim, [&](const CellOrder& cells, SlabGrid& grid, SlabGrid* averages) {
    if (averaging) {
      const Phase phase(sim.phases, PhaseName::average);
      average_dilatation(sim.particles, cells, transfer, grid, *averages);
    }
    for_each_chunk(transfer, cells, grid, [&](RowRange rows) {
      update_particles(cells, rows, grid, averages, dt, sim, report);
    });
  });
  move_sleeping(dt, sim);
  // Those asleep are still in the state that the first limit comes from.
  if (sleeping_particles(sim) > 0)
    report.dt_limit = std::min(report.dt_limit, sim.clock.first_limit);
  take_report(report, sim);
  sim.clock.disturbed = disturbed_rows(sim);
}

template Simulation<2> start<2>(const Scene&, MPI_Comm);
template Simulation<3> start<3>(const Scene&, MPI_Comm);
template Simulation<2> resume<2>(const Scene&, const std::string&, MPI_Comm);
template Simulation<3> resume<3>(const Scene&, const std::string&, MPI_Comm);
template RunState run_state<2>(const Simulation<2>&);
template RunState run_state<3>(const Simulation<3>&);
template void advance<2>(Simulation<2>&, double);
template void advance<3>(Simulation<3>&, double);

}  // namespace poreshock
