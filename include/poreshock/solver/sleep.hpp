#pragma once
// Sleep: rows of cells that no wave has reached are not computed, their particles only move.

#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/particles/cell_order.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/scene/scene.hpp"
#include "poreshock/solver/simulation.hpp"

namespace poreshock {

/// Cost of a particle that only moves, to that of one that is computed: more where it is sorted, as
/// colours of grains come from the cells of all.
template <int Dim>
double sleeping_weight(const Simulation<Dim>& sim) {
  return has_contact(sim) ? 0.07 : 0.01;
}

/// The rows of this rank that a wave has reached: those of particles whose velocity differs from
/// that of the loading by more than 1e-12 of the sound speed, and those next to walls and symmetry
/// planes. All rows where the scene cannot sleep. A function of scene and state alone; `first`
/// passes over particles that rest. Not collective.
template <int Dim>
RowRange disturbed_rows(const Scene& scene, const std::vector<Material>& materials,
                        const GridShape& shape, const Particles<Dim>& particles,
                        std::size_t first = 0);

/// The rows a step works on: those a wave has reached, and as many beyond as a step lets it go.
RowRange awake_around(RowRange disturbed, const GridShape& shape);

/// Particles of this rank that the last sort found in rows asleep. Not collective.
std::int64_t sleeping_particles(const CellOrder& cells, const SlabGrid& grid);

/// True when a storage order where rows asleep rest saves more than it costs.
bool rest_pays(const CellOrder& cells, const SlabGrid& grid);

/// Lets the highest rows of a slab rest that are asleep and move as one, straight down. Before:
/// none rests, particles sorted. Afterwards they are stored first, all others behind them in
/// canonical order. Not collective.
template <int Dim>
void let_rest(const SlabGrid& grid, Particles<Dim>& particles, CellOrder& cells);

/// Ends the rest of all rows that may hold a particle below the row `first`. Not collective.
template <int Dim>
void end_rest(int first, const GridShape& shape, const Particles<Dim>& particles, CellOrder& cells);

/// Moves the particles of all other rows over dt. Not collective.
template <int Dim>
void move_sleeping(double dt, const CellOrder& cells, const SlabGrid& grid,
                   Particles<Dim>& particles);

}  // namespace poreshock
