#pragma once
// A slab of a map as plain numbers, the same for pixels and voxels. Private to the layer.

#include <mpi.h>

#include <cstdint>
#include <limits>
#include <vector>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/morphology/pixel_map.hpp"

namespace poreshock {

/// Layers follow the shock axis: rows of pixels in 2-D (ny = 1), planes of voxels in 3-D.
struct Slab {
  int nx = 0;
  int ny = 1;
  int layers = 0;  ///< owned
  int stored = 0;  ///< owned and, unless last, the neighbour's first
  bool periodic_x = false;
  bool periodic_y = false;
  bool first = false;
  bool last = false;

  std::size_t layer_size() const {
    return static_cast<std::size_t>(nx) * static_cast<std::size_t>(ny);
  }
  std::size_t stored_size() const { return layer_size() * static_cast<std::size_t>(stored); }
};

template <int Dim>
Slab slab_of(const PixelField<Dim>& map) {
  Slab slab;
  slab.nx = map.layout.pixels[0];
  slab.periodic_x = map.layout.periodic[0];
  if constexpr (Dim == 3) {
    slab.ny = map.layout.pixels[1];
    slab.periodic_y = map.layout.periodic[1];
  }
  slab.layers = map.rows;
  slab.stored = map.rows + (map.last ? 0 : 1);
  slab.first = map.first;
  slab.last = map.last;
  return slab;
}

/// Items of all ranks on rank 0 in rank order, none elsewhere; `starts` gets the first item of each
/// rank and the number of items, on rank 0. Collective.
template <class Item>
std::vector<Item> gather(const std::vector<Item>& items, std::vector<int>& starts,
                         MPI_Comm communicator) {
  static_assert(std::is_trivially_copyable_v<Item>);
  const int ranks = size(communicator);
  const bool root = rank(communicator) == 0;
  const int count = static_cast<int>(items.size());
  std::vector<int> counts(static_cast<std::size_t>(ranks));
  check_mpi(MPI_Gather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, 0, communicator),
            "MPI_Gather");
  starts.assign(static_cast<std::size_t>(ranks) + 1, 0);
  for (std::size_t r = 0; root && r < counts.size(); ++r) starts[r + 1] = starts[r] + counts[r];
  std::vector<Item> all(static_cast<std::size_t>(starts.back()));
  MPI_Datatype type = MPI_DATATYPE_NULL;
  check_mpi(MPI_Type_contiguous(sizeof(Item), MPI_BYTE, &type), "MPI_Type_contiguous");
  check_mpi(MPI_Type_commit(&type), "MPI_Type_commit");
  const int code = MPI_Gatherv(items.data(), count, type, all.data(), counts.data(), starts.data(),
                               type, 0, communicator);
  MPI_Type_free(&type);
  check_mpi(code, "MPI_Gatherv");
  return all;
}

}  // namespace poreshock
