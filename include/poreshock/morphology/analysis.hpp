#pragma once
// Counts of a map that is spread over the ranks.

#include <mpi.h>

#include <cstddef>
#include <span>

#include "poreshock/morphology/minkowski.hpp"
#include "poreshock/morphology/pixel_map.hpp"

namespace poreshock {

/// Counts of the blocks of all ranks added up, on every rank; exact, since they are integers. All
/// ranks bring the same number of thresholds. Collective.
PixelCounts reduce(const PixelCounts& counts, MPI_Comm communicator);
VoxelCounts reduce(const VoxelCounts& counts, MPI_Comm communicator);

/// Counts of the whole map for one field of `map` and ascending thresholds in the unit of the
/// field, on every rank. Throws InputError when thresholds descend or are NaN. Collective.
template <int Dim>
MapCounts<Dim> count(const PixelField<Dim>& map, std::size_t field,
                     std::span<const double> thresholds, MPI_Comm communicator);

}  // namespace poreshock
