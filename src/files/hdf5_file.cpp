#include "poreshock/files/hdf5_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <filesystem>

#include "hdf5_handle.hpp"
#include "poreshock/core/rank_zero.hpp"
#include "poreshock/files/block_hash.hpp"
#include "poreshock/files/posix_file.hpp"

namespace poreshock {

namespace {

/// Says what is wrong with a file before all ranks open it. Serial.
void check_readable(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw InputError(path + ": not found");
  if (!std::filesystem::is_regular_file(path, error)) {
    throw InputError(path + ": not a file but a folder or a device");
  }
  if (access(path.c_str(), R_OK) != 0) throw InputError(path + ": no permission to read it");
  if (H5Fis_hdf5(path.c_str()) <= 0) {
    throw InputError(path + ": not an HDF5 file, or its beginning is damaged");
  }
  const Handle properties = serial_access();
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, properties.get());
  if (file < 0) throw InputError(path + ": truncated or damaged HDF5 file: " + hdf5_reason());
  H5Fclose(file);
}

Handle parallel_access(MPI_Comm communicator) {
  Handle access = serial_access();
  // One rank needs no MPI-IO.
  if (size(communicator) == 1) return access;
  check_hdf5(H5Pset_fapl_mpio(access.get(), communicator, MPI_INFO_NULL), "use MPI-IO");
  check_hdf5(H5Pset_all_coll_metadata_ops(access.get(), true), "read structure collectively");
  return access;
}

/// Numbers of one row of a dataset of `space`, and its rows.
struct RowLayout {
  std::uint64_t rows = 1;
  std::uint64_t width = 1;
  std::vector<hsize_t> shape;
};

RowLayout row_layout(hid_t space) {
  RowLayout layout;
  layout.shape.resize(static_cast<std::size_t>(std::max(0, H5Sget_simple_extent_ndims(space))));
  if (layout.shape.empty()) return layout;
  H5Sget_simple_extent_dims(space, layout.shape.data(), nullptr);
  layout.rows = layout.shape[0];
  for (std::size_t d = 1; d < layout.shape.size(); ++d) layout.width *= layout.shape[d];
  return layout;
}

/// Selects rows of a dataset; none selects nothing.
void select_rows(hid_t space, const RowLayout& layout, std::uint64_t first, std::uint64_t rows) {
  if (rows == 0) {
    check_hdf5(H5Sselect_none(space), "select no rows");
    return;
  }
  if (layout.shape.empty()) return;
  std::vector<hsize_t> start(layout.shape.size(), 0);
  std::vector<hsize_t> count = layout.shape;
  start[0] = first;
  count[0] = rows;
  check_hdf5(
      H5Sselect_hyperslab(space, H5S_SELECT_SET, start.data(), nullptr, count.data(), nullptr),
      "select rows");
}

/// Rows of one rank on their way between memory and a dataset.
struct RowTransfer {
  RowLayout layout;
  NumberType type;
  std::uint64_t first;  ///< first row in the dataset
  std::uint64_t count;  ///< rows
  std::uint64_t piece;  ///< rows per call
  std::byte* data;
  bool writing;
};

/// Turns a count of numbers into rows and pieces; SystemError when they are not in the dataset.
void split(const std::string& where, std::uint64_t numbers, std::uint64_t piece_bytes,
           RowTransfer& rows) {
  const std::uint64_t width = rows.layout.width;
  rows.count = width > 0 ? numbers / width : 0;
  if (rows.count * width != numbers || rows.first + rows.count > rows.layout.rows) {
    throw SystemError(where + " has " + std::to_string(rows.layout.rows) + " rows of " +
                      std::to_string(width) + " numbers; asked for " + std::to_string(numbers) +
                      " numbers from row " + std::to_string(rows.first));
  }
  const std::uint64_t row_bytes = std::max<std::uint64_t>(1, width * number_size(rows.type));
  rows.piece = std::max<std::uint64_t>(1, piece_bytes / row_bytes);
}

/// Moves one piece; a rank with fewer pieces than the others takes part with nothing.
herr_t move_piece(const RowTransfer& rows, std::uint64_t piece, hid_t dataset, hid_t properties) {
  const std::uint64_t done = std::min(rows.count, piece * rows.piece);
  const std::uint64_t now = std::min(rows.piece, rows.count - done);
  const Handle space(H5Dget_space(dataset), H5Sclose, "read a shape");
  select_rows(space.get(), rows.layout, rows.first + done, now);
  const hsize_t numbers = std::max<hsize_t>(1, now * rows.layout.width);
  const Handle memory(H5Screate_simple(1, &numbers, nullptr), H5Sclose, "describe memory");
  if (now == 0) check_hdf5(H5Sselect_none(memory.get()), "select no rows");
  std::byte nothing{};
  std::byte* const at =
      now == 0 ? &nothing : rows.data + done * rows.layout.width * number_size(rows.type);
  const hid_t type = memory_type(rows.type);
  return rows.writing ? H5Dwrite(dataset, type, memory.get(), space.get(), properties, at)
                      : H5Dread(dataset, type, memory.get(), space.get(), properties, at);
}

}  // namespace

