#pragma once
// Pages of a TIFF file, as libtiff reads them. Private to the layer.

#include <cstdint>
#include <memory>
#include <string>

#include "poreshock/image/image.hpp"

struct tiff;

namespace poreshock {

/// An open TIFF file. All members throw InputError that names the file.
class TiffFile {
 public:
  explicit TiffFile(const std::string& path);
  ~TiffFile();
  TiffFile(const TiffFile&) = delete;
  TiffFile& operator=(const TiffFile&) = delete;

  /// Number of pages; throws when the file ends before the last.
  std::int64_t pages();
  /// read_image for one page.
  Image read(std::int64_t page, bool grey);

 private:
  [[noreturn]] void refuse(const std::string& found) const;

  std::string path_;
  std::unique_ptr<std::string> reason_;  // what libtiff said last
  struct tiff* handle_ = nullptr;
};

}  // namespace poreshock
