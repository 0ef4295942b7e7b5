#pragma once
// What a morphology file holds, in memory. Private to output; nothing here is collective.

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "poreshock/output/morphology_file.hpp"

namespace poreshock {

/// A dataset whose first dimension is a list of records or hot spots: one row, or number, of each.
struct Series {
  std::string unit;
  std::uint64_t width = 0;  ///< 0 for one number per row, else numbers per row
  bool integer = false;
  std::vector<std::int64_t> integers{};
  std::vector<double> numbers{};
};

using SeriesByName = std::map<std::string, Series>;

/// All records of one field, and its hot spots with the record of each.
struct FieldTable {
  std::string unit;
  std::vector<double> threshold;
  std::vector<std::int64_t> records;
  SeriesByName series;  ///< time, step, pixels, counts, functionals
  std::vector<std::int64_t> spot_records;
  SeriesByName spots;
};

using Tables = std::map<std::string, FieldTable>;

/// Tables of one record. Throws SystemError when curves or columns have the wrong length.
Tables make_tables(const MorphologyStamp& stamp, const std::vector<MorphologyRecord>& records);

/// Writes a file of one rank, replacing an older one.
void write_tables(const std::string& path, const MorphologyStamp& stamp, const Tables& tables);

/// Reads a file on one rank after checking its seal.
Tables read_tables(const std::string& path, MorphologyStamp& stamp);

/// Appends the rows of all records that `keep` takes. InputError naming `path` when the curves
/// differ from those there.
void append_tables(const std::string& path, const Tables& from,
                   const std::function<bool(std::int64_t)>& keep, Tables& to);

/// Puts all rows into the order of their records.
void sort_by_record(Tables& tables);

}  // namespace poreshock
