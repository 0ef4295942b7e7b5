#pragma once
// Private to output: curves measured at many times. One small file per record while a run goes on,
// one file with all records at its end. Nothing here is collective: rank 0 calls.

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "poreshock/files/hdf5_file.hpp"
#include "poreshock/output/record_stamp.hpp"

namespace poreshock {

/// One dataset whose first dimension is a list of records or of things: one row, or number, of
/// each.
struct Series {
  std::string unit;
  std::uint64_t width = 0;  ///< 0 for one number per row, else numbers per row
  bool integer = false;
  std::vector<std::int64_t> integers{};
  std::vector<double> numbers{};
};

using SeriesByName = std::map<std::string, Series>;

/// Rows of some datasets, each with the record it belongs to.
struct Rows {
  std::vector<std::int64_t> records;
  SeriesByName series;
};

/// All records of one group of a file; its curves share an axis.
struct RecordTable {
  std::string axis_unit;
  std::vector<double> axis;  ///< empty when there are no curves
  Rows curves;               ///< one row per record; time and step among them
  Rows things;               ///< any number of rows per record, under <group>/domains
};

/// Tables by the name of their group.
using RecordTables = std::map<std::string, RecordTable>;

/// Names in the files of one kind: <kind>_NNNNNN.h5 hold a record each, `whole` holds all.
struct TableFormat {
  std::string kind;
  std::string whole;
  std::string axis;                    ///< dataset with the axis of a table
  std::vector<std::string> numbers{};  ///< further attributes of the file
};

/// A series of integers without a unit.
Series integer_series(std::vector<std::int64_t> values, std::uint64_t width);

/// A table with one record and its time and step.
RecordTable one_record(const RecordStamp& stamp);

/// File name of a record in its folder.
std::string record_name(const TableFormat& format, std::int64_t record);

/// Writes /<group>/{record, axis, curves...} and /<group>/domains/{record, things...}, replacing an
/// older file. SystemError when it fails.
void write_tables(const std::string& path, const TableFormat& format, const RecordStamp& stamp,
                  const RecordTables& tables, Durable durable);

/// Takes the records from number `first` on out of the file with all records; the file goes when it
/// has no others. InputError when the file is damaged.
void remove_tables_from(const std::string& folder, const TableFormat& format, std::int64_t first);

/// Throws InputError that says how to go on when a file of the folder has another axis or other
/// series than a record of now, so that the two could not be merged. Changes nothing.
void require_same_tables(const std::string& folder, const TableFormat& format,
                         const RecordTables& now);

/// Merges the small files, and what the file with all records holds of other records, in the order
/// of the records, and removes the small files. Returns how many there were. InputError when a file
/// is damaged or its axis or series differ from the others'.
std::int64_t collect_tables(const std::string& folder, const TableFormat& format);

}  // namespace poreshock
