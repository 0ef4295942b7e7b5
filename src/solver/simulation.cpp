#include "poreshock/solver/simulation.hpp"

#include <algorithm>

#include "end_surfaces.hpp"
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

/// Calls visit(rows) for chunks of the rows that are awake, so small that what the stress update
/// takes from the grid stays in the cache.
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
    visit(rows);
  }
}

template <int Dim>
ParticleMotion<Dim> particle_motion(double dt, const Simulation<Dim>& sim) {
  return {dt,
          lost_share(sim.scene.transfer, sim.sound_speed, sim.scene.domain.cell, dt),
          sim.stress_settings.grid_velocity,
          sim.scene.viscosity.limited,
          sim.ledger.nodes.inverse_energy_quantum,
          1e-16 * sim.sound_speed * sim.sound_speed};
}

/// Nodes to particles and stress of the particles of some rows in one velocity field.
template <int Dim>
void update_particles(const CellOrder& cells, RowRange rows, const SlabGrid& grid, double dt,
                      Simulation<Dim>& sim, StepReport& report) {
  {
    const Phase phase(sim.phases, PhaseName::grid_to_particles);
    grid_to_particles(grid, cells, rows, sim.scene.transfer, particle_motion(dt, sim),
                      sim.particles, sim.step_data, report.transfer);
  }
  const Phase phase(sim.phases, PhaseName::stress);
  const std::uint32_t first = first_place(cells, grid, rows.first);
  const std::span places(cells.order.data() + first, first_place(cells, grid, rows.last) - first);
  update_stress<Dim>(sim.materials, sim.stress_settings, sim.step_data, dt, places, sim.particles,
                     report.stress);
  if (sim.particles.options.facing) {
    turn_facing<Dim>(sim.step_data.gradient, dt, places, sim.particles);
  }
}

/// Particles of all fields to their nodes.
template <int Dim>
void sum_particles(Simulation<Dim>& sim) {
  for_each_field(sim, [&](const CellOrder& cells, SlabGrid& grid) {
    {
      const Phase phase(sim.phases, PhaseName::particles_to_grid);
      particles_to_grid(sim.particles, cells, sim.scene.transfer, grid);
    }
    const Phase phase(sim.phases, PhaseName::exchange);
    grid.exchange();
  });
}

/// Momentum, contact and boundaries on the nodes of all velocity fields.
template <int Dim>
void update_grids(double dt, Simulation<Dim>& sim) {
  NodeLedger& ledger = sim.ledger.nodes;
  {
    const Phase phase(sim.phases, PhaseName::grid_update);
    join_fields(sim);
    for_each_side(sim, [&](const CellOrder&, SlabGrid& grid) {
      integrate_momentum<Dim>(sim.body_force, dt, grid);
    });
  }
  {
    const Phase phase(sim.phases, PhaseName::contact);
    collide(dt, sim);
  }
  const Phase phase(sim.phases, PhaseName::grid_update);
  if (sim.ends) push_ends<Dim>(*sim.ends, dt, *sim.grid, sim.ledger.nodes);
  for_each_side(sim, [&](const CellOrder&, SlabGrid& grid) {
    apply_boundaries<Dim>(sim.scene.boundary, sim.stress_settings.grid_velocity, grid, ledger);
    if (sim.body_force.squaredNorm() > 0.0) add_body_work<Dim>(sim.body_force, dt, grid, ledger);
  });
  finish_contact(sim);
  spread_fields(sim);
  for_each_field(sim, [&](const CellOrder&, SlabGrid& grid) {
    prepare_gather<Dim>(particle_motion(dt, sim).lost, grid);
  });
}

}  // namespace

template <int Dim>
void advance(Simulation<Dim>& sim, double dt) {
  const Transfer& transfer = sim.scene.transfer;
  sort_particles(sim);
  sim.cells.awake = awake_around(sim.clock.disturbed, sim.grid->shape());
  split_by_colour(sim);
  if (sim.heat) {
    // At the start of the step density, energy and position belong together and the sort holds; the
    // stress update at its end then sees the heat in the energy that pressure follows from.
    const Phase phase(sim.phases, PhaseName::conduction);
    conduct_heat(sim.materials, sim.scene.thermal, transfer.shape, sim.cells, dt,
                 sim.ledger.nodes.inverse_energy_quantum, *sim.heat, sim.heat_flow, sim.particles,
                 sim.ledger.conduction);
  }
  sum_particles(sim);
  if (sim.ends) sum_ends(sim);
  update_grids(dt, sim);
  StepReport report;
  for_each_field(sim, [&](const CellOrder& cells, SlabGrid& grid) {
    for_each_chunk(cells, grid,
                   [&](RowRange rows) { update_particles(cells, rows, grid, dt, sim, report); });
  });
  move_sleeping(dt, sim);
  count_work(sim);
  // Those asleep are still in the state that the first limit comes from.
  if (sleeping_particles(sim) > 0)
    report.stress.dt_limit = std::min(report.stress.dt_limit, sim.clock.first_limit);
  take_report(report, sim);
  sim.clock.disturbed = disturbed_rows(sim);
}

template void advance<2>(Simulation<2>&, double);
template void advance<3>(Simulation<3>&, double);

}  // namespace poreshock
