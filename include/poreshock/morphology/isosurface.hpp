#pragma once
// Areas of the interpolated boundaries of a thresholded voxel map.

#include <mpi.h>

#include <cstddef>
#include <span>
#include <vector>

#include "poreshock/morphology/pixel_map.hpp"

namespace poreshock {

/// Area in voxel faces of the surface value = threshold, for ascending thresholds, on every rank:
/// plane pieces through linear interpolation in the six tetrahedra around the diagonal of each cube
/// of 2 x 2 x 2 voxel centres, all material. Exact for plane fronts. What lies in one cube is
/// rounded to 2^-30 faces, so that the sum is the same on any number of ranks. Throws InputError
/// when thresholds descend or are NaN. Collective; ghost layer filled.
/// Payne and Toga, IEEE Comput. Graph. Appl. 10 (1990) 33 (marching tetrahedra); Kuhn, IBM J. Res.
/// Dev. 4 (1960) 518 (the tetrahedra).
std::vector<double> isosurface_areas(const PixelField<3>& map, std::size_t field,
                                     std::span<const double> thresholds, MPI_Comm communicator);

}  // namespace poreshock
