#include "hdf5_handle.hpp"

#include "poreshock/core/error.hpp"

namespace poreshock {

Handle::Handle(hid_t id, Close close, const std::string& what) : id_(id), close_(close) {
  if (id < 0) throw SystemError("HDF5 cannot " + what + ": " + hdf5_reason());
}

void Handle::close_now(const std::string& what) {
  const hid_t id = id_;
  id_ = -1;
  check_hdf5(close_(id), what);
}

void check_hdf5(herr_t status, const std::string& what) {
  if (status < 0) throw SystemError("HDF5 cannot " + what + ": " + hdf5_reason());
}

std::string hdf5_reason() {
  std::string text;
  const auto keep_last = [](unsigned, const H5E_error2_t* error, void* data) -> herr_t {
    if (error->desc != nullptr) *static_cast<std::string*>(data) = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_DOWNWARD, keep_last, &text);
  return text.empty() ? "unknown reason" : text;
}

void quiet_hdf5() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

hid_t file_type(NumberType type) {
  switch (type) {
    case NumberType::float64:
      return H5T_IEEE_F64LE;
    case NumberType::float32:
      return H5T_IEEE_F32LE;
    case NumberType::int64:
      return H5T_STD_I64LE;
    case NumberType::int32:
      return H5T_STD_I32LE;
    default:
      return H5T_STD_U8LE;
  }
}

hid_t memory_type(NumberType type) {
  switch (type) {
    case NumberType::float64:
      return H5T_NATIVE_DOUBLE;
    case NumberType::float32:
      return H5T_NATIVE_FLOAT;
    case NumberType::int64:
      return H5T_NATIVE_INT64;
    case NumberType::int32:
      return H5T_NATIVE_INT32;
    default:
      return H5T_NATIVE_UINT8;
  }
}

Handle serial_access() {
  Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "make access properties");
  check_hdf5(H5Pset_file_locking(access.get(), false, true), "switch file locks off");
  return access;
}

}  // namespace poreshock
