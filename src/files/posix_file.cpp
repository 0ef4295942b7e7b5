#include "poreshock/files/posix_file.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <filesystem>

#include "poreshock/core/error.hpp"

namespace poreshock {

namespace {

/// Ignores SIGXFSZ in its scope: a file over the size limit of the process is then an error code.
class IgnoreFileSizeSignal {
 public:
  IgnoreFileSizeSignal() {
    struct sigaction ignore {};
    ignore.sa_handler = SIG_IGN;
    sigaction(SIGXFSZ, &ignore, &before_);
  }
  ~IgnoreFileSizeSignal() { sigaction(SIGXFSZ, &before_, nullptr); }
  IgnoreFileSizeSignal(const IgnoreFileSizeSignal&) = delete;
  IgnoreFileSizeSignal& operator=(const IgnoreFileSizeSignal&) = delete;

 private:
  struct sigaction before_ {};
};

std::string reason(int error) {
  if (error == ENOSPC) return "no space left on the device";
  if (error == EDQUOT) return "the disk quota is used up";
  if (error == EFBIG) return "the file would be larger than the file size limit (ulimit -f)";
  return std::strerror(error);
}

int allocate(int descriptor, std::uint64_t size) {
  if (size == 0) return 0;
  int error = EINTR;
  while (error == EINTR) error = posix_fallocate(descriptor, 0, static_cast<off_t>(size));
  return error;
}

}  // namespace

void throw_errno(std::string_view doing, const std::string& path, int error) {
  throw SystemError("cannot " + std::string(doing) + " " + path + ": " + reason(error));
}

FileDescriptor::FileDescriptor(const std::string& path, int flags)
    : path_(path), descriptor_(::open(path.c_str(), flags | O_CLOEXEC, 0666)) {
  if (descriptor_ < 0) throw_errno("open", path, errno);
}

FileDescriptor::~FileDescriptor() {
  ::close(descriptor_);
}

std::uint64_t FileDescriptor::size() const {
  struct stat status {};
  if (fstat(descriptor_, &status) != 0) throw_errno("read the size of", path_, errno);
  return static_cast<std::uint64_t>(status.st_size);
}

bool FileDescriptor::is_at(const std::string& path) const {
  struct stat here {};
  struct stat there {};
  return fstat(descriptor_, &here) == 0 && stat(path.c_str(), &there) == 0 &&
         here.st_dev == there.st_dev && here.st_ino == there.st_ino;
}

void FileDescriptor::read(std::uint64_t offset, std::byte* data, std::size_t count) const {
  while (count > 0) {
    const ssize_t got = pread(descriptor_, data, count, static_cast<off_t>(offset));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) throw_errno("read", path_, errno);
    if (got == 0) throw SystemError("cannot read " + path_ + ": it ends too early");
    offset += static_cast<std::uint64_t>(got);
    data += got;
    count -= static_cast<std::size_t>(got);
  }
}

void FileDescriptor::write(std::uint64_t offset, const std::byte* data, std::size_t count) const {
  const IgnoreFileSizeSignal guard;
  while (count > 0) {
    const ssize_t put = pwrite(descriptor_, data, count, static_cast<off_t>(offset));
    if (put < 0 && errno == EINTR) continue;
    if (put < 0) throw_errno("write", path_, errno);
    offset += static_cast<std::uint64_t>(put);
    data += put;
    count -= static_cast<std::size_t>(put);
  }
}

void FileDescriptor::sync() const {
  // Pipes and devices such as /dev/null cannot be synced (EINVAL), and need not be.
  if (fsync(descriptor_) != 0 && errno != EINVAL) throw_errno("force to disk", path_, errno);
}

std::string partial_name(const std::string& path) {
  return path + ".part";
}

void probe_space(const std::string& path, std::uint64_t size, std::uint64_t reserve) {
  const IgnoreFileSizeSignal guard;
  const int descriptor = ::open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0666);
  if (descriptor < 0) throw_errno("create", path, errno);
  // The size alone takes no space but meets the size limits; the reserve meets a full disk.
  int error = ftruncate(descriptor, static_cast<off_t>(size)) == 0 ? 0 : errno;
  if (error == 0) error = allocate(descriptor, std::min(size, reserve));
  ::close(descriptor);
  if (error == 0) return;
  unlink(path.c_str());
  throw_errno("make a file of " + std::to_string(size) + " bytes at", path, error);
}

void allocate_space(int descriptor, std::uint64_t size, const std::string& path) {
  const IgnoreFileSizeSignal guard;
  const int error = allocate(descriptor, size);
  if (error != 0) throw_errno("take " + std::to_string(size) + " bytes for", path, error);
}

void sync_folder(const std::string& folder) {
  const FileDescriptor descriptor(folder, O_RDONLY | O_DIRECTORY);
  descriptor.sync();
}

std::string folder_of(const std::string& path) {
  const std::string folder = std::filesystem::path(path).parent_path().string();
  return folder.empty() ? "." : folder;
}

void rename_file(const std::string& from, const std::string& to) {
  if (rename(from.c_str(), to.c_str()) != 0) throw_errno("rename " + from + " to", to, errno);
}

void publish(const std::string& from, const std::string& to) {
  FileDescriptor(from, O_RDONLY).sync();
  rename_file(from, to);
  sync_folder(folder_of(to));
}

void remove_file(const std::string& path) {
  if (unlink(path.c_str()) != 0 && errno != ENOENT) throw_errno("remove", path, errno);
}

void write_text(const std::string& path, std::string_view text) {
  const std::string partial = partial_name(path);
  try {
    const FileDescriptor file(partial, O_WRONLY | O_CREAT | O_TRUNC);
    file.write(0, reinterpret_cast<const std::byte*>(text.data()), text.size());
    publish(partial, path);
  } catch (...) {
    unlink(partial.c_str());
    throw;
  }
}

std::string read_text(const std::string& path) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(path, error)) {
    throw InputError(path + ": not found, or not a file");
  }
  try {
    const FileDescriptor file(path, O_RDONLY);
    std::string text(file.size(), '\0');
    file.read(0, reinterpret_cast<std::byte*>(text.data()), text.size());
    return text;
  } catch (const SystemError& failure) {
    throw InputError(failure.what());
  }
}

std::string numbered_name(std::string_view prefix, std::int64_t number, int digits,
                          std::string_view suffix) {
  std::string text = std::to_string(number);
  const std::size_t width = static_cast<std::size_t>(digits);
  if (text.size() < width) text.insert(0, width - text.size(), '0');
  return std::string(prefix) + text + std::string(suffix);
}

std::vector<NumberedFile> numbered_files(const std::string& folder, std::string_view prefix,
                                         int digits, std::string_view suffix) {
  std::vector<NumberedFile> files;
  std::error_code error;
  for (const auto& entry : std::filesystem::directory_iterator(folder, error)) {
    const std::string name = entry.path().filename().string();
    if (name.size() < prefix.size() + suffix.size() + static_cast<std::size_t>(digits)) continue;
    if (!name.starts_with(prefix) || !name.ends_with(suffix)) continue;
    const char* first = name.data() + prefix.size();
    const char* last = name.data() + name.size() - suffix.size();
    NumberedFile file{0, entry.path().string()};
    if (!std::all_of(first, last, [](char c) { return c >= '0' && c <= '9'; })) continue;
    if (std::from_chars(first, last, file.number).ec != std::errc{}) continue;
    files.push_back(file);
  }
  std::sort(files.begin(), files.end(), [](const NumberedFile& a, const NumberedFile& b) {
    return a.number < b.number || (a.number == b.number && a.path < b.path);
  });
  return files;
}

}  // namespace poreshock
