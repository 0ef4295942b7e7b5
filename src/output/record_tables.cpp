#include "record_tables.hpp"

#include <algorithm>
#include <filesystem>
#include <numeric>
#include <set>

#include "poreshock/core/error.hpp"
#include "poreshock/files/block_hash.hpp"
#include "poreshock/files/hdf5_file.hpp"
#include "poreshock/files/posix_file.hpp"
#include "root_attributes.hpp"

namespace poreshock {

namespace {

const std::string thing_folder = "domains/";

std::string group_folder(const std::string& group) {
  return std::string("/").append(group).append("/");
}

std::vector<NumberedFile> record_files(const std::string& folder, const TableFormat& format) {
  return numbered_files(folder, format.kind + "_", 6, ".h5");
}

void declare(const std::string& folder, const Rows& rows, FileSpec& spec) {
  const std::uint64_t count = rows.records.size();
  spec.datasets.push_back({folder + "record", NumberType::int64, {count}, "1", {}});
  for (const auto& [name, series] : rows.series) {
    std::vector<std::uint64_t> shape = {count};
    if (series.width > 0) shape.push_back(series.width);
    const NumberType type = series.integer ? NumberType::int64 : NumberType::float64;
    spec.datasets.push_back({folder + name, type, shape, series.unit, {}});
  }
}

FileSpec file_spec(const TableFormat& format, const RecordStamp& stamp,
                   const RecordTables& tables) {
  FileSpec spec;
  spec.attributes = root_attributes(format.kind, stamp.time, stamp.step, stamp.scene_text);
  spec.attributes.push_back({"record", stamp.record});
  for (const std::string& name : format.numbers) {
    spec.attributes.push_back({name, stamp.numbers.at(name)});
  }
  for (const auto& [group, table] : tables) {
    const std::string folder = group_folder(group);
    declare(folder, table.curves, spec);
    if (!table.axis.empty()) {
      spec.datasets.push_back(
          {folder + format.axis, NumberType::float64, {table.axis.size()}, table.axis_unit, {}});
    }
    if (!table.things.series.empty()) declare(folder + thing_folder, table.things, spec);
  }
  return spec;
}

void write_rows(const std::string& folder, const Rows& rows, Hdf5File& file) {
  file.write<std::int64_t>(folder + "record", 0, rows.records);
  for (const auto& [name, series] : rows.series) {
    if (series.integer) {
      file.write<std::int64_t>(folder + name, 0, series.integers);
    } else {
      file.write<double>(folder + name, 0, series.numbers);
    }
  }
}

Series read_series(const DatasetInfo& info, Hdf5File& file) {
  Series series{info.unit, info.shape.size() > 1 ? info.shape[1] : 0,
                info.type == NumberType::int64};
  if (series.integer) {
    series.integers = file.read_all<std::int64_t>(info.path);
  } else {
    series.numbers = file.read_all<double>(info.path);
  }
  return series;
}

void read_into(const DatasetInfo& info, const std::string& name, Hdf5File& file, Rows& rows) {
  if (name == "record") {
    rows.records = file.read_all<std::int64_t>(info.path);
  } else {
    rows.series[name] = read_series(info, file);
  }
}

RecordTables read_tables(const std::string& path, const TableFormat& format, RecordStamp& stamp) {
  verify(path, MPI_COMM_SELF);
  Hdf5File file = Hdf5File::open(path, MPI_COMM_SELF);
  stamp = {file.integer("record"), file.integer("step"), file.number("time"), file.text("scene")};
  for (const std::string& name : format.numbers) stamp.numbers[name] = file.number(name);
  RecordTables tables;
  for (const DatasetInfo& info : file.datasets()) {
    const std::size_t slash = info.path.find('/', 1);
    if (slash == std::string::npos) continue;
    RecordTable& table = tables[info.path.substr(1, slash - 1)];
    const std::string name = info.path.substr(slash + 1);
    if (name == format.axis) {
      table.axis_unit = info.unit;
      table.axis = file.read_all<double>(info.path);
    } else if (name.starts_with(thing_folder)) {
      read_into(info, name.substr(thing_folder.size()), file, table.things);
    } else {
      read_into(info, name, file, table.curves);
    }
  }
  return tables;
}

template <class T>
void append_row(const std::vector<T>& from, std::size_t row, std::uint64_t width,
                std::vector<T>& to) {
  if (from.empty()) return;
  const auto count = static_cast<std::ptrdiff_t>(std::max<std::uint64_t>(1, width));
  const auto first = from.begin() + static_cast<std::ptrdiff_t>(row) * count;
  to.insert(to.end(), first, first + count);
}

void append_row(const Rows& from, std::size_t row, Rows& to) {
  to.records.push_back(from.records[row]);
  for (auto& [name, series] : to.series) {
    const Series& source = from.series.at(name);
    append_row(source.integers, row, source.width, series.integers);
    append_row(source.numbers, row, source.width, series.numbers);
  }
}

/// The same datasets without rows.
Rows emptied(const Rows& rows) {
  Rows result;
  for (const auto& [name, s] : rows.series) result.series[name] = {s.unit, s.width, s.integer};
  return result;
}

bool same_datasets(const Rows& a, const Rows& b) {
  return std::equal(a.series.begin(), a.series.end(), b.series.begin(), b.series.end(),
                    [](const auto& x, const auto& y) {
                      return x.first == y.first && x.second.width == y.second.width &&
                             x.second.integer == y.second.integer;
                    });
}

void append_rows(const Rows& from, const std::set<std::int64_t>& skip, Rows& to) {
  for (std::size_t row = 0; row < from.records.size(); ++row) {
    if (!skip.contains(from.records[row])) append_row(from, row, to);
  }
}

bool same_columns(const RecordTable& a, const RecordTable& b) {
  return a.axis == b.axis && a.axis_unit == b.axis_unit && same_datasets(a.curves, b.curves) &&
         same_datasets(a.things, b.things);
}

/// Appends the rows of one file whose record is not in `skip`.
void append_tables(const std::string& path, const TableFormat& format, const RecordTables& from,
                   const std::set<std::int64_t>& skip, RecordTables& to) {
  for (const auto& [group, source] : from) {
    if (!to.contains(group)) {
      to[group] = {source.axis_unit, source.axis, emptied(source.curves), emptied(source.things)};
    }
    RecordTable& table = to[group];
    if (!same_columns(table, source)) {
      throw InputError(path + ": cannot be merged, the " + format.axis + "s or curves of " + group +
                       " differ from those of the earlier records; move it away");
    }
    append_rows(source.curves, skip, table.curves);
    append_rows(source.things, skip, table.things);
  }
}

/// Puts rows into the order of their records.
void sort_by_record(Rows& rows) {
  std::vector<std::size_t> order(rows.records.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return rows.records[a] < rows.records[b]; });
  Rows sorted = emptied(rows);
  for (const std::size_t row : order) append_row(rows, row, sorted);
  rows = std::move(sorted);
}

}  // namespace

