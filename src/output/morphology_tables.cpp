#include "morphology_tables.hpp"

#include <algorithm>
#include <numeric>

#include "poreshock/core/error.hpp"
#include "poreshock/output/block_hash.hpp"
#include "poreshock/output/hdf5_file.hpp"
#include "root_attributes.hpp"

namespace poreshock {

namespace {

const std::string spot_folder = "domains/";

Series integer_series(std::vector<std::int64_t> values, std::uint64_t width) {
  return {"1", width, true, std::move(values), {}};
}

void check_length(const MorphologyRecord& record, const std::string& name, std::size_t found,
                  std::size_t expected, const char* of_what) {
  if (found == expected) return;
  throw SystemError("morphology of " + record.field + ": " + name + " has " +
                    std::to_string(found) + " values for " + std::to_string(expected) + " " +
                    of_what);
}

void add_curves(const MorphologyRecord& record, FieldTable& table) {
  const std::size_t width = record.threshold.size();
  for (const auto& [name, values] : record.counts) {
    check_length(record, name, values.size(), width, "thresholds");
    table.series[name] = integer_series(values, width);
  }
  for (const auto& [name, values] : record.functionals) {
    check_length(record, name, values.size(), width, "thresholds");
    table.series[name] = {"1", width, false, {}, values};
  }
}

void add_spots(std::int64_t number, const MorphologyRecord& record, FieldTable& table) {
  if (record.spot_columns.empty()) return;
  table.spot_records.assign(record.spots, number);
  for (const SpotColumn& column : record.spot_columns) {
    const std::size_t values = column.numbers.size() + column.integers.size();
    check_length(record, column.name, values, record.spots * column.width, "hot spots");
    const bool integer = column.kind == SpotColumn::Kind::integers;
    table.spots[column.name] = {column.unit, column.width == 1 ? 0 : column.width, integer,
                                column.integers, column.numbers};
  }
}

void declare(const std::string& folder, const SeriesByName& all, std::uint64_t rows,
             FileSpec& spec) {
  for (const auto& [name, series] : all) {
    std::vector<std::uint64_t> shape = {rows};
    if (series.width > 0) shape.push_back(series.width);
    spec.datasets.push_back({folder + name,
                             series.integer ? NumberType::int64 : NumberType::float64,
                             shape,
                             series.unit,
                             {}});
  }
}

void write_series(const std::string& folder, const SeriesByName& all, Hdf5File& file) {
  for (const auto& [name, series] : all) {
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

template <class T>
void append_row(const std::vector<T>& from, std::size_t row, std::uint64_t width,
                std::vector<T>& to) {
  const auto count = static_cast<std::ptrdiff_t>(std::max<std::uint64_t>(1, width));
  const auto first = from.begin() + static_cast<std::ptrdiff_t>(row) * count;
  if (from.empty()) return;
  to.insert(to.end(), first, first + count);
}

void append_rows(const SeriesByName& from, const std::vector<std::size_t>& rows, SeriesByName& to) {
  for (auto& [name, series] : to) {
    const Series& source = from.at(name);
    for (const std::size_t row : rows) {
      append_row(source.integers, row, source.width, series.integers);
      append_row(source.numbers, row, source.width, series.numbers);
    }
  }
}

/// The same datasets without rows.
SeriesByName emptied(const SeriesByName& all) {
  SeriesByName result;
  for (const auto& [name, s] : all) result[name] = {s.unit, s.width, s.integer};
  return result;
}

bool same_datasets(const SeriesByName& a, const SeriesByName& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const auto& x, const auto& y) {
    return x.first == y.first && x.second.width == y.second.width &&
           x.second.integer == y.second.integer;
  });
}

/// Appends rows with their records.
void append_listed(const SeriesByName& from, const std::vector<std::int64_t>& from_records,
                   const std::vector<std::size_t>& rows, SeriesByName& to,
                   std::vector<std::int64_t>& to_records) {
  for (const std::size_t row : rows) to_records.push_back(from_records[row]);
  append_rows(from, rows, to);
}

std::vector<std::size_t> rows_of(const std::vector<std::int64_t>& records,
                                 const std::function<bool(std::int64_t)>& keep) {
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < records.size(); ++row) {
    if (keep(records[row])) rows.push_back(row);
  }
  return rows;
}

void sort_rows(SeriesByName& all, std::vector<std::int64_t>& records) {
  std::vector<std::size_t> order(records.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return records[a] < records[b]; });
  SeriesByName sorted = emptied(all);
  std::vector<std::int64_t> sorted_records;
  append_listed(all, records, order, sorted, sorted_records);
  all = std::move(sorted);
  records = std::move(sorted_records);
}

}  // namespace

