#pragma once
// Which way out of the material: direction of the surface that a particle belongs to.

#include <array>
#include <cstdint>
#include <span>

#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/particles/cell_order.hpp"
#include "poreshock/particles/particles.hpp"

namespace poreshock {

/// Sets `facing` of all particles: the direction of the gradient of a field that is 1 less the
/// filled share at surfaces and fades into the material over two supports of the shape function; 0
/// beyond. Before: lane 0 of `grid` holds the filled share of every node, periodic images filled.
/// Collective (two exchanges of `grid`).
template <int Dim>
void find_facing(const CellOrder& cells, const Transfer& transfer, SlabGrid& grid,
                 Particles<Dim>& particles);

/// Carries `facing` of some particles along with the material over dt, as the gradient of a field
/// that moves with it: f <- F^-T f, to unit length. `gradient` (1/s, row major) has an entry for
/// each of `places`. Plane strain only. Pure in each particle.
template <int Dim>
void turn_facing(const std::array<std::vector<double>, Dim * Dim>& gradient, double dt,
                 std::span<const std::uint32_t> places, Particles<Dim>& particles);

}  // namespace poreshock
