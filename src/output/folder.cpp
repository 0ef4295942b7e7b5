#include "poreshock/output/folder.hpp"

#include <fcntl.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <string_view>

#include "poreshock/output/posix_file.hpp"
#include "poreshock/output/rank_zero.hpp"

namespace poreshock {

namespace fs = std::filesystem;

namespace {

constexpr std::array<std::string_view, 9> own_names = {
    "scene.toml",  "history.csv",  "snapshots.xdmf", "maps.xdmf",  "morphology.h5",
    "profiles.h5", "timings.json", "failed.h5",      "report.html"};

struct SeriesName {
  std::string_view prefix;
  int digits;
};
constexpr std::array<SeriesName, 4> own_series = {
    {{"snapshot_", 6}, {"morphology_", 6}, {"profile_", 6}, {"checkpoint_", 9}}};

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
}

void check_writable(const std::string& folder) {
  const std::string probe = folder + "/.poreshock_probe";
  try {
    FileDescriptor(probe, O_WRONLY | O_CREAT | O_TRUNC).sync();
    remove_file(probe);
  } catch (const SystemError& failure) {
    throw InputError("output folder " + folder + ": not writable: " + failure.what());
  }
}

/// True when the folder exists and may be used; throws when it may not.
bool usable(const std::string& path, bool force, bool restart) {
  std::error_code error;
  const bool exists = fs::exists(fs::symlink_status(path, error));
  if (exists && !fs::is_directory(path, error)) {
    throw InputError("output folder " + path + ": exists and is not a folder; choose another name");
  }
  if (exists && !force && !restart) {
    throw InputError("output folder " + path +
                     ": exists already; choose another with --output, overwrite it with --force, "
                     "or go on from a checkpoint in it with --restart latest");
  }
  return exists;
}

void prepare(const std::string& path, bool force, bool restart) {
  std::error_code error;
  if (!usable(path, force, restart)) {
    fs::create_directories(path, error);
    if (error) throw InputError("output folder " + path + ": cannot be made: " + error.message());
  }
  check_writable(path);
  for_each_own_file(path, ".part", remove_file);
  if (!force || restart) return;
  for_each_own_file(path, "", remove_file);
  fs::remove_all(path + "/pictures", error);
  if (error) throw SystemError("cannot remove " + path + "/pictures: " + error.message());
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

void prepare_output_folder(const std::string& path, bool force, bool restart,
                           MPI_Comm communicator) {
  on_rank_zero(communicator, [&] { prepare(path, force, restart); });
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
    sync_folder(folder);
  });
}

}  // namespace poreshock