Hdf5File::Hdf5File(std::string path, MPI_Comm communicator, bool writing, Durable durable)
    : path_(std::move(path)),
      communicator_(communicator),
      writing_(writing),
      durable_(durable),
      exceptions_(std::uncaught_exceptions()) {
  open_handle(writing ? partial_name(path_) : path_);
}

Hdf5File Hdf5File::create(const std::string& path, const FileSpec& spec, MPI_Comm communicator,
                          Replace replace, Durable durable) {
  quiet_hdf5();
  on_rank_zero(communicator, [&] {
    if (replace == Replace::no && std::filesystem::exists(path)) {
      throw SystemError("cannot write " + path + ": it exists already");
    }
    const std::string partial = partial_name(path);
    const FileSize size = estimate_size(spec);
    probe_space(partial, size.data + size.overhead, size.overhead);
    try {
      create_serially(partial, spec);
      if (durable == Durable::now) FileDescriptor(partial, O_RDONLY).sync();
    } catch (...) {
      unlink(partial.c_str());
      throw;
    }
  });
  return Hdf5File(path, communicator, true, durable);
}

Hdf5File Hdf5File::open(const std::string& path, MPI_Comm communicator) {
  quiet_hdf5();
  on_rank_zero(communicator, [&] { check_readable(path); });
  return Hdf5File(path, communicator, false, Durable::now);
}

void Hdf5File::open_handle(const std::string& path) {
  agree_here(attempt([&] {
    const Handle access = parallel_access(communicator_);
    handle_ = H5Fopen(path.c_str(), writing_ ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access.get());
    check_hdf5(handle_ < 0 ? -1 : 0, "open " + path);
  }));
}

void Hdf5File::agree_here(const Outcome& outcome) {
  failed_together_ = true;
  agree(outcome, communicator_);
  failed_together_ = false;
}

Hdf5File::~Hdf5File() {
  if (handle_ < 0) return;
  // Closing is collective: a rank that fails alone would wait here for the others for ever.
  const bool alone = std::uncaught_exceptions() > exceptions_ && !failed_together_;
  if (alone && size(communicator_) > 1) return;
  H5Fclose(handle_);
  if (writing_ && rank(communicator_) == 0) unlink(partial_name(path_).c_str());
}

void Hdf5File::transfer(const std::string& dataset, std::uint64_t first_row, NumberType type,
                        void* data, std::uint64_t count, std::uint64_t piece_bytes) {
  std::optional<Handle> opened;
  RowTransfer rows{{}, type, first_row, 0, 1, static_cast<std::byte*>(data), writing_};
  std::int64_t pieces = 0;
  // All that can go wrong on one rank alone is checked before the ranks depend on each other.
  agree_here(attempt([&] {
    const hid_t found = H5Dopen2(handle_, dataset.c_str(), H5P_DEFAULT);
    if (found < 0) throw InputError(path_ + ": has no dataset " + dataset);
    opened.emplace(found, H5Dclose, "open " + dataset);
    const Handle space(H5Dget_space(found), H5Sclose, "read the shape of " + dataset);
    rows.layout = row_layout(space.get());
    split(path_ + ": " + dataset, count, piece_bytes, rows);
    pieces = static_cast<std::int64_t>((rows.count + rows.piece - 1) / rows.piece);
  }));
  check_mpi(MPI_Allreduce(MPI_IN_PLACE, &pieces, 1, MPI_INT64_T, MPI_MAX, communicator_),
            "MPI_Allreduce");
  for (std::int64_t p = 0; p < pieces; ++p) {
    agree_here(attempt([&] {
      const Handle properties(H5Pcreate(H5P_DATASET_XFER), H5Pclose, "make transfer properties");
      if (size(communicator_) > 1) {
        check_hdf5(H5Pset_dxpl_mpio(properties.get(), H5FD_MPIO_COLLECTIVE), "write together");
      }
      check_hdf5(move_piece(rows, static_cast<std::uint64_t>(p), opened->get(), properties.get()),
                 (writing_ ? "write " : "read ") + dataset + " of " + path_);
    }));
  }
}

