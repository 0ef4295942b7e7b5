#pragma once
// Files whose content is compressed by zlib or gzip.

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "poreshock/files/posix_file.hpp"

struct z_stream_s;

namespace poreshock {

/// The plain bytes of a compressed file, or of its part from `begin` on. Reading forward does no
/// work twice, reading backward begins anew. Not collective.
class InflatedFile {
 public:
  /// Opens nothing yet.
  InflatedFile(std::string path, std::uint64_t begin);
  ~InflatedFile();
  InflatedFile(const InflatedFile&) = delete;
  InflatedFile& operator=(const InflatedFile&) = delete;

  /// Reads plain bytes from `offset` on; returns how many there are, at most `count`.
  std::uint64_t read(std::uint64_t offset, std::byte* data, std::uint64_t count);
  /// Number of plain bytes, counted no further than `most`.
  std::uint64_t size(std::uint64_t most);
  /// What is wrong with the file where the bytes end, empty when it ends well.
  const std::string& damage() const { return damage_; }

 private:
  void start();
  std::uint64_t inflate_some(std::byte* data, std::uint64_t count);
  bool refill();
  void end_member();

  std::string path_;
  std::uint64_t begin_;
  std::optional<FileDescriptor> file_;
  std::unique_ptr<z_stream_s> stream_;
  std::vector<std::byte> input_;  // a part of the file
  std::uint64_t read_to_ = 0;     // bytes of the file that were read
  std::uint64_t position_ = 0;    // plain bytes so far
  bool ended_ = false;
  std::string damage_;
};

}  // namespace poreshock
