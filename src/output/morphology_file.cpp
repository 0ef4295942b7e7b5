#include "poreshock/output/morphology_file.hpp"

#include "poreshock/output/rank_zero.hpp"
#include "record_tables.hpp"

namespace poreshock {

namespace {

TableFormat format() {
  return {"morphology", "morphology.h5", "threshold"};
}

RecordTables make_tables(const RecordStamp& stamp, const std::vector<MorphologyRecord>& records) {
  RecordTables tables;
  for (const MorphologyRecord& record : records) {
    RecordTable& table = tables[record.field];
    const std::size_t width = record.threshold.size();
    table = one_record(stamp);
    table.axis_unit = record.unit;
    table.axis = record.threshold;
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

}  // namespace

std::string morphology_name(std::int64_t record) {
  return record_name(format(), record);
}

void write_morphology(const std::string& path, const RecordStamp& stamp,
                      const std::vector<MorphologyRecord>& records, MPI_Comm communicator) {
  on_rank_zero(communicator,
               [&] { write_tables(path, format(), stamp, make_tables(stamp, records)); });
}

void remove_morphology_from(const std::string& folder, std::int64_t first, MPI_Comm communicator) {
  on_rank_zero(communicator, [&] { remove_tables_from(folder, format(), first); });
}

std::int64_t collect_morphology(const std::string& folder, MPI_Comm communicator) {
  std::int64_t merged = 0;
  on_rank_zero(communicator, [&] { merged = collect_tables(folder, format()); });
  check_mpi(MPI_Bcast(&merged, 1, MPI_INT64_T, 0, communicator), "MPI_Bcast");
  return merged;
}

}  // namespace poreshock
