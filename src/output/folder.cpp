#include "poreshock/output/folder.hpp"

#include <fcntl.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "poreshock/core/rank_zero.hpp"
#include "poreshock/files/posix_file.hpp"
#include "poreshock/scene/read_scene.hpp"

namespace poreshock {

namespace fs = std::filesystem;

namespace {

constexpr std::array<std::string_view, 11> own_names = {
    "scene.toml",  "history.csv", "snapshots.xdmf", "maps.xdmf", "morphology.h5", "strips.h5",
    "profiles.h5", "probes.h5",   "timings.json",   "failed.h5", "report.html"};

struct SeriesName {
  std::string_view prefix;
  int digits;
};
constexpr std::array<SeriesName, 6> own_series = {{{"snapshot_", 6},
                                                   {"morphology_", 6},
                                                   {"profile_", 6},
                                                   {"handed_over_", 6},
                                                   {"strip_", 6},
                                                   {"checkpoint_", 9}}};

/// Calls visit(path) for every name a file of ours has, with `ending` added to it.
template <class Visit>
void for_each_own_file(const std::string& folder, const std::string& ending, Visit&& visit) {
  for (const std::string_view name : own_names) {
    visit(std::string(folder).append("/").append(name).append(ending));
  }
  for (const SeriesName& series : own_series) {
    for (const NumberedFile& file :
         numbered_files(folder, series.prefix, series.digits, ".h5" + ending)) {
      visit(file.path);
    }
  }
  // First a list: visit may remove files.
  std::vector<std::string> traces;
  for (const auto& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with("probe_") && name.ends_with(".csv" + ending)) {
      traces.push_back(entry.path().string());
    }
  }
  for (const std::string& path : traces) visit(path);
}

/// True for a scene.toml that a run has written, or for none; another one is the user's.
bool has_own_scene(const std::string& folder) {
  const std::string path = folder + "/scene.toml";
  std::error_code error;
  return !fs::exists(path, error) || read_text(path).starts_with(resolved_scene_mark);
}

bool holds_nothing(const std::string& folder) {
  return std::all_of(fs::directory_iterator(folder), fs::directory_iterator(),
                     [](const auto& entry) { return entry.path().filename() == folder_lock_name; });
}

/// True when the folder exists and may be used; throws when it may not.
bool usable(const std::string& path, bool force, bool restart) {
  std::error_code error;
  const std::string folder = "output folder " + path + ": ";
  if (!fs::exists(fs::symlink_status(path, error))) return false;
  if (!fs::is_directory(path, error)) {
    throw InputError(folder + "exists and is not a folder; choose another name");
  }
  require_unlocked(path);
  if (!has_own_scene(path)) {
    throw InputError(folder +
                     "its scene.toml was not written by a run, which would put its own in the "
                     "place; choose another folder with --output, or rename that file");
  }
  if (!force && !restart && !holds_nothing(path)) {
    throw InputError(folder +
                     "exists already; choose another with --output, overwrite it with --force, "
                     "or go on from a checkpoint in it with --restart latest");
  }
  return true;
}

std::unique_ptr<FolderLock> take(const std::string& path) {
  try {
    return std::make_unique<FolderLock>(path);
  } catch (const SystemError& failure) {
    throw InputError("output folder " + path + ": not writable: " + failure.what());
  }
}

std::unique_ptr<FolderLock> prepare(const std::string& path, bool force, bool restart) {
  std::error_code error;
  if (!usable(path, force, restart)) {
    fs::create_directories(path, error);
    if (error) throw InputError("output folder " + path + ": cannot be made: " + error.message());
  }
  std::unique_ptr<FolderLock> lock = take(path);
  for_each_own_file(path, ".part", remove_file);
  if (!force || restart) return lock;
  for_each_own_file(path, "", remove_file);
  fs::remove_all(path + "/pictures", error);
  if (error) throw SystemError("cannot remove " + path + "/pictures: " + error.message());
  return lock;
}

template <class Visit>
void for_each_record(const std::string& folder, Visit&& visit) {
  for (const std::string_view prefix : {"snapshot_", "morphology_", "profile_"}) {
    for (const NumberedFile& file : numbered_files(folder, prefix, 6, ".h5")) visit(file);
  }
}

}  // namespace

void require_output_folder(const std::string& path, bool force, bool restart,
                           MPI_Comm communicator) {
  on_rank_zero(communicator, [&] { usable(path, force, restart); });
}

std::unique_ptr<FolderLock> prepare_output_folder(const std::string& path, bool force, bool restart,
                                                  MPI_Comm communicator) {
  std::unique_ptr<FolderLock> lock;
  on_rank_zero(communicator, [&] { lock = prepare(path, force, restart); });
  return lock;
}

void remove_records_from(const std::string& folder, std::int64_t first, MPI_Comm communicator) {
  on_rank_zero(communicator, [&] {
    for_each_record(folder, [&](const NumberedFile& file) {
      if (file.number >= first) remove_file(file.path);
    });
  });
}

void sync_records(const std::string& folder, std::int64_t first, MPI_Comm communicator) {
  on_rank_zero(communicator, [&] {
    for_each_record(folder, [&](const NumberedFile& file) {
      if (file.number >= first) FileDescriptor(file.path, O_RDONLY).sync();
    });
    // Strips have numbers of their own, and are few.
    for (const std::string_view prefix : {"handed_over_", "strip_"}) {
      for (const NumberedFile& file : numbered_files(folder, prefix, 6, ".h5")) {
        FileDescriptor(file.path, O_RDONLY).sync();
      }
    }
    sync_folder(folder);
  });
}

}  // namespace poreshock
