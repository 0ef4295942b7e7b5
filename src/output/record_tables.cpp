#include "record_tables.hpp"

#include <algorithm>
#include <filesystem>
#include <set>

#include "poreshock/core/error.hpp"
#include "poreshock/output/block_hash.hpp"
#include "poreshock/output/hdf5_file.hpp"
#include "poreshock/output/posix_file.hpp"
#include "root_attributes.hpp"

namespace poreshock {

namespace {

std::string group_folder(const std::string& group) {
  return std::string("/").append(group).append("/");
}

std::vector<NumberedFile> record_files(const std::string& folder, const TableFormat& format) {
  return numbered_files(folder, format.kind + "_", 6, ".h5");
}

FileSpec file_spec(const TableFormat& format, const RecordStamp& stamp,
                   const RecordTables& tables) {
  FileSpec spec;
  spec.attributes = root_attributes(format.kind, stamp.time, stamp.step, stamp.scene_text);
  spec.attributes.push_back({"record", stamp.record});
  for (const auto& [group, table] : tables) {
    const std::string folder = group_folder(group);
    const std::uint64_t rows = table.records.size();
    spec.datasets.push_back({folder + "record", NumberType::int64, {rows}, "1", {}});
    if (!table.axis.empty()) {
      spec.datasets.push_back(
          {folder + format.axis, NumberType::float64, {table.axis.size()}, table.axis_unit, {}});
    }
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
  return spec;
}

Series read_series(Hdf5File& file, const DatasetInfo& info) {
  Series series{
      info.unit, info.shape.size() > 1 ? info.shape[1] : 0, info.type == NumberType::int64, {}, {}};
  if (series.integer) {
    series.integers = file.read_all<std::int64_t>(info.path);
  } else {
    series.numbers = file.read_all<double>(info.path);
  }
  return series;
}

RecordTables read_tables(const std::string& path, const TableFormat& format, RecordStamp& stamp) {
  verify(path, MPI_COMM_SELF);
  Hdf5File file = Hdf5File::open(path, MPI_COMM_SELF);
  stamp = {file.integer("record"), file.integer("step"), file.number("time"), file.text("scene")};
  RecordTables tables;
  for (const DatasetInfo& info : file.datasets()) {
    const std::size_t slash = info.path.find('/', 1);
    if (slash == std::string::npos) continue;
    RecordTable& table = tables[info.path.substr(1, slash - 1)];
    const std::string name = info.path.substr(slash + 1);
    if (name == format.axis) {
      table.axis_unit = info.unit;
      table.axis = file.read_all<double>(info.path);
    } else if (name == "record") {
      table.records = file.read_all<std::int64_t>(info.path);
    } else {
      table.series[name] = read_series(file, info);
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

void append_record(const RecordTable& from, std::size_t row, RecordTable& to) {
  to.records.push_back(from.records[row]);
  for (auto& [name, series] : to.series) {
    const Series& s = from.series.at(name);
    append_row(s.integers, row, s.width, series.integers);
    append_row(s.numbers, row, s.width, series.numbers);
  }
}

/// The table without its records.
RecordTable empty_like(const RecordTable& source) {
  RecordTable table = {source.axis_unit, source.axis, {}, {}};
  for (const auto& [name, s] : source.series) {
    table.series[name] = {s.unit, s.width, s.integer, {}, {}};
  }
  return table;
}

bool same_series(const RecordTable& a, const RecordTable& b) {
  return a.series.size() == b.series.size() &&
         std::all_of(b.series.begin(), b.series.end(), [&](const auto& entry) {
           const auto found = a.series.find(entry.first);
           return found != a.series.end() && found->second.width == entry.second.width &&
                  found->second.integer == entry.second.integer;
         });
}

/// Appends the rows of one file whose record is not in `skip`.
void append_tables(const std::string& path, const TableFormat& format, const RecordTables& from,
                   const std::set<std::int64_t>& skip, RecordTables& to) {
  for (const auto& [group, source] : from) {
    if (!to.contains(group)) to[group] = empty_like(source);
    RecordTable& table = to[group];
    if (table.axis != source.axis || table.axis_unit != source.axis_unit ||
        !same_series(table, source)) {
      throw InputError(path + ": cannot be merged, the " + format.axis + "s or curves of " + group +
                       " differ from those of the earlier records; move it away");
    }
    for (std::size_t row = 0; row < source.records.size(); ++row) {
      if (!skip.contains(source.records[row])) append_record(source, row, table);
    }
  }
}

/// Puts the rows of all tables into the order of their records.
void sort_by_record(RecordTables& tables) {
  for (auto& [group, table] : tables) {
    std::vector<std::size_t> order(table.records.size());
    for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
    std::sort(order.begin(), order.end(), [&records = table.records](std::size_t a, std::size_t b) {
      return records[a] < records[b];
    });
    RecordTable sorted = empty_like(table);
    for (const std::size_t row : order) append_record(table, row, sorted);
    table = std::move(sorted);
  }
}

}  // namespace

Series integer_series(std::vector<std::int64_t> values, std::uint64_t width) {
  return {"1", width, true, std::move(values), {}};
}

RecordTable one_record(const RecordStamp& stamp) {
  RecordTable table;
  table.records = {stamp.record};
  table.series["time"] = {"s", 0, false, {}, {stamp.time}};
  table.series["step"] = integer_series({stamp.step}, 0);
  return table;
}

std::string record_name(const TableFormat& format, std::int64_t record) {
  return numbered_name(format.kind + "_", record, 6, ".h5");
}

void write_tables(const std::string& path, const TableFormat& format, const RecordStamp& stamp,
                  const RecordTables& tables) {
  Hdf5File file =
      Hdf5File::create(path, file_spec(format, stamp, tables), MPI_COMM_SELF, Replace::yes);
  for (const auto& [group, table] : tables) {
    const std::string folder = group_folder(group);
    file.write<std::int64_t>(folder + "record", 0, table.records);
    if (!table.axis.empty()) file.write<double>(folder + format.axis, 0, table.axis);
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

void remove_tables_from(const std::string& folder, const TableFormat& format, std::int64_t first) {
  const std::string path = folder + "/" + format.whole;
  if (!std::filesystem::exists(path)) return;
  RecordStamp stamp;
  const RecordTables all = read_tables(path, format, stamp);
  std::set<std::int64_t> late;
  for (const auto& [group, table] : all) {
    late.insert(std::lower_bound(table.records.begin(), table.records.end(), first),
                table.records.end());
  }
  if (late.empty()) return;
  RecordTables kept;
  append_tables(path, format, all, late, kept);
  const RecordTable& table = kept.begin()->second;
  if (table.records.empty()) {
    remove_file(path);
    return;
  }
  stamp.record = table.records.back();
  stamp.step = table.series.at("step").integers.back();
  stamp.time = table.series.at("time").numbers.back();
  write_tables(path, format, stamp, kept);
}

std::int64_t collect_tables(const std::string& folder, const TableFormat& format) {
  const std::vector<NumberedFile> files = record_files(folder, format);
  if (files.empty()) return 0;
  std::set<std::int64_t> fresh;
  for (const NumberedFile& file : files) fresh.insert(file.number);
  RecordTables all;
  RecordStamp stamp;
  const std::string path = folder + "/" + format.whole;
  if (std::filesystem::exists(path)) {
    append_tables(path, format, read_tables(path, format, stamp), fresh, all);
  }
  for (const NumberedFile& file : files) {
    append_tables(file.path, format, read_tables(file.path, format, stamp), {}, all);
  }
  sort_by_record(all);
  write_tables(path, format, stamp, all);
  for (const NumberedFile& file : files) remove_file(file.path);
  return static_cast<std::int64_t>(files.size());
}

}  // namespace poreshock
