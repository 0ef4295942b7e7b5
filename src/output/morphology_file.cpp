#include "poreshock/output/morphology_file.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <set>

#include "poreshock/output/block_hash.hpp"
#include "poreshock/output/hdf5_file.hpp"
#include "poreshock/output/posix_file.hpp"
#include "poreshock/output/rank_zero.hpp"
#include "root_attributes.hpp"

namespace poreshock {

namespace {

/// One dataset of a field whose first dimension is time: one row (or number) per record.
struct Series {
  std::string unit;
  std::uint64_t width = 0;  ///< 0 for one number per record, else thresholds
  bool integer = false;
  std::vector<std::int64_t> integers;
  std::vector<double> numbers;
};

/// All records of one field.
struct FieldTable {
  std::string unit;
  std::vector<double> threshold;
  std::vector<std::int64_t> records;
  std::map<std::string, Series> series;  ///< time, step, pixels, counts, functionals
};

using Tables = std::map<std::string, FieldTable>;

Series integer_series(std::vector<std::int64_t> values, std::uint64_t width) {
  return {"1", width, true, std::move(values), {}};
}

Tables make_tables(const MorphologyStamp& stamp, const std::vector<MorphologyRecord>& records) {
  Tables tables;
  for (const MorphologyRecord& record : records) {
    FieldTable& table = tables[record.field];
    const std::size_t width = record.threshold.size();
    table.unit = record.unit;
    table.threshold = record.threshold;
    table.records = {stamp.record};
    table.series["time"] = {"s", 0, false, {}, {stamp.time}};
    table.series["step"] = integer_series({stamp.step}, 0);
    table.series["pixels"] = integer_series({record.pixels}, 0);
    const auto check = [&](const std::string& name, std::size_t size) {
      if (size == width) return;
      throw SystemError("morphology of " + record.field + ": " + name + " has " +
                        std::to_string(size) + " values for " + std::to_string(width) +
                        " thresholds");
    };
    for (const auto& [name, values] : record.counts) {
      check(name, values.size());
      table.series[name] = integer_series(values, width);
    }
    for (const auto& [name, values] : record.functionals) {
      check(name, values.size());
      table.series[name] = {"1", width, false, {}, values};
    }
  }
  return tables;
}

/// Writes tables to a file of one rank.
void write_tables(const std::string& path, const std::string& kind, const MorphologyStamp& stamp,
                  const Tables& tables) {
  FileSpec spec;
  spec.attributes = root_attributes(kind, stamp.time, stamp.step, stamp.scene_text);
  spec.attributes.push_back({"record", stamp.record});
  for (const auto& [field, table] : tables) {
    const std::string folder = "/" + field + "/";
    const std::uint64_t rows = table.records.size();
    spec.datasets.push_back({folder + "record", NumberType::int64, {rows}, "1", {}});
    spec.datasets.push_back(
        {folder + "threshold", NumberType::float64, {table.threshold.size()}, table.unit, {}});
    for (const auto& [name, series] : table.series) {
      std::vector<std::uint64_t> shape = {rows};
      if (series.width > 0) shape.push_back(series.width);
      spec.datasets.push_back({folder + name,
                               series.integer ? NumberType::int64 : NumberType::float64,
                               shape,
                               series.unit,
                               {}});
    }
  }
  Hdf5File file = Hdf5File::create(path, spec, MPI_COMM_SELF, Replace::yes);
  for (const auto& [field, table] : tables) {
    const std::string folder = "/" + field + "/";
    file.write<std::int64_t>(folder + "record", 0, table.records);
    file.write<double>(folder + "threshold", 0, table.threshold);
    for (const auto& [name, series] : table.series) {
      if (series.integer) {
        file.write<std::int64_t>(folder + name, 0, series.integers);
      } else {
        file.write<double>(folder + name, 0, series.numbers);
      }
    }
  }
  file.finish();
}

Tables read_tables(const std::string& path, MorphologyStamp& stamp) {
  verify(path, MPI_COMM_SELF);
  Hdf5File file = Hdf5File::open(path, MPI_COMM_SELF);
  stamp = {file.integer("record"), file.integer("step"), file.number("time"), file.text("scene")};
  Tables tables;
  for (const DatasetInfo& info : file.datasets()) {
    const std::size_t slash = info.path.find('/', 1);
    if (slash == std::string::npos) continue;
    FieldTable& table = tables[info.path.substr(1, slash - 1)];
    const std::string name = info.path.substr(slash + 1);
    if (name == "threshold") {
      table.unit = info.unit;
      table.threshold = file.read_all<double>(info.path);
    } else if (name == "record") {
      table.records = file.read_all<std::int64_t>(info.path);
    } else {
      Series series{info.unit,
                    info.shape.size() > 1 ? info.shape[1] : 0,
                    info.type == NumberType::int64,
                    {},
                    {}};
      if (series.integer) {
        series.integers = file.read_all<std::int64_t>(info.path);
      } else {
        series.numbers = file.read_all<double>(info.path);
      }
      table.series[name] = std::move(series);
    }
  }
  return tables;
}

template <class T>
void append_row(const std::vector<T>& from, std::size_t row, std::uint64_t width,
                std::vector<T>& to) {
  const auto count = static_cast<std::ptrdiff_t>(std::max<std::uint64_t>(1, width));
  const auto first = from.begin() + static_cast<std::ptrdiff_t>(row) * count;
  if (from.empty()) return;
  to.insert(to.end(), first, first + count);
}

/// Appends the rows of one file whose record is not in `skip`.
void append_tables(const std::string& path, const Tables& from, const std::set<std::int64_t>& skip,
                   Tables& to) {
  for (const auto& [field, source] : from) {
    const bool fresh = !to.contains(field);
    FieldTable& table = to[field];
    if (fresh) {
      table.unit = source.unit;
      table.threshold = source.threshold;
      for (const auto& [name, s] : source.series) {
        table.series[name] = {s.unit, s.width, s.integer, {}, {}};
      }
    }
    const bool same_curves =
        table.series.size() == source.series.size() &&
        std::all_of(source.series.begin(), source.series.end(), [&](const auto& entry) {
          const auto found = table.series.find(entry.first);
          return found != table.series.end() && found->second.width == entry.second.width &&
                 found->second.integer == entry.second.integer;
        });
    if (table.threshold != source.threshold || table.unit != source.unit || !same_curves) {
      throw InputError(path + ": cannot be merged, the thresholds or curves of " + field +
                       " differ from those of the earlier records; move it away");
    }
    for (std::size_t row = 0; row < source.records.size(); ++row) {
      if (skip.contains(source.records[row])) continue;
      table.records.push_back(source.records[row]);
      for (auto& [name, series] : table.series) {
        const Series& s = source.series.at(name);
        append_row(s.integers, row, s.width, series.integers);
        append_row(s.numbers, row, s.width, series.numbers);
      }
    }
  }
}

/// Puts the rows of all tables into the order of their records.
void sort_by_record(Tables& tables) {
  for (auto& [field, table] : tables) {
    std::vector<std::size_t> order(table.records.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(),
              [&](std::size_t a, std::size_t b) { return table.records[a] < table.records[b]; });
    FieldTable sorted = table;
    sorted.records.clear();
    for (auto& [name, series] : sorted.series) {
      series.integers.clear();
      series.numbers.clear();
    }
    for (const std::size_t row : order) {
      sorted.records.push_back(table.records[row]);
      for (auto& [name, series] : sorted.series) {
        const Series& s = table.series.at(name);
        append_row(s.integers, row, s.width, series.integers);
        append_row(s.numbers, row, s.width, series.numbers);
      }
    }
    table = std::move(sorted);
  }
}

}  // namespace

std::string morphology_name(std::int64_t record) {
  return numbered_name("morphology_", record, 6, ".h5");
}

void write_morphology(const std::string& path, const MorphologyStamp& stamp,
                      const std::vector<MorphologyRecord>& records, MPI_Comm communicator) {
  on_rank_zero(communicator,
               [&] { write_tables(path, "morphology", stamp, make_tables(stamp, records)); });
}

void remove_morphology_from(const std::string& folder, std::int64_t first, MPI_Comm communicator) {
  on_rank_zero(communicator, [&] {
    const std::string path = folder + "/morphology.h5";
    if (!std::filesystem::exists(path)) return;
    MorphologyStamp stamp;
    const Tables all = read_tables(path, stamp);
    std::set<std::int64_t> late;
    for (const auto& [field, table] : all) {
      late.insert(std::lower_bound(table.records.begin(), table.records.end(), first),
                  table.records.end());
    }
    if (late.empty()) return;
    Tables kept;
    append_tables(path, all, late, kept);
    const FieldTable& table = kept.begin()->second;
    if (table.records.empty()) {
      remove_file(path);
      return;
    }
    stamp.record = table.records.back();
    stamp.step = table.series.at("step").integers.back();
    stamp.time = table.series.at("time").numbers.back();
    write_tables(path, "morphology", stamp, kept);
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
    if (std::filesystem::exists(path)) append_tables(path, read_tables(path, stamp), fresh, all);
    for (const NumberedFile& file : files) {
      append_tables(file.path, read_tables(file.path, stamp), {}, all);
    }
    sort_by_record(all);
    write_tables(path, "morphology", stamp, all);
    for (const NumberedFile& file : files) remove_file(file.path);
    merged = static_cast<std::int64_t>(files.size());
  });
  check_mpi(MPI_Bcast(&merged, 1, MPI_INT64_T, 0, communicator), "MPI_Bcast");
  return merged;
}

}  // namespace poreshock
