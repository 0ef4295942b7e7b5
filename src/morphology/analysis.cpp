#include "poreshock/morphology/analysis.hpp"

#include <algorithm>

#include "poreshock/core/parallel.hpp"

namespace poreshock {
namespace {

/// One message for all arrays.
template <class Counts>
Counts reduce_counts(const Counts& counts, MPI_Comm communicator) {
  std::vector<std::int64_t> packed = {counts.pixels};
  for_each_count(counts, [&](std::string_view, const std::vector<std::int64_t>& array) {
    packed.insert(packed.end(), array.begin(), array.end());
  });
  sum(packed, communicator);
  Counts result = counts;
  result.pixels = packed[0];
  auto next = packed.begin() + 1;
  for_each_count(result, [&](std::string_view, std::vector<std::int64_t>& array) {
    const auto end = next + static_cast<std::ptrdiff_t>(array.size());
    std::copy(next, end, array.begin());
    next = end;
  });
  return result;
}

}  // namespace

PixelCounts reduce(const PixelCounts& counts, MPI_Comm communicator) {
  return reduce_counts(counts, communicator);
}

VoxelCounts reduce(const VoxelCounts& counts, MPI_Comm communicator) {
  return reduce_counts(counts, communicator);
}

template <int Dim>
MapCounts<Dim> count(const PixelField<Dim>& map, std::size_t field,
                     std::span<const double> thresholds, MPI_Comm communicator) {
  if constexpr (Dim == 2) {
    return reduce(count_pixels(block(map, field), thresholds), communicator);
  } else {
    return reduce(count_voxels(block(map, field), thresholds), communicator);
  }
}

template PixelCounts count<2>(const PixelField<2>&, std::size_t, std::span<const double>, MPI_Comm);
template VoxelCounts count<3>(const PixelField<3>&, std::size_t, std::span<const double>, MPI_Comm);

}  // namespace poreshock
