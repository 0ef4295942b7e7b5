#pragma once
// Files as the operating system sees them: space, durability, renames, numbered names.
// Nothing here is collective; every failure is a SystemError with path and reason.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace poreshock {

/// An open file descriptor, closed at the end of its scope.
class FileDescriptor {
 public:
  /// Opens `path` with the flags of open(2).
  FileDescriptor(const std::string& path, int flags);
  ~FileDescriptor();
  FileDescriptor(const FileDescriptor&) = delete;
  FileDescriptor& operator=(const FileDescriptor&) = delete;

  int get() const { return descriptor_; }
  const std::string& path() const { return path_; }
  /// Size of the file, bytes.
  std::uint64_t size() const;
  /// False when the name now stands for another file or none: this one was removed or moved.
  bool is_at(const std::string& path) const;
  /// Reads exactly `count` bytes at `offset`.
  void read(std::uint64_t offset, std::byte* data, std::size_t count) const;
  /// Writes exactly `count` bytes at `offset`.
  void write(std::uint64_t offset, const std::byte* data, std::size_t count) const;
  /// Forces the content to the disk.
  void sync() const;

 private:
  std::string path_;
  int descriptor_;
};

/// Throws SystemError "cannot <doing> <path>: <reason>" for a value of errno.
[[noreturn]] void throw_errno(std::string_view doing, const std::string& path, int error);

/// Name a file has while it is being written: in the same folder, so that a rename suffices.
std::string partial_name(const std::string& path);

/// Makes sure a new, empty `path` can be made, may grow to `size` bytes, and has room for `reserve`
/// bytes now. Removes it again when not.
void probe_space(const std::string& path, std::uint64_t size, std::uint64_t reserve);

/// Takes the disk space for the first `size` bytes of an open file, `path` in messages, so that
/// later writes into them cannot fail.
void allocate_space(int descriptor, std::uint64_t size, const std::string& path);

/// Renames a file, replacing what was there.
void rename_file(const std::string& from, const std::string& to);

/// Forces the file to disk, renames it and forces the folder to disk.
void publish(const std::string& from, const std::string& to);

/// Forces a folder (the names in it) to disk.
void sync_folder(const std::string& folder);

/// Folder part of a path, "." when it has none.
std::string folder_of(const std::string& path);

/// Removes a file if it exists.
void remove_file(const std::string& path);

/// Writes a text file under a temporary name and renames it, replacing what was there.
void write_text(const std::string& path, std::string_view text);

/// Reads a whole text file; InputError when it cannot be read.
std::string read_text(const std::string& path);

/// prefix + number with at least `digits` digits + suffix, for example snapshot_000012.h5.
std::string numbered_name(std::string_view prefix, std::int64_t number, int digits,
                          std::string_view suffix);

/// One file of a numbered series.
struct NumberedFile {
  std::int64_t number = 0;
  std::string path;
};

/// Files prefix<digits>suffix of a folder in ascending order of their numbers; at least `digits`
/// digits. Empty when the folder cannot be read.
std::vector<NumberedFile> numbered_files(const std::string& folder, std::string_view prefix,
                                         int digits, std::string_view suffix);

}  // namespace poreshock