void Hdf5File::finish() {
  const hid_t handle = handle_;
  handle_ = -1;
  agree_here(attempt([&] { check_hdf5(H5Fclose(handle), "close " + path_); }));
  if (!writing_) return;
  const std::string partial = partial_name(path_);
  // Other ranks may read through another cache, which sees what was forced to disk.
  const bool force = durable_ == Durable::now;
  write_seal(partial, force || size(communicator_) > 1, communicator_);
  on_rank_zero(communicator_,
               [&] { force ? publish(partial, path_) : rename_file(partial, path_); });
}

template <class T>
void Hdf5File::write(const std::string& dataset, std::uint64_t first_row, std::span<const T> values,
                     std::uint64_t piece_bytes) {
  // HDF5 takes both directions through one interface; nothing is written through this pointer.
  transfer(dataset, first_row, number_type_of<T>, const_cast<T*>(values.data()), values.size(),
           piece_bytes);
}

template <class T>
void Hdf5File::read(const std::string& dataset, std::uint64_t first_row, std::span<T> values,
                    std::uint64_t piece_bytes) {
  transfer(dataset, first_row, number_type_of<T>, values.data(), values.size(), piece_bytes);
}

template <class T>
std::vector<T> Hdf5File::read_all(const std::string& path) {
  std::uint64_t count = 1;
  for (const std::uint64_t extent : dataset(path).shape) count *= extent;
  std::vector<T> values(count);
  read(path, 0, std::span<T>(values));
  return values;
}

RowRange rows_in_rank_order(std::uint64_t count, MPI_Comm communicator) {
  RowRange range{0, count, count};
  check_mpi(MPI_Exscan(&count, &range.first, 1, MPI_UINT64_T, MPI_SUM, communicator), "MPI_Exscan");
  if (rank(communicator) == 0) range.first = 0;
  check_mpi(MPI_Allreduce(&count, &range.total, 1, MPI_UINT64_T, MPI_SUM, communicator),
            "MPI_Allreduce");
  return range;
}

RowRange equal_share(std::uint64_t total, MPI_Comm communicator) {
  const auto ranks = static_cast<std::uint64_t>(size(communicator));
  const auto mine = static_cast<std::uint64_t>(rank(communicator));
  const std::uint64_t base = total / ranks;
  const std::uint64_t extra = total % ranks;
  return {mine * base + std::min(mine, extra), base + (mine < extra ? 1 : 0), total};
}

template void Hdf5File::write<double>(const std::string&, std::uint64_t, std::span<const double>,
                                      std::uint64_t);
template void Hdf5File::write<float>(const std::string&, std::uint64_t, std::span<const float>,
                                     std::uint64_t);
template void Hdf5File::write<std::int64_t>(const std::string&, std::uint64_t,
                                            std::span<const std::int64_t>, std::uint64_t);
template void Hdf5File::write<std::int32_t>(const std::string&, std::uint64_t,
                                            std::span<const std::int32_t>, std::uint64_t);
template void Hdf5File::write<std::uint8_t>(const std::string&, std::uint64_t,
                                            std::span<const std::uint8_t>, std::uint64_t);
template void Hdf5File::read<double>(const std::string&, std::uint64_t, std::span<double>,
                                     std::uint64_t);
template void Hdf5File::read<float>(const std::string&, std::uint64_t, std::span<float>,
                                    std::uint64_t);
template void Hdf5File::read<std::int64_t>(const std::string&, std::uint64_t,
                                           std::span<std::int64_t>, std::uint64_t);
template void Hdf5File::read<std::int32_t>(const std::string&, std::uint64_t,
                                           std::span<std::int32_t>, std::uint64_t);
template void Hdf5File::read<std::uint8_t>(const std::string&, std::uint64_t,
                                           std::span<std::uint8_t>, std::uint64_t);
template std::vector<double> Hdf5File::read_all<double>(const std::string&);
template std::vector<float> Hdf5File::read_all<float>(const std::string&);
template std::vector<std::int64_t> Hdf5File::read_all<std::int64_t>(const std::string&);
template std::vector<std::int32_t> Hdf5File::read_all<std::int32_t>(const std::string&);
template std::vector<std::uint8_t> Hdf5File::read_all<std::uint8_t>(const std::string&);

}  // namespace poreshock
