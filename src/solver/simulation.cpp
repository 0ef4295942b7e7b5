#include "poreshock/solver/simulation.hpp"

#include <algorithm>
#include <span>

#include "poreshock/physics/boundary.hpp"
#include "poreshock/physics/momentum.hpp"
#include "poreshock/physics/transmit.hpp"
#include "poreshock/solver/ownership.hpp"
#include "poreshock/solver/sleep.hpp"
#include "poreshock/transfer/facing.hpp"
#include "poreshock/transfer/grid_to_particles.hpp"
#include "poreshock/transfer/particles_to_grid.hpp"
#include "poreshock/transfer/sweep.hpp"
#include "stress_report.hpp"

namespace poreshock {

namespace {

/// Calls visit(rows, places) for chunks of the rows that are awake, so small that what the stress
/// update takes from the grid stays in the cache; places are those of their particles.
template <class Visit>
void for_each_chunk(const CellOrder& cells, const SlabGrid& grid, Visit&& visit) {
  constexpr std::uint32_t chunk = 1024;  // particles
  const RowRange awake = awake_rows(cells, grid);
  const auto place = [&](int row) { return first_place(cells, grid, row); };
  for (RowRange rows = {awake.first, awake.first}; rows.first < awake.last;
       rows.first = rows.last) {
    do {
      ++rows.last;
    } while (rows.last < awake.last && place(rows.last) - place(rows.first) < chunk);
    const std::uint32_t first = place(rows.first);
    visit(rows, std::span(cells.order.data() + first, place(rows.last) - first));
  }
}

/// Stiffness of a particle alone in its cell, per axis and squared cell: its gradient sees S, the
/// most that slope^2/weight add up to, and its affine part, which remembers the motion, moves by
/// 1/D at once, so that 4/dt^2 is 2 S - 1/D. Without affine modes nothing remembers, and time.cfl
/// bounds the step alone.
double lone_stiffness(const Transfer& transfer) {
  if (scheme_of(transfer.velocity).modes == Modes::constant) return 0.0;
  return of_shape(transfer.shape, []<class Shape>(const Shape&) {
    if constexpr (has_inertia<Shape>) return 2.0 * Shape::stiffness - Shape::inverse_inertia;
    return 0.0;
  });
}

template <int Dim>
ParticleMotion<Dim> particle_motion(double dt, const Simulation<Dim>& sim) {
  return {dt,
          lost_share(sim.scene.transfer, sim.sound_speed, sim.scene.domain.cell, dt),
          grid_velocity<Dim>(sim.grid->shape()),
          sim.scene.viscosity.limited,
          sim.ledger.nodes.inverse_energy_quantum,
          1e-16 * sim.sound_speed * sim.sound_speed,
          sim.grid->fields() > 1 ? squeezed_share(sim.sound_speed, sim.scene.domain.cell, dt) : 0.0,
          sim.sound_speed * sim.sound_speed};
}

/// Sorts particles, and gives the grid the nodes that those awake reach, in fields for grains.
template <int Dim>
void sort_awake(Simulation<Dim>& sim) {
  CellOrder& cells = sim.cells;
  SlabGrid& grid = *sim.grid;
  cells.awake = awake_around(sim.clock.disturbed, grid.shape());
  // Colours of grains come from the cells of all.
  cells.may_rest = !has_contact(sim);
  timed(sim.phases, PhaseName::sort,
        [&] { sort_particles(sim.clock.step, grid, sim.particles, cells); });
  split_by_colour(sim);
  if (grid.fields() == 1) grid.take_rows(cells.awake.first, cells.awake.last);
}

template <int Dim>
void conduct(double dt, Simulation<Dim>& sim) {
  const HeatSettings settings = {sim.scene.thermal, sim.scene.transfer.shape, dt,
                                 sim.ledger.nodes.inverse_energy_quantum};
  conduct_heat(sim.materials, settings, sim.cells, *sim.heat, sim.heat_flow, sim.particles,
               sim.ledger.conduction);
}

/// What clock, ledger and meter take from a step, and where waves have come.
template <int Dim>
void close_step(double dt, StepReport report, Simulation<Dim>& sim) {
  move_layers(dt, sim);
  const std::int64_t asleep = sleeping_particles(sim.cells, *sim.grid);
  const double still = sleeping_weight(sim) * static_cast<double>(asleep);
  const std::int64_t all = std::ssize(sim.particles.id);
  count_work(all, static_cast<double>(all - asleep) + still, std::ssize(sim.grain_fields.shared),
             sim.work);
  // Those asleep are still in the state that the first limit comes from.
  if (asleep > 0) report.stress.dt_limit = std::min(report.stress.dt_limit, sim.clock.first_limit);
  take_report(report, sim.conduction_limit, sim.clock, sim.ledger);
  sim.clock.disturbed = disturbed_rows(sim.scene, sim.materials, sim.grid->shape(), sim.particles,
                                       resting_particles(sim.cells));
}

}  // namespace

template <int Dim>
StressSettings<Dim> stress_settings(const Simulation<Dim>& sim) {
  const Scene& scene = sim.scene;
  return {scene.thermal,
          scene.viscosity,
          scene.domain.cell,
          scene.time.cfl,
          lone_stiffness(scene.transfer),
          grid_velocity<Dim>(sim.grid->shape()),
          sim.ledger.nodes.inverse_energy_quantum};
}

template <int Dim>
void advance(Simulation<Dim>& sim, double dt) {
  const Transfer& transfer = sim.scene.transfer;
  const StressSettings<Dim> settings = stress_settings(sim);
  Particles<Dim>& particles = sim.particles;
  NodeLedger& ledger = sim.ledger.nodes;
  SlabGrid& grid = *sim.grid;
  const auto in = [&](PhaseName name, auto&& run) { timed(sim.phases, name, run); };

  sort_awake(sim);
  const ParticleMotion<Dim> motion = particle_motion(dt, sim);
  // Now density, energy and position belong together and the sort holds; the stress update at the
  // end sees the heat in the energy that pressure follows from.
  if (sim.heat) in(PhaseName::conduction, [&] { conduct(dt, sim); });
  in(PhaseName::particles_to_grid,
     [&] { particles_to_grid(particles, sim.cells, transfer, grid); });
  in(PhaseName::exchange, [&] { grid.exchange(); });
  if (sim.ends.forces) sum_ends(transfer, particles, sim.cells, sim.ends);
  const auto momentum = [&] { integrate_momentum<Dim>(sim.body_force, dt, grid); };
  const auto boundaries = [&] {
    if (sim.ends.forces) push_ends<Dim>(*sim.ends.forces, dt, grid, ledger);
    apply_boundaries<Dim>(sim.scene.boundary, motion.grid_velocity, grid, ledger);
    add_body_work<Dim>(sim.body_force, dt, grid, ledger);
  };
  move_nodes<Dim>(dt, momentum, boundaries, sim);
  StepReport report;
  in(PhaseName::grid_update, [&] { prepare_gather<Dim>(motion.lost, grid); });
  for_each_chunk(sim.cells, grid, [&](RowRange rows, const auto& places) {
    in(PhaseName::grid_to_particles, [&] {
      report.transfer +=
          grid_to_particles(grid, sim.cells, rows, transfer, motion, particles, sim.step_data);
    });
    in(PhaseName::stress, [&] {
      update_stress<Dim>(sim.materials, settings, sim.step_data, dt, places, particles,
                         report.stress);
      if (particles.options.facing) turn_facing<Dim>(sim.step_data.gradient, dt, places, particles);
    });
  });
  move_sleeping(dt, sim.cells, grid, particles);
  close_step(dt, report, sim);
}

template StressSettings<2> stress_settings<2>(const Simulation<2>&);
template StressSettings<3> stress_settings<3>(const Simulation<3>&);
template void advance<2>(Simulation<2>&, double);
template void advance<3>(Simulation<3>&, double);

}  // namespace poreshock
