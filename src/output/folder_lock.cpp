#include "poreshock/output/folder_lock.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <sstream>
#include <vector>

#include "poreshock/core/error.hpp"

namespace poreshock {

namespace {

/// Who holds a folder. A process id comes again, so that ticks and boot tell its start apart.
struct Holder {
  std::string host, process, started, ticks, boot;
};

std::string host_name() {
  std::array<char, 256> name{};
  gethostname(name.data(), name.size() - 1);
  return name.data();
}

std::string boot_name() {
  std::string name;
  std::getline(std::ifstream("/proc/sys/kernel/random/boot_id"), name);
  return name;
}

/// When a process began, in ticks since the boot; empty when there is none or it has ended.
std::string start_ticks(const std::string& process) {
  std::string text;
  std::getline(std::ifstream("/proc/" + process + "/stat"), text);
  const std::size_t name_end = text.rfind(')');  // the name may hold anything
  if (name_end == std::string::npos) return "";
  std::istringstream fields(text.substr(name_end + 1));
  constexpr int state = 3, start = 22;
  std::string field;
  for (int number = state; number <= start; ++number) {
    fields >> field;
    if (number == state && (field == "Z" || field == "X")) return "";
  }
  return field;
}

Holder this_process() {
  Holder me;
  me.host = host_name();
  me.process = std::to_string(getpid());
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  std::array<char, 64> text{};
  std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M:%S UTC", &utc);
  me.started = text.data();
  me.ticks = start_ticks(me.process);
  me.boot = boot_name();
  return me;
}

std::string written(const Holder& h) {
  return "host " + h.host + "\nprocess " + h.process + "\nstarted " + h.started + "\nticks " +
         h.ticks + "\nboot " + h.boot + "\n";
}

Holder read_holder(const std::string& path) {
  Holder holder;
  std::ifstream file(path);
  std::string key;
  while (file >> key) {
    std::string value;
    std::getline(file >> std::ws, value);
    for (const auto& [name, member] :
         {std::pair("host", &holder.host), std::pair("process", &holder.process),
          std::pair("started", &holder.started), std::pair("ticks", &holder.ticks),
          std::pair("boot", &holder.boot)}) {
      if (key == name) *member = value;
    }
  }
  return holder;
}

std::string described(const Holder& h) {
  const auto known = [](const std::string& text) { return text.empty() ? "unknown" : text; };
  return "a run on host " + known(h.host) + ", process " + known(h.process) + ", started " +
         known(h.started);
}

enum class Use { none, stale, held, unknown };

/// What the lock file says and does. A file system without flock leaves what it says.
Use use_of(const std::string& path, const Holder& holder) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return errno == ENOENT ? Use::none : Use::unknown;
  const bool held = flock(descriptor, LOCK_SH | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  ::close(descriptor);
  if (held) return Use::held;
  if (holder.host != host_name() || holder.process.empty()) return Use::unknown;
  if (holder.boot != boot_name()) return Use::stale;
  const std::string ticks = start_ticks(holder.process);
  return ticks.empty() || ticks != holder.ticks ? Use::stale : Use::held;
}

/// How the lock of a folder is used; throws when the folder may not be.
Use checked_use(const std::string& folder, const std::string& path, const Holder& holder) {
  const Use use = use_of(path, holder);
  const std::string who = "output folder " + folder + ": in use by " + described(holder);
  if (use == Use::held) {
    throw InputError(who + " (" + path +
                     "); wait for its end, or choose another folder with --output");
  }
  if (use == Use::unknown) {
    throw InputError(who + ", which cannot be asked from host " + host_name() +
                     "; wait for its end, or choose another folder with --output. If it is no "
                     "more, remove its lock with: rm " +
                     path);
  }
  return use;
}

}  // namespace

void require_unlocked(const std::string& folder) {
  const std::string path = folder + "/" + folder_lock_name;
  checked_use(folder, path, read_holder(path));
}

FolderLock::FolderLock(const std::string& folder) : path_(folder + "/" + folder_lock_name) {
  const Holder before = read_holder(path_);
  if (checked_use(folder, path_, before) == Use::stale) {
    std::fprintf(stderr, "warning: the lock of %s, which is no more, is removed (%s)\n",
                 described(before).c_str(), path_.c_str());
    remove_file(path_);
  }
  try {
    file_ = std::make_unique<FileDescriptor>(path_, O_WRONLY | O_CREAT | O_EXCL);
  } catch (const SystemError&) {
    require_unlocked(folder);  // another run was faster
    throw;
  }
  flock(file_->get(), LOCK_EX | LOCK_NB);
  try {
    const std::string text = written(this_process());
    file_->write(0, reinterpret_cast<const std::byte*>(text.data()), text.size());
    file_->sync();
  } catch (...) {
    unlink(path_.c_str());
    throw;
  }
}

FolderLock::~FolderLock() {
  // One that was removed meanwhile may have become another run's.
  if (file_ && file_->is_at(path_)) unlink(path_.c_str());
}

}  // namespace poreshock