Tables make_tables(const MorphologyStamp& stamp, const std::vector<MorphologyRecord>& records) {
  Tables tables;
  for (const MorphologyRecord& record : records) {
    FieldTable& table = tables[record.field];
    table.unit = record.unit;
    table.threshold = record.threshold;
    table.records = {stamp.record};
    table.series["time"] = {"s", 0, false, {}, {stamp.time}};
    table.series["step"] = integer_series({stamp.step}, 0);
    table.series["pixels"] = integer_series({record.pixels}, 0);
    add_curves(record, table);
    add_spots(stamp.record, record, table);
  }
  return tables;
}

void write_tables(const std::string& path, const MorphologyStamp& stamp, const Tables& tables) {
  FileSpec spec;
  spec.attributes = root_attributes("morphology", stamp.time, stamp.step, stamp.scene_text);
  spec.attributes.push_back({"record", stamp.record});
  spec.attributes.push_back({"pixel", stamp.pixel});
  for (const auto& [field, table] : tables) {
    const std::string folder = "/" + field + "/";
    const std::uint64_t rows = table.records.size();
    spec.datasets.push_back({folder + "record", NumberType::int64, {rows}, "1", {}});
    spec.datasets.push_back(
        {folder + "threshold", NumberType::float64, {table.threshold.size()}, table.unit, {}});
    declare(folder, table.series, rows, spec);
    if (table.spots.empty()) continue;
    const std::uint64_t spots = table.spot_records.size();
    spec.datasets.push_back({folder + spot_folder + "record", NumberType::int64, {spots}, "1", {}});
    declare(folder + spot_folder, table.spots, spots, spec);
  }
  Hdf5File file = Hdf5File::create(path, spec, MPI_COMM_SELF, Replace::yes);
  for (const auto& [field, table] : tables) {
    const std::string folder = "/" + field + "/";
    file.write<std::int64_t>(folder + "record", 0, table.records);
    file.write<double>(folder + "threshold", 0, table.threshold);
    write_series(folder, table.series, file);
    if (table.spots.empty()) continue;
    file.write<std::int64_t>(folder + spot_folder + "record", 0, table.spot_records);
    write_series(folder + spot_folder, table.spots, file);
  }
  file.finish();
}

Tables read_tables(const std::string& path, MorphologyStamp& stamp) {
  verify(path, MPI_COMM_SELF);
  Hdf5File file = Hdf5File::open(path, MPI_COMM_SELF);
  stamp = {file.integer("record"), file.integer("step"), file.number("time"), file.text("scene"),
           file.number("pixel")};
  Tables tables;
  for (const DatasetInfo& info : file.datasets()) {
    const std::size_t slash = info.path.find('/', 1);
    if (slash == std::string::npos) continue;
    FieldTable& table = tables[info.path.substr(1, slash - 1)];
    const std::string name = info.path.substr(slash + 1);
    const bool of_spots = name.starts_with(spot_folder);
    if (name == "threshold") {
      table.unit = info.unit;
      table.threshold = file.read_all<double>(info.path);
    } else if (name == "record") {
      table.records = file.read_all<std::int64_t>(info.path);
    } else if (name == spot_folder + "record") {
      table.spot_records = file.read_all<std::int64_t>(info.path);
    } else if (of_spots) {
      table.spots[name.substr(spot_folder.size())] = read_series(info, file);
    } else {
      table.series[name] = read_series(info, file);
    }
  }
  return tables;
}

void append_tables(const std::string& path, const Tables& from,
                   const std::function<bool(std::int64_t)>& keep, Tables& to) {
  for (const auto& [field, source] : from) {
    const bool fresh = !to.contains(field);
    FieldTable& table = to[field];
    if (fresh) {
      table.unit = source.unit;
      table.threshold = source.threshold;
      table.series = emptied(source.series);
      table.spots = emptied(source.spots);
    }
    if (table.threshold != source.threshold || table.unit != source.unit ||
        !same_datasets(table.series, source.series) || !same_datasets(table.spots, source.spots)) {
      throw InputError(path + ": cannot be merged, the thresholds or curves of " + field +
                       " differ from those of the earlier records; move it away");
    }
    append_listed(source.series, source.records, rows_of(source.records, keep), table.series,
                  table.records);
    append_listed(source.spots, source.spot_records, rows_of(source.spot_records, keep),
                  table.spots, table.spot_records);
  }
}

void sort_by_record(Tables& tables) {
  for (auto& [field, table] : tables) {
    sort_rows(table.series, table.records);
    sort_rows(table.spots, table.spot_records);
  }
}

}  // namespace poreshock
