#pragma once
// Integer sums of some rows of a map, and their way to the owners of the rows. Private to the
// layer.

#include <mpi.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace poreshock {

/// Components of a pixel before those of the fields: covered area, weight. A field has two: the sum
/// of weight times value, and the key of the least value, which is the largest key.
inline constexpr std::size_t first_sum = 2;

/// Sums of consecutive rows of the map, `components` numbers per pixel side by side.
struct RowSums {
  int first;  ///< number of the first row in the map
  int rows;
  std::size_t row_length;  ///< numbers in a row: pixels x components
  std::size_t components;
  std::vector<std::uint64_t> data;

  RowSums(int first_row, int row_count, std::size_t pixels_in_row, std::size_t component_count)
      : first(first_row),
        rows(row_count),
        row_length(pixels_in_row * component_count),
        components(component_count),
        data(static_cast<std::size_t>(row_count) * row_length, 0) {}

  /// Sums of a row, by its number in the map.
  std::uint64_t* row(int number) {
    return data.data() + static_cast<std::size_t>(number - first) * row_length;
  }
  const std::uint64_t* row(int number) const {
    return data.data() + static_cast<std::size_t>(number - first) * row_length;
  }
};

/// Adds up the rows of all ranks' bands at their owners; returns the rows of this rank. row_starts
/// holds the first row of each rank and the number of rows at the end. Collective.
RowSums send_to_owners(const RowSums& band, std::span<const int> row_starts, MPI_Comm communicator);

}  // namespace poreshock
