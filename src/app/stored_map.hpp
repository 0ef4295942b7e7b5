#pragma once
// Maps from files. Private to the app.

#include <mpi.h>

#include <string>

#include "poreshock/app/analyze.hpp"
#include "poreshock/core/tensor.hpp"
#include "poreshock/files/array_file.hpp"
#include "poreshock/files/hdf5_file.hpp"
#include "poreshock/morphology/pixel_map.hpp"
#include "poreshock/output/morphology_file.hpp"
#include "poreshock/scene/scene.hpp"

namespace poreshock {

/// A map with what is known about it.
template <int Dim>
struct StoredMap {
  PixelField<Dim> map;
  std::string field;
  std::string unit;
  RecordStamp stamp;  ///< of a snapshot; of an array all zero
  Vector<Dim> shift = Vector<Dim>::Zero();
  std::int64_t unknown = 0;  ///< pixels that are material by the mask, but have no value
};

/// The map of an array: the last dimension is x, the first the shock axis. NaN is void, with a mask
/// too. Throws InputError when shapes do not fit, when there is NaN in the mask, or no material.
/// Collective.
template <int Dim>
StoredMap<Dim> map_of_array(const StoredArray& array, const AnalyzeOptions& options,
                            MPI_Comm communicator);

/// The map of a snapshot, made from its particles as a run does.
/// Throws InputError when it lacks a dataset. Collective.
template <int Dim>
StoredMap<Dim> map_of_snapshot(const std::string& path, const AnalyzeOptions& options,
                               MPI_Comm communicator);

}  // namespace poreshock
