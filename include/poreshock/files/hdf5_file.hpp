#pragma once
// One HDF5 file shared by all ranks. Writing: everything is declared first, rank 0 makes the file
// under a temporary name and takes its whole disk space, all ranks write their rows, finish() seals
// the file (block_hash.hpp) and renames it. A full disk is found before any rank writes, and a
// killed run leaves no broken file under a final name. Also in hdf5_catalogue.cpp, hdf5_create.cpp.

#include <mpi.h>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "poreshock/core/rank_zero.hpp"

namespace poreshock {

enum class NumberType { float64, float32, int64, int32, uint8 };

/// Printable name of a number type, for example "float64".
std::string_view number_type_name(NumberType type);
/// Bytes of one number.
std::size_t number_size(NumberType type);

/// The number type of a C++ type.
template <class T>
inline constexpr NumberType number_type_of = [] {
  if constexpr (std::is_same_v<T, double>) return NumberType::float64;
  if constexpr (std::is_same_v<T, float>) return NumberType::float32;
  if constexpr (std::is_same_v<T, std::int64_t>) return NumberType::int64;
  if constexpr (std::is_same_v<T, std::int32_t>) return NumberType::int32;
  if constexpr (std::is_same_v<T, std::uint8_t>) return NumberType::uint8;
}();

using AttributeValue = std::variant<std::int64_t, double, std::string>;

struct Attribute {
  std::string name;
  AttributeValue value;
};

/// A dataset to be made; rows are the first dimension.
struct DatasetSpec {
  std::string path;  ///< for example "/particles/mass"; folders are made
  NumberType type = NumberType::float64;
  std::vector<std::uint64_t> shape;
  std::string unit;                   ///< "1" for plain numbers
  std::vector<Attribute> attributes;  ///< besides `unit`
};

/// All datasets and root attributes of a file to be made.
struct FileSpec {
  std::vector<DatasetSpec> datasets;
  std::vector<Attribute> attributes;
};

/// A dataset found in a file; no type when it holds other things than our number types.
struct DatasetInfo {
  std::string path;
  std::optional<NumberType> type;
  bool numbers = false;  ///< what it holds can be read as numbers, flags and any integers too
  std::vector<std::uint64_t> shape;
  std::string unit;

  std::uint64_t rows() const { return shape.empty() ? 1 : shape[0]; }
};

enum class Replace { no, yes };

/// When a finished file is forced to disk: by finish(), or later by sync_records(). A file that is
/// not forced yet outlives the program, but may not outlive the machine.
enum class Durable { now, later };

/// Most bytes one rank hands to one collective transfer; MPI-IO counts them in 32 bits.
inline constexpr std::uint64_t default_piece_bytes = std::uint64_t{1} << 30;

/// A shared HDF5 file, being written (create) or read (open). All members are collective over the
/// communicator and fail on all ranks together, and so is the destructor, which removes a file that
/// was not finished; after an exception that did not come from a member it leaves the file as it
/// is, because the other ranks may not be there to close it. Number types: double, float,
/// std::int64_t, std::int32_t, std::uint8_t.
class Hdf5File {
 public:
  /// Makes a file with all its datasets and attributes (rank 0's `spec` counts). SystemError when
  /// the disk has no room, or when `path` exists and may not be replaced. Collective.
  static Hdf5File create(const std::string& path, const FileSpec& spec, MPI_Comm communicator,
                         Replace replace = Replace::no, Durable durable = Durable::now);
  /// Opens a file for reading; InputError when it is missing, not HDF5, or truncated. The seal is
  /// not checked: see verify(). Collective.
  static Hdf5File open(const std::string& path, MPI_Comm communicator);
  ~Hdf5File();
  Hdf5File(const Hdf5File&) = delete;
  Hdf5File& operator=(const Hdf5File&) = delete;

  /// Writes this rank's rows first_row ... of a dataset, row after row; may be none. Collective.
  template <class T>
  void write(const std::string& dataset, std::uint64_t first_row, std::span<const T> values,
             std::uint64_t piece_bytes = default_piece_bytes);
  /// Reads rows first_row ... of a dataset into `values`, as many as fit; may be none. Collective.
  template <class T>
  void read(const std::string& dataset, std::uint64_t first_row, std::span<T> values,
            std::uint64_t piece_bytes = default_piece_bytes);
  /// Reads a whole dataset on every rank. Collective.
  template <class T>
  std::vector<T> read_all(const std::string& dataset);

  /// An attribute of the root or of a dataset; nothing when there is none of that name. Collective.
  std::optional<AttributeValue> attribute(const std::string& name, const std::string& object = "/");
  /// The attribute as an integer, a double (integers convert) or a text; InputError when it is
  /// missing or of another kind. Collective.
  std::int64_t integer(const std::string& name);
  double number(const std::string& name);
  std::string text(const std::string& name);
  /// All datasets by path. Collective.
  std::vector<DatasetInfo> datasets();
  /// One dataset; InputError when the file has none of that path. Collective.
  DatasetInfo dataset(const std::string& path);

  /// Ends writing: closes, seals, forces to disk unless that is for later, and renames to the final
  /// name. Collective.
  void finish();

  const std::string& path() const { return path_; }

 private:
  Hdf5File(std::string path, MPI_Comm communicator, bool writing, Durable durable);
  void open_handle(const std::string& path);
  void agree_here(const Outcome& outcome);
  void transfer(const std::string& dataset, std::uint64_t first_row, NumberType type, void* data,
                std::uint64_t count, std::uint64_t piece_bytes);

  std::string path_;
  MPI_Comm communicator_;
  bool writing_;
  Durable durable_;
  bool failed_together_ = false;  // a member threw on all ranks
  int exceptions_;                // in flight when the file was opened
  std::int64_t handle_ =
      -1;  // an HDF5 id, kept as a plain integer so that hdf5.h stays out of here
};

/// Rows of a dataset that the ranks fill one after the other.
struct RowRange {
  std::uint64_t first = 0;  ///< first row of this rank
  std::uint64_t count = 0;  ///< rows of this rank
  std::uint64_t total = 0;  ///< rows of all ranks
};

/// Rows of a rank that brings `count` of them, in rank order. Collective.
RowRange rows_in_rank_order(std::uint64_t count, MPI_Comm communicator);

/// This rank's equal contiguous share of `total` rows. Not collective.
RowRange equal_share(std::uint64_t total, MPI_Comm communicator);

}  // namespace poreshock