Series integer_series(std::vector<std::int64_t> values, std::uint64_t width) {
  return {"1", width, true, std::move(values), {}};
}

RecordTable one_record(const RecordStamp& stamp) {
  RecordTable table;
  table.curves.records = {stamp.record};
  table.curves.series["time"] = {"s", 0, false, {}, {stamp.time}};
  table.curves.series["step"] = integer_series({stamp.step}, 0);
  return table;
}

std::string record_name(const TableFormat& format, std::int64_t record) {
  return numbered_name(format.kind + "_", record, 6, ".h5");
}

void write_tables(const std::string& path, const TableFormat& format, const RecordStamp& stamp,
                  const RecordTables& tables, Durable durable) {
  Hdf5File file = Hdf5File::create(path, file_spec(format, stamp, tables), MPI_COMM_SELF,
                                   Replace::yes, durable);
  for (const auto& [group, table] : tables) {
    const std::string folder = group_folder(group);
    write_rows(folder, table.curves, file);
    if (!table.axis.empty()) file.write<double>(folder + format.axis, 0, table.axis);
    if (!table.things.series.empty()) write_rows(folder + thing_folder, table.things, file);
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
    const std::vector<std::int64_t>& records = table.curves.records;
    late.insert(std::lower_bound(records.begin(), records.end(), first), records.end());
  }
  if (late.empty()) return;
  RecordTables kept;
  append_tables(path, format, all, late, kept);
  const Rows& table = kept.begin()->second.curves;
  if (table.records.empty()) {
    remove_file(path);
    return;
  }
  stamp.record = table.records.back();
  stamp.step = table.series.at("step").integers.back();
  stamp.time = table.series.at("time").numbers.back();
  write_tables(path, format, stamp, kept, Durable::now);
}

void require_same_tables(const std::string& folder, const TableFormat& format,
                         const RecordTables& now) {
  std::vector<std::string> paths = {folder + "/" + format.whole};
  for (const NumberedFile& file : record_files(folder, format)) paths.push_back(file.path);
  for (const std::string& path : paths) {
    if (!std::filesystem::exists(path)) continue;
    RecordStamp stamp;
    const RecordTables there = read_tables(path, format, stamp);
    const bool same = std::equal(now.begin(), now.end(), there.begin(), there.end(),
                                 [](const auto& a, const auto& b) {
                                   return a.first == b.first && same_columns(a.second, b.second);
                                 });
    if (same) continue;
    throw InputError(path + ": its " + format.axis +
                     "s or curves are not those that this program writes for this scene; go on "
                     "with the program that wrote it, or leave it as it is and go on in another "
                     "folder with --output DIR --restart CHECKPOINT");
  }
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
  for (auto& [group, table] : all) {
    sort_by_record(table.curves);
    sort_by_record(table.things);
  }
  write_tables(path, format, stamp, all, Durable::now);
  for (const NumberedFile& file : files) remove_file(file.path);
  return static_cast<std::int64_t>(files.size());
}

}  // namespace poreshock
