#include "poreshock/output/probe_file.hpp"

#include <algorithm>
#include <charconv>
#include <sstream>

#include "poreshock/core/error.hpp"
#include "poreshock/files/hdf5_file.hpp"
#include "poreshock/files/posix_file.hpp"
#include "poreshock/output/row_file.hpp"
#include "root_attributes.hpp"

namespace poreshock {

namespace {

std::vector<std::string> split(const std::string& line) {
  std::vector<std::string> entries;
  std::istringstream in(line);
  for (std::string entry; std::getline(in, entry, ',');) entries.push_back(entry);
  return entries;
}

/// Name and unit of "name [unit]".
void add_name(const std::string& entry, Trace& trace) {
  const std::size_t bracket = entry.find(" [");
  const bool has_unit = bracket != std::string::npos && entry.ends_with("]");
  trace.names.push_back(entry.substr(0, bracket));
  trace.units.push_back(has_unit ? entry.substr(bracket + 2, entry.size() - bracket - 3) : "");
}

void add_line(const std::string& line, const std::string& place, Trace& trace) {
  const std::vector<std::string> entries = split(line);
  bool good = entries.size() == trace.names.size();
  for (std::size_t k = 0; good && k < entries.size(); ++k) {
    double value = 0.0;
    const char* const end = entries[k].data() + entries[k].size();
    const auto result = std::from_chars(entries[k].data(), end, value);
    good = result.ec == std::errc{} && result.ptr == end;
    trace.columns[k].push_back(value);
  }
  if (good) return;
  throw InputError(place + ": found \"" + line.substr(0, 60) + "\", allowed " +
                   std::to_string(trace.names.size()) + " numbers; move the file away");
}

}  // namespace

std::string probe_file_name(const std::string& name) {
  return "probe_" + name + ".csv";
}

std::string probe_header(int dimension) {
  const bool plane = dimension == 2;
  return std::string("time [s],step [-],mass ") + (plane ? "[kg/m]" : "[kg]") +
         ",height [m],velocity_x [m/s],velocity_y [m/s]" + (plane ? "" : ",velocity_z [m/s]") +
         ",pressure [Pa],stress [Pa],temperature [K]";
}

std::string probe_line(const ProbeRow& row, int dimension) {
  std::string line;
  add_entry(row.time, line);
  add_entry(row.step, line);
  add_entry(row.mass, line);
  add_entry(row.height, line);
  for (int a = 0; a < dimension; ++a) add_entry(row.velocity[static_cast<std::size_t>(a)], line);
  for (const double value : {row.pressure, row.stress, row.temperature}) add_entry(value, line);
  return line;
}

const std::vector<double>& column(const Trace& trace, const std::string& name) {
  const auto found = std::find(trace.names.begin(), trace.names.end(), name);
  if (found == trace.names.end()) throw InputError("a trace has no column " + name);
  return trace.columns[static_cast<std::size_t>(found - trace.names.begin())];
}

Trace read_trace(const std::string& path) {
  std::istringstream in(read_text(path));
  Trace trace;
  std::string line;
  std::getline(in, line);
  for (const std::string& entry : split(line)) add_name(entry, trace);
  trace.columns.resize(trace.names.size());
  for (int number = 2; std::getline(in, line); ++number) {
    add_line(line, path + ":" + std::to_string(number), trace);
  }
  return trace;
}

void write_probes(const std::string& path, const RecordStamp& stamp,
                  const std::map<std::string, ProbeRecord>& probes) {
  FileSpec spec;
  spec.attributes = root_attributes("probes", stamp.time, stamp.step, stamp.scene_text);
  const auto place = [](const std::string& probe, const std::string& name) {
    return std::string("/").append(probe).append("/").append(name);
  };
  for (const auto& [name, record] : probes) {
    for (std::size_t k = 0; k < record.trace.names.size(); ++k) {
      const std::string unit = record.trace.units[k] == "-" ? "1" : record.trace.units[k];
      spec.datasets.push_back({place(name, record.trace.names[k]),
                               NumberType::float64,
                               {record.trace.columns[k].size()},
                               unit,
                               {}});
    }
    for (const TraceFigure& figure : record.figures) {
      spec.datasets.push_back(
          {place(name, "figures/" + figure.name), NumberType::float64, {1}, figure.unit, {}});
    }
  }
  Hdf5File file = Hdf5File::create(path, spec, MPI_COMM_SELF, Replace::yes, Durable::now);
  for (const auto& [name, record] : probes) {
    for (std::size_t k = 0; k < record.trace.names.size(); ++k) {
      file.write<double>(place(name, record.trace.names[k]), 0, record.trace.columns[k]);
    }
    for (const TraceFigure& figure : record.figures) {
      file.write<double>(place(name, "figures/" + figure.name), 0, std::span(&figure.value, 1));
    }
  }
  file.finish();
}

}  // namespace poreshock
