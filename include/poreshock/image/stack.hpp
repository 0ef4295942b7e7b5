#pragma once
// Pictures (2-D) and stacks of slices (3-D) from tomography, in any of their files, read in parts.

#include <mpi.h>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "poreshock/files/array_file.hpp"

namespace poreshock {

/// How the numbers of a raw file lie in it, x fastest.
struct RawLayout {
  std::array<std::int64_t, 3> size{1, 1, 1};  ///< voxels along x, y(, z)
  std::string number = "u1";                  ///< as in StoredArray
  bool big_endian = false;
  std::int64_t skip = 0;  ///< bytes before the numbers
};

/// A picture or a stack that has been found and is not read yet. Its layers follow the shock axis
/// from the low side up: slices in 3-D, the first one lowest; rows of pixels in 2-D, the last one
/// lowest.
struct Stack {
  std::string name;
  int dimension = 3;
  bool grey = false;                          ///< values are grey; else labels
  std::array<std::int64_t, 3> size{1, 1, 1};  ///< voxels along x, y(, z)
  std::vector<std::string> slices;            ///< pictures of a folder, in order
  bool pages = false;                         ///< one TIFF file, a page for each slice
  int depth = 0;                              ///< of pictures and pages: bits of a sample
  std::optional<StoredArray> array;           ///< numbers in one file
  std::vector<std::string> problems;          ///< what is wrong with it, known to every rank

  std::int64_t layers() const { return size[static_cast<std::size_t>(dimension - 1)]; }
  /// Voxels of one layer.
  std::int64_t layer_size() const { return size[0] * (dimension == 3 ? size[1] : 1); }
};

/// Finds what `name` stands for: a folder of PNG, PGM or TIFF slices numbered without a gap, a TIFF
/// file, MetaImage (.mhd, .mha), NRRD (.nrrd, .nhdr), .npy, FILE.h5:/path, or, with `raw`, plain
/// numbers; in 2-D a picture of `read_image` or such an array of two axes. Arrays are C order: x
/// fastest, z slowest. InputError on all ranks when it cannot be read at all. Collective.
Stack find_stack(const std::string& name, int dimension, bool grey,
                 const std::optional<RawLayout>& raw, MPI_Comm communicator);

/// Layers that are best read together: about 8 MB of values, or one layer; all of a picture.
std::int64_t layers_at_once(const Stack& stack);

/// Values of layers first ... first + count - 1, x fastest; not a number where there is nothing.
/// Adds a sentence to `problems` for each slice that cannot be read, or differs in size or depth
/// from the first. Every rank may ask for others, or none. Collective.
std::vector<double> read_layers(const Stack& stack, std::int64_t first, std::int64_t count,
                                MPI_Comm communicator, std::vector<std::string>& problems);

}  // namespace poreshock
