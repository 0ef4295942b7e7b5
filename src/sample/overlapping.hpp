#pragma once
// Voids placed without regard to each other (Boolean model). Also in matching_voids.cpp.

#include "packing.hpp"

namespace poreshock {

/// Radii (m) of `count` voids: median radius times exp(spread * standard normal cut at 2.5).
/// The first voids are the same for every count.
std::vector<double> draw_radii(const Sample& sample, std::size_t count);

/// Voids, largest first, whose measures sum up to sample.porosity of the block exactly: as many as
/// come nearest to it, then one common factor on all radii. Their centres are not set. Throws
/// InputError when that is less than half a void.
std::vector<Void> matching_voids(const Sample& sample, const Block& block);

/// Independent uniform voids whose union takes the fraction sample.porosity of the block: the
/// number of voids comes as near as it can, a common factor on all radii does the rest. Throws
/// InputError when the keep-out layers leave too little room.
std::vector<Void> place_overlapping(const Sample& sample, const Block& block);

}  // namespace poreshock
