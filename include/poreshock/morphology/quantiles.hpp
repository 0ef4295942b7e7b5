#pragma once
// Quantiles of the values of a map.

#include <mpi.h>

#include <cstddef>
#include <span>
#include <vector>

#include "poreshock/morphology/pixel_map.hpp"

namespace poreshock {

/// For every share p the value that occurs in the map with the fewest material pixels below it that
/// are at least p of all: of N sorted values the one numbered ceil(p N), counted from 1, exactly
/// and on every rank; NaN pixels are left out, and without any other the result is NaN. Each rank
/// sorts its own values near the wanted ones; between the ranks go numbers only. Throws InputError
/// when a share is not in 0 ... 1. Collective.
template <int Dim>
std::vector<double> quantiles(const PixelField<Dim>& map, std::size_t field,
                              std::span<const double> shares, MPI_Comm communicator);

}  // namespace poreshock
