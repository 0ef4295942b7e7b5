#pragma once
// The lock of an output folder: two runs at once would mix their files.

#include <memory>
#include <string>

#include "poreshock/files/posix_file.hpp"

namespace poreshock {

/// A file in the folder that names the host, the process and its start, held open under flock(2)
/// where the file system has it, and removed at the end of its scope. Not collective.
class FolderLock {
 public:
  /// Takes the folder. InputError when a run holds it, or may on another host; a lock whose process
  /// is no more is told and replaced. SystemError when the file cannot be written.
  explicit FolderLock(const std::string& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

 private:
  std::string path_;
  std::unique_ptr<FileDescriptor> file_;
};

/// Name of the lock in its folder.
inline constexpr const char* folder_lock_name = "poreshock.lock";

/// Throws the InputError with which FolderLock would refuse the folder, and changes nothing. Not
/// collective.
void require_unlocked(const std::string& folder);

}  // namespace poreshock
