#pragma once
// Voids placed without regard to each other (Boolean model).

#include "packing.hpp"

namespace poreshock {

/// Radii (m) of `count` voids: median radius times exp(spread * standard normal cut at 2.5).
/// The first voids are the same for every count.
std::vector<double> draw_radii(const Sample& sample, std::size_t count);

/// Independent uniform voids whose union takes the fraction sample.porosity of the block: the
/// number of voids comes as near as it can, a common factor on all radii does the rest. Throws
/// InputError when the keep-out layers leave too little room.
std::vector<Void> place_overlapping(const Sample& sample, const Block& block);

}  // namespace poreshock
