#include "poreshock/output/morphology_file.hpp"

#include <filesystem>

#include "poreshock/core/parallel.hpp"
#include "poreshock/core/rank_zero.hpp"
#include "poreshock/files/block_hash.hpp"
#include "poreshock/files/hdf5_file.hpp"
#include "record_tables.hpp"

namespace poreshock {

namespace {

TableFormat format(MapPart part) {
  const bool strip = part == MapPart::strip;
  return {strip ? "strip" : "morphology",
          strip ? "strips.h5" : "morphology.h5",
          "threshold",
          {"pixel"}};
}

void check_length(const MorphologyRecord& record, const std::string& name, std::size_t found,
                  std::size_t expected, const char* of_what) {
  if (found == expected) return;
  throw SystemError("morphology of " + record.field + ": " + name + " has " +
                    std::to_string(found) + " values for " + std::to_string(expected) + " " +
                    of_what);
}

void add_curves(const MorphologyRecord& record, RecordTable& table) {
  const std::size_t width = record.threshold.size();
  for (const auto& [name, values] : record.counts) {
    check_length(record, name, values.size(), width, "thresholds");
    table.curves.series[name] = integer_series(values, width);
  }
  for (const auto& [name, values, unit] : record.functionals) {
    check_length(record, name, values.size(), width, "thresholds");
    table.curves.series[name] = {unit, width, false, {}, values};
  }
}

void add_spots(std::int64_t number, const MorphologyRecord& record, RecordTable& table) {
  if (record.spot_columns.empty()) return;
  table.things.records.assign(record.spots, number);
  for (const SpotColumn& column : record.spot_columns) {
    const std::size_t values = column.numbers.size() + column.integers.size();
    check_length(record, column.name, values, record.spots * column.width, "hot spots");
    const bool integer = column.kind == SpotColumn::Kind::integers;
    table.things.series[column.name] = {column.unit, column.width == 1 ? 0 : column.width, integer,
                                        column.integers, column.numbers};
  }
}

RecordTables make_tables(const RecordStamp& stamp, const std::vector<MorphologyRecord>& records) {
  RecordTables tables;
  for (const MorphologyRecord& record : records) {
    RecordTable& table = tables[record.field];
    table = one_record(stamp);
    table.axis_unit = record.unit;
    table.axis = record.threshold;
    table.curves.series["pixels"] = integer_series({record.pixels}, 0);
    if (record.low) table.curves.series["low"] = {"m", 0, false, {}, {*record.low}};
    add_curves(record, table);
    add_spots(stamp.record, record, table);
  }
  return tables;
}

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

std::string morphology_name(std::int64_t record, MapPart part) {
  return record_name(format(part), record);
}

void write_morphology(const std::string& path, const RecordStamp& stamp,
                      const std::vector<MorphologyRecord>& records, MPI_Comm communicator,
                      MapPart part) {
  on_rank_zero(communicator, [&] {
    write_tables(path, format(part), stamp, make_tables(stamp, records), Durable::later);
  });
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
  curves.scene = file.text("scene");
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
  on_rank_zero(communicator, [&] { remove_tables_from(folder, format(MapPart::domain), first); });
}

std::int64_t collect_morphology(const std::string& folder, MPI_Comm communicator, MapPart part) {
  std::int64_t merged = 0;
  on_rank_zero(communicator, [&] { merged = collect_tables(folder, format(part)); });
  check_mpi(MPI_Bcast(&merged, 1, MPI_INT64_T, 0, communicator), "MPI_Bcast");
  return merged;
}

}  // namespace poreshock
