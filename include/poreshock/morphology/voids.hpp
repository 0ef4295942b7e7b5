#pragma once
// Ways to treat void pixels in the Euler characteristic: fill_voids.cpp, euler_density.cpp.

#include <mpi.h>

#include <cstddef>
#include <span>
#include <vector>

#include "poreshock/morphology/pixel_map.hpp"

namespace poreshock {

/// What a void pixel is for the Euler characteristic. Area and boundary are of the material in any
/// case.
enum class Voids {
  black,   ///< cold: a void inside hot material is a hole of it
  white,   ///< hot: a void inside cold material is a hot domain
  fill,    ///< as hot as the nearest material
  exclude  ///< no cell that touches a void or the frame is counted
};

/// The map with void pixels of one field taking the value of the nearest material pixel, by
/// distance of centres; of equally near ones that with the least distance along the last axis of
/// those searched, x, y, then the shock axis, and on its low side. A map without material stays
/// void. Collective; ghost row filled, before and after.
template <int Dim>
PixelField<Dim> fill_voids(const PixelField<Dim>& map, std::size_t field, MPI_Comm communicator);

/// Euler characteristics per material pixel for ascending thresholds: white joining over corners,
/// and over faces (chi8 and chi4, in 3-D chi26 and chi6).
struct EulerDensity {
  std::vector<double> corners, faces;
};

/// Densities of the Euler characteristic of one field, on every rank, zero without material. With
/// Voids::exclude the sum over the kinds of cells of their white share among the cells that lie in
/// the material, which has the right mean for a stationary field (Ohser and Muecklich 2000), but is
/// no topological number. Throws InputError when thresholds descend or are NaN. Collective; ghost
/// row filled.
template <int Dim>
EulerDensity euler_density(const PixelField<Dim>& map, std::size_t field,
                           std::span<const double> thresholds, Voids voids, MPI_Comm communicator);

}  // namespace poreshock
