#include <sys/mman.h>
#include <unistd.h>

#include <cerrno>

#include "hdf5_handle.hpp"
#include "poreshock/core/error.hpp"
#include "poreshock/files/block_hash.hpp"
#include "poreshock/files/posix_file.hpp"

namespace poreshock {

namespace {

void write_attribute(hid_t object, const Attribute& attribute) {
  const std::string what = "write the attribute " + attribute.name;
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, what);
  const auto write = [&](hid_t type, hid_t memory, const void* value) {
    const Handle made(
        H5Acreate2(object, attribute.name.c_str(), type, space.get(), H5P_DEFAULT, H5P_DEFAULT),
        H5Aclose, what);
    check_hdf5(H5Awrite(made.get(), memory, value), what);
  };
  if (const auto* text = std::get_if<std::string>(&attribute.value)) {
    // Of variable length: a fixed text may not be longer than 64 KiB, and a scene may.
    const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, what);
    check_hdf5(H5Tset_size(type.get(), H5T_VARIABLE), what);
    check_hdf5(H5Tset_cset(type.get(), H5T_CSET_UTF8), what);
    const char* data = text->c_str();
    write(type.get(), type.get(), &data);
  } else if (const auto* number = std::get_if<double>(&attribute.value)) {
    write(H5T_IEEE_F64LE, H5T_NATIVE_DOUBLE, number);
  } else {
    write(H5T_STD_I64LE, H5T_NATIVE_INT64, &std::get<std::int64_t>(attribute.value));
  }
}

void create_dataset(hid_t file, hid_t links, const DatasetSpec& spec) {
  const std::string what = "make the dataset " + spec.path;
  const std::vector<hsize_t> shape(spec.shape.begin(), spec.shape.end());
  const Handle space(H5Screate_simple(static_cast<int>(shape.size()), shape.data(), nullptr),
                     H5Sclose, what);
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, what);
  check_hdf5(H5Pset_layout(properties.get(), H5D_CONTIGUOUS), what);
  check_hdf5(H5Pset_alloc_time(properties.get(), H5D_ALLOC_TIME_EARLY), what);
  check_hdf5(H5Pset_fill_time(properties.get(), H5D_FILL_TIME_NEVER), what);
  // Without times the same data give the same file, byte for byte.
  check_hdf5(H5Pset_obj_track_times(properties.get(), false), what);
  const Handle dataset(H5Dcreate2(file, spec.path.c_str(), file_type(spec.type), space.get(), links,
                                  properties.get(), H5P_DEFAULT),
                       H5Dclose, what);
  write_attribute(dataset.get(), {"unit", spec.unit});
  for (const Attribute& attribute : spec.attributes) write_attribute(dataset.get(), attribute);
}

/// Descriptor of a file that HDF5 has opened alone.
int descriptor_of(hid_t file) {
  void* descriptor = nullptr;
  check_hdf5(H5Fget_vfd_handle(file, H5P_DEFAULT, &descriptor), "find the descriptor of a file");
  return *static_cast<int*>(descriptor);
}

/// Takes the space of all that will be written. HDF5 crashes at the end of the program once it
/// could not write all of a file: where there is no space, what it still has to write goes to
/// memory.
void take_space(hid_t file, const std::string& path, const FileSize& size) {
  const int descriptor = descriptor_of(file);
  try {
    allocate_space(descriptor, size.data + size.overhead, path);
  } catch (const SystemError&) {
    const int memory = memfd_create("unwritten", MFD_CLOEXEC);
    if (memory >= 0) {
      dup2(memory, descriptor);
      close(memory);
    }
    throw;
  }
}

/// Gives back the space that was taken beyond the end of the file.
void cut_to_size(hid_t file, const std::string& path) {
  hsize_t size = 0;
  check_hdf5(H5Fflush(file, H5F_SCOPE_LOCAL), "write " + path);
  check_hdf5(H5Fget_filesize(file, &size), "read the size of " + path);
  if (ftruncate(descriptor_of(file), static_cast<off_t>(size)) != 0) {
    throw_errno("cut to size", path, errno);
  }
}

std::uint64_t text_bytes(const Attribute& attribute) {
  const auto* text = std::get_if<std::string>(&attribute.value);
  return 256 + attribute.name.size() + (text != nullptr ? text->size() : 0);
}

}  // namespace

void create_serially(const std::string& path, const FileSpec& spec) {
  const Handle creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, "make creation properties");
  check_hdf5(H5Pset_userblock(creation.get(), seal_bytes), "reserve the block of the seal");
  check_hdf5(H5Pset_obj_track_times(creation.get(), false), "switch time stamps off");
  const Handle links(H5Pcreate(H5P_LINK_CREATE), H5Pclose, "make link properties");
  check_hdf5(H5Pset_create_intermediate_group(links.get(), 1), "make groups on the way");
  const Handle access = serial_access();
  Handle file(H5Fcreate(path.c_str(), H5F_ACC_TRUNC, creation.get(), access.get()), H5Fclose,
              "create " + path);
  take_space(file.get(), path, estimate_size(spec));
  for (const Attribute& attribute : spec.attributes) write_attribute(file.get(), attribute);
  for (const DatasetSpec& dataset : spec.datasets) create_dataset(file.get(), links.get(), dataset);
  cut_to_size(file.get(), path);
  file.close_now("write " + path);
}

FileSize estimate_size(const FileSpec& spec) {
  FileSize size{0, seal_bytes + 8192};
  for (const Attribute& attribute : spec.attributes) size.overhead += text_bytes(attribute);
  for (const DatasetSpec& dataset : spec.datasets) {
    std::uint64_t bytes = number_size(dataset.type);
    for (const std::uint64_t extent : dataset.shape) bytes *= extent;
    size.data += bytes;
    size.overhead += 1024 + dataset.path.size();
    for (const Attribute& attribute : dataset.attributes) size.overhead += text_bytes(attribute);
  }
  return size;
}

}  // namespace poreshock
