#pragma once
// Arrays of numbers in files of others: .npy of NumPy, and datasets of HDF5 files.

#include <mpi.h>

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "poreshock/files/inflated_file.hpp"

namespace poreshock {

/// An array in a file, first dimension slowest.
struct StoredArray {
  std::string file;
  std::string dataset;  ///< of an HDF5 file; empty for .npy
  std::vector<std::uint64_t> shape;
  bool single_precision = false;           ///< numbers of 32 bits with a fraction
  std::string unit = "1";                  ///< of an HDF5 dataset that says so
  std::string number;                      ///< type of a number, for example "f8"; empty for HDF5
  bool big_endian = false;                 ///< its bytes have the highest first
  std::uint64_t data_begin = 0;            ///< first byte of the numbers
  std::shared_ptr<InflatedFile> inflated;  ///< the plain bytes of compressed numbers; else empty

  /// As the command line names it.
  std::string name() const { return dataset.empty() ? file : file + ":" + dataset; }
  /// Bytes of a number.
  std::uint64_t number_size() const { return static_cast<std::uint64_t>(number[1] - '0'); }
  std::uint64_t row_size() const {
    std::uint64_t result = 1;
    for (std::size_t axis = 1; axis < shape.size(); ++axis) result *= shape[axis];
    return result;
  }
};

/// Whether a name asks for an array: FILE.npy or FILE:/path/in/HDF5.
bool names_array(const std::string& name);

/// Finds the array FILE.npy or FILE.h5:/path. Allowed are floating-point numbers of 32 and 64 bits,
/// whole numbers and flags; in .npy little-endian and rows first (C order). InputError on all ranks
/// for everything else; it names where a .npy file ends too early, counted in what `row` calls an
/// index of the first dimension. Collective.
StoredArray find_array(const std::string& name, MPI_Comm communicator,
                       const std::string& row = "row");

/// Throws InputError unless a file holds the numbers that `array` describes, from `data_begin` to
/// its end; names the `row` in which it ends. Not collective.
void require_numbers(const StoredArray& array, const std::string& row);

/// Rows first ... first + count - 1 (indices along the first dimension) as doubles; every rank may
/// ask for others. InputError on all ranks when the file is too short. Collective.
std::vector<double> read_rows(const StoredArray& array, std::uint64_t first, std::uint64_t count,
                              MPI_Comm communicator);

}  // namespace poreshock
