#pragma once
// Lengths of the interpolated boundaries of a thresholded map.

#include <mpi.h>

#include <cstddef>
#include <span>
#include <vector>

#include "poreshock/morphology/pixel_map.hpp"

namespace poreshock {

/// Length in pixels of the line value = threshold, for ascending thresholds, on every rank:
/// straight pieces through linear interpolation between the centres of 2 x 2 pixels, all material;
/// where white pixels meet over a corner the mean of the four says whether they join. Exact for
/// plane fronts. Each piece is rounded to 2^-30 pixels, so that the sum is the same on any number
/// of ranks. Throws InputError when thresholds descend or are NaN. Collective; ghost row filled.
/// Mantz, Jacobs and Mecke, J. Stat. Mech. (2008) P12015.
std::vector<double> isoline_lengths(const PixelField<2>& map, std::size_t field,
                                    std::span<const double> thresholds, MPI_Comm communicator);

}  // namespace poreshock
