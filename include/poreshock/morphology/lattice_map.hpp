#pragma once
// Maps on the lattice from which the particles started: pixel = lattice site, so that voids never
// close and a pixel follows its material.

#include <cstdint>
#include <span>
#include <vector>

#include "poreshock/morphology/pixel_map.hpp"

namespace poreshock {

/// Puts the values of particles on their lattice sites; `id` is the number of the site, x fastest,
/// and the grid has a pixel per site. A site without a particle is void. `columns` are the fields,
/// one value per particle, kept to the bit. Throws InputError, on every rank, when an id lies
/// outside the grid. Collective; particles may lie on any rank, ghost row filled on return.
template <int Dim>
PixelField<Dim> place_on_lattice(std::span<const std::int64_t> id,
                                 const std::vector<std::span<const double>>& columns,
                                 const PixelGrid<Dim>& grid);

}  // namespace poreshock
