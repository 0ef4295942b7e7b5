#pragma once
// The morphology of one field of a map as a record for a file.

#include <mpi.h>

#include "poreshock/core/tensor.hpp"
#include "poreshock/morphology/pixel_map.hpp"
#include "poreshock/output/morphology_file.hpp"
#include "poreshock/scene/scene.hpp"

namespace poreshock {

/// Counts and functionals of field number `field` of the map at the thresholds of `what`; where the
/// map comes from numbers of 32 bits, thresholds are rounded to such before they are compared, and
/// a value below a threshold by no more than the map's rounding is at it. With
/// quantiles the thresholds of the record are these shares, its curve "level" has the values of the
/// field there (NaN, and nothing hot, where no pixel has a value). With morphology.domains the
/// numbers of domains and chi_paper = (n_W - n_B)/N, and the hot spots at what.hot_spots. Positions
/// are those of the map plus `shift` (m). Counts are on every rank, hot spots on rank 0. Throws
/// InputError when thresholds descend. Collective; ghost row filled.
template <int Dim>
MorphologyRecord measure(const PixelField<Dim>& map, std::size_t field, const MorphologyField& what,
                         const std::string& unit, const Morphology& morphology,
                         const Vector<Dim>& shift, MPI_Comm communicator);

}  // namespace poreshock
