#pragma once
// Which rank owns which particle, and in which order kernels see them.

#include "poreshock/solver/simulation.hpp"

namespace poreshock {

/// Sorts the particles of this rank into canonical order by an index; every 20 steps the storage
/// follows. Not collective.
template <int Dim>
void sort_particles(Simulation<Dim>& sim);

/// After a step: wraps periodic sides, puts particles back that crossed a wall (counted), books and
/// removes those that left through an open side, and hands over those whose row belongs to a
/// neighbour. Collective (neighbours).
template <int Dim>
void migrate(Simulation<Dim>& sim);

/// Cuts the rows anew by their particles and moves the particles to their ranks, from anywhere.
/// With `least_gain` the cut stays unless the heaviest slab becomes lighter by that share.
/// Collective.
template <int Dim>
void rebalance(double least_gain, Simulation<Dim>& sim);

}  // namespace poreshock
