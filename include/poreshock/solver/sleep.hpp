#pragma once
// Sleep: rows of cells that no wave has reached are not computed, their particles only move.

#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/particles/cell_order.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/scene/scene.hpp"

namespace poreshock {

/// Cost of a particle that only moves, to that of one that is computed.
inline constexpr double sleeping_weight = 0.07;

/// The rows of this rank that a wave has reached: those of particles whose velocity differs from
/// that of the loading by more than 1e-12 of the sound speed, and those next to walls and symmetry
/// planes. All rows where the scene cannot sleep. A function of scene and state alone. Not
/// collective.
template <int Dim>
RowRange disturbed_rows(const Scene& scene, const std::vector<Material>& materials,
                        const GridShape& shape, const Particles<Dim>& particles);

/// The rows a step works on: those a wave has reached, and as many beyond as a step lets it go.
RowRange awake_around(RowRange disturbed, const GridShape& shape);

/// Particles of this rank that the last sort found in rows asleep. Not collective.
std::int64_t sleeping_particles(const CellOrder& cells, const SlabGrid& grid);

/// Moves the particles of all other rows over dt. Not collective.
template <int Dim>
void move_sleeping(double dt, const CellOrder& cells, const SlabGrid& grid,
                   Particles<Dim>& particles);

}  // namespace poreshock
