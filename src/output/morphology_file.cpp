#include "poreshock/output/morphology_file.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include "morphology_tables.hpp"
#include "poreshock/output/block_hash.hpp"
#include "poreshock/output/hdf5_file.hpp"
#include "poreshock/output/posix_file.hpp"
#include "poreshock/output/rank_zero.hpp"

namespace poreshock {

namespace {

/// Throws when the file holds no thresholds of the field.
void require_field(const std::string& path, const std::vector<DatasetInfo>& datasets,
                   const std::string& field) {
  std::string known;
  for (const DatasetInfo& info : datasets) {
    if (!info.path.ends_with("/threshold") || info.path.find("/domains/") != std::string::npos) {
      continue;
    }
    const std::string name = info.path.substr(1, info.path.rfind('/') - 1);
    if (name == field) return;
    known.append(known.empty() ? "" : ", ").append(name);
  }
  throw InputError(path + ": holds no morphology of \"" + field + "\", allowed " +
                   (known.empty() ? "none, it is no file of morphology" : known));
}

}  // namespace

std::string morphology_name(std::int64_t record) {
  return numbered_name("morphology_", record, 6, ".h5");
}

void write_morphology(const std::string& path, const MorphologyStamp& stamp,
                      const std::vector<MorphologyRecord>& records, MPI_Comm communicator) {
  on_rank_zero(communicator, [&] { write_tables(path, stamp, make_tables(stamp, records)); });
}

MorphologyCurves read_morphology(const std::string& path, const std::string& field,
                                 MPI_Comm communicator) {
  std::string file_path = path;
  on_rank_zero(communicator, [&] {
    if (!std::filesystem::is_directory(path)) return;
    file_path = path + "/morphology.h5";
    if (std::filesystem::exists(file_path)) return;
    throw InputError(file_path +
                     ": not found; it is written at the end of a run that has a [morphology]");
  });
  broadcast(file_path, communicator);
  Hdf5File file = Hdf5File::open(file_path, communicator);
  const std::vector<DatasetInfo> datasets = file.datasets();
  require_field(file_path, datasets, field);
  verify(file_path, communicator);
  const std::string prefix = "/" + field + "/";
  MorphologyCurves curves;
  curves.unit = file.dataset(prefix + "threshold").unit;
  curves.pixel = file.number("pixel");
  curves.threshold = file.read_all<double>(prefix + "threshold");
  curves.time = file.read_all<double>(prefix + "time");
  const std::vector<std::uint64_t> shape = {curves.time.size(), curves.threshold.size()};
  for (const DatasetInfo& info : datasets) {
    const bool own = info.path.starts_with(prefix) && info.path.rfind('/') + 1 == prefix.size();
    if (!own || info.type != NumberType::float64 || info.shape != shape) continue;
    curves.functionals[info.path.substr(prefix.size())] = file.read_all<double>(info.path);
  }
  return curves;
}

void remove_morphology_from(const std::string& folder, std::int64_t first, MPI_Comm communicator) {
  on_rank_zero(communicator, [&] {
    const std::string path = folder + "/morphology.h5";
    if (!std::filesystem::exists(path)) return;
    MorphologyStamp stamp;
    const Tables all = read_tables(path, stamp);
    bool late = false;
    for (const auto& [field, table] : all) {
      late = late || (!table.records.empty() && table.records.back() >= first);
    }
    if (!late) return;
    Tables kept;
    append_tables(
        path, all, [&](std::int64_t record) { return record < first; }, kept);
    const FieldTable& table = kept.begin()->second;
    if (table.records.empty()) {
      remove_file(path);
      return;
    }
    stamp.record = table.records.back();
    stamp.step = table.series.at("step").integers.back();
    stamp.time = table.series.at("time").numbers.back();
    write_tables(path, stamp, kept);
  });
}

std::int64_t collect_morphology(const std::string& folder, MPI_Comm communicator) {
  std::int64_t merged = 0;
  on_rank_zero(communicator, [&] {
    const auto files = numbered_files(folder, "morphology_", 6, ".h5");
    if (files.empty()) return;
    std::set<std::int64_t> fresh;
    for (const NumberedFile& file : files) fresh.insert(file.number);
    Tables all;
    MorphologyStamp stamp;
    const std::string path = folder + "/morphology.h5";
    const auto old = [&](std::int64_t record) { return !fresh.contains(record); };
    if (std::filesystem::exists(path)) append_tables(path, read_tables(path, stamp), old, all);
    for (const NumberedFile& file : files) {
      append_tables(
          file.path, read_tables(file.path, stamp), [](std::int64_t) { return true; }, all);
    }
    sort_by_record(all);
    write_tables(path, stamp, all);
    for (const NumberedFile& file : files) remove_file(file.path);
    merged = static_cast<std::int64_t>(files.size());
  });
  check_mpi(MPI_Bcast(&merged, 1, MPI_INT64_T, 0, communicator), "MPI_Bcast");
  return merged;
}

}  // namespace poreshock
