#pragma once
// Which rank owns which particle, and in which order kernels see them.

#include "poreshock/solver/simulation.hpp"

namespace poreshock {

/// Sorts the particles of this rank into canonical order by an index; every 20 steps the storage
/// follows. Not collective.
template <int Dim>
void sort_particles(std::int64_t step, const SlabGrid& grid, Particles<Dim>& particles,
                    CellOrder& cells);

/// After a step: wraps periodic sides, puts particles back that crossed a wall (counted), books and
/// removes those that left through an open side, and hands over those whose row belongs to a
/// neighbour. Collective (neighbours).
template <int Dim>
void migrate(Simulation<Dim>& sim);

/// At the start: cuts the rows into slabs by their particles, makes the grids, and moves the
/// particles to their ranks, from anywhere. Collective.
template <int Dim>
void distribute(Simulation<Dim>& sim);

/// Measures what the work of the last steps cost, and cuts the slabs anew where the predicted gain
/// exceeds what it costs. Collective.
template <int Dim>
void rebalance(Simulation<Dim>& sim);

}  // namespace poreshock
