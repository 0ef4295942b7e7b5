#pragma once
// Sleep: rows of cells that no wave has reached are not computed, their particles only move.

#include "poreshock/solver/simulation.hpp"

namespace poreshock {

/// Cost of a particle that only moves, to that of one that is computed.
inline constexpr double sleeping_weight = 0.07;

/// The rows of this rank that a wave has reached: those of particles whose velocity differs from
/// that of the loading by more than 1e-12 of the sound speed, and those next to walls and symmetry
/// planes. All rows where the scene cannot sleep. A function of scene and state alone. Not
/// collective.
template <int Dim>
RowRange disturbed_rows(const Simulation<Dim>& sim);

/// The rows a step works on: those a wave has reached, and as many beyond as a step lets it go.
RowRange awake_around(RowRange disturbed, const GridShape& shape);

/// Particles of this rank that the last sort found in rows asleep. Not collective.
template <int Dim>
std::int64_t sleeping_particles(const Simulation<Dim>& sim);

/// Moves the particles of all other rows over dt. Not collective.
template <int Dim>
void move_sleeping(double dt, Simulation<Dim>& sim);

}  // namespace poreshock
