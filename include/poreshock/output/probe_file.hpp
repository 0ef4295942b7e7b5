#pragma once
// Traces of probes: probe_NAME.csv grows with a run, probes.h5 holds all traces and what follows
// from them at its end.

#include <mpi.h>

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "poreshock/output/record_stamp.hpp"

namespace poreshock {

/// What a probe saw at one time: means over the material in its spot, weighted with mass, pressure
/// and stress with volume. NaN where no material is left.
struct ProbeRow {
  double time = 0.0;  ///< s
  std::int64_t step = 0;
  double mass = 0.0;                 ///< kg (kg/m in plane strain), of what it saw
  double height = 0.0;               ///< m, in the laboratory
  std::array<double, 3> velocity{};  ///< m/s; z is not written in plane strain
  double pressure = 0.0;             ///< Pa
  double stress = 0.0;               ///< Pa, longitudinal, compression positive, without viscosity
  double temperature = 0.0;          ///< K, not clamped
};

/// File name of a trace in its folder: probe_NAME.csv.
std::string probe_file_name(const std::string& name);

/// First line of the file, without its end of line.
std::string probe_header(int dimension);

/// One line of the file, without its end of line.
std::string probe_line(const ProbeRow& row, int dimension);

/// All columns of a trace file in their order.
struct Trace {
  std::vector<std::string> names;
  std::vector<std::string> units;
  std::vector<std::vector<double>> columns;
};

/// The column of that name; InputError when there is none.
const std::vector<double>& column(const Trace& trace, const std::string& name);

/// Reads a trace file; InputError that names the line when it is no such file. Not collective.
Trace read_trace(const std::string& path);

/// A number that follows from a trace.
struct TraceFigure {
  std::string name;
  std::string unit;
  double value = 0.0;
};

/// A trace and what follows from it.
struct ProbeRecord {
  Trace trace;
  std::vector<TraceFigure> figures;
};

/// Writes /NAME/{time, step, ...} and /NAME/figures/{...}, replacing an older file. SystemError
/// when it fails. Not collective.
void write_probes(const std::string& path, const RecordStamp& stamp,
                  const std::map<std::string, ProbeRecord>& probes);

}  // namespace poreshock
