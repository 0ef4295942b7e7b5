#pragma once
// Private to output: HDF5 ids that close themselves, error texts, and the serial side of a file.

#include <hdf5.h>

#include <string>

#include "poreshock/files/hdf5_file.hpp"

namespace poreshock {

/// An HDF5 id, closed at the end of its scope. The constructor throws SystemError for a failed id.
class Handle {
 public:
  using Close = herr_t (*)(hid_t);
  Handle(hid_t id, Close close, const std::string& what);
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Handle(Handle&& other) noexcept : id_(other.id_), close_(other.close_) { other.id_ = -1; }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;

  hid_t get() const { return id_; }
  /// Closes now; SystemError when that fails.
  void close_now(const std::string& what);

 private:
  hid_t id_;
  Close close_;
};

/// Throws SystemError with the text of the HDF5 error stack when `status` is negative.
void check_hdf5(herr_t status, const std::string& what);

/// Innermost message of the HDF5 error stack.
std::string hdf5_reason();

/// Keeps HDF5 from printing its error stack; the texts are in our exceptions.
void quiet_hdf5();

hid_t file_type(NumberType type);
hid_t memory_type(NumberType type);

/// Access properties without file locks, which many shared file systems do not offer.
Handle serial_access();

/// Makes and closes `path` with all datasets allocated and all attributes written. Serial.
void create_serially(const std::string& path, const FileSpec& spec);

/// Bytes a file of this spec will take: data, and an upper bound of everything else.
struct FileSize {
  std::uint64_t data = 0;
  std::uint64_t overhead = 0;
};
FileSize estimate_size(const FileSpec& spec);

}  // namespace poreshock
