#include "poreshock/output/info.hpp"

#include <algorithm>
#include <charconv>
#include <filesystem>
#include <sstream>

#include "poreshock/core/rank_zero.hpp"
#include "poreshock/files/block_hash.hpp"
#include "poreshock/files/hdf5_file.hpp"
#include "poreshock/files/posix_file.hpp"
#include "poreshock/output/history.hpp"
#include "poreshock/output/probe_file.hpp"

namespace poreshock {

namespace {

std::string printed(const AttributeValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return *text;
  if (const auto* number = std::get_if<double>(&value)) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof(text), *number).ptr};
  }
  return std::to_string(std::get<std::int64_t>(value));
}

std::string shape_text(const DatasetInfo& info) {
  std::string text;
  for (const std::uint64_t extent : info.shape) {
    text += (text.empty() ? "" : " x ") + std::to_string(extent);
  }
  return text.empty() ? "one value" : text;
}

void describe_datasets(Hdf5File& file, std::ostream& out) {
  const std::vector<DatasetInfo> datasets = file.datasets();
  std::size_t width = 0;
  for (const DatasetInfo& info : datasets) width = std::max(width, info.path.size());
  out << "datasets  " << datasets.size() << "\n";
  for (const DatasetInfo& info : datasets) {
    out << "  " << info.path << std::string(width - info.path.size() + 2, ' ')
        << (info.type ? number_type_name(*info.type) : "other type") << "  " << shape_text(info);
    if (!info.unit.empty() && info.unit != "1") out << "  " << info.unit;
    out << "\n";
  }
}

std::string describe_hdf5(const std::string& path) {
  std::ostringstream out;
  Hdf5File file = Hdf5File::open(path, MPI_COMM_SELF);
  const Outcome seal = attempt([&] { verify(path, MPI_COMM_SELF); });
  if (!file.attribute("kind") || !has_seal(path)) {
    out << path << ": HDF5 file not written by poreshock\n";
  } else {
    out << path << ": " << printed(*file.attribute("kind")) << " of poreshock\n";
    out << "content   " << (seal.reason.empty() ? "intact" : seal.reason) << "\n";
  }
  for (const char* name :
       {"time", "step", "record", "dimension", "thermal", "version", "revision"}) {
    const auto value = file.attribute(name);
    if (!value) continue;
    out << name << std::string(10 - std::string(name).size(), ' ') << printed(*value)
        << (std::string(name) == "time" ? " s" : "") << "\n";
  }
  describe_datasets(file, out);
  return out.str();
}

bool is_history(const std::string& header, int dimension) {
  for (const bool grains : {false, true}) {
    for (const bool follows : {false, true}) {
      if (header == history_header(dimension, grains, follows)) return true;
    }
  }
  return false;
}

/// What a file of rows with this first line is; empty where it is none of a run.
std::string kind_of_rows(const std::string& header) {
  for (const int dimension : {2, 3}) {
    const std::string run = "a " + std::to_string(dimension) + "-D run";
    if (is_history(header, dimension)) return "history of " + run;
    if (header == probe_header(dimension)) return "trace of a probe of " + run;
  }
  return {};
}

std::string describe_rows(const std::string& path, const std::string& kind,
                          const std::string& text) {
  std::istringstream in(text);
  std::string header;
  std::string line;
  std::string last;
  std::getline(in, header);
  std::int64_t rows = 0;
  for (; std::getline(in, line); ++rows) last = line;
  std::ostringstream out;
  out << path << ": " << kind << " of poreshock\nrows      " << rows << "\n";
  if (rows > 0) {
    const std::size_t comma = last.find(',');
    out << "time      " << last.substr(0, comma) << " s (last row)\n";
    out << "step      " << last.substr(comma + 1, last.find(',', comma + 1) - comma - 1)
        << " (last row)\n";
  }
  out << "columns   " << header << "\n";
  return out.str();
}

}  // namespace

std::string describe(const std::string& path) {
  const std::string name = std::filesystem::path(path).filename().string();
  if (name.ends_with(".h5")) return describe_hdf5(path);
  const std::string text = read_text(path);
  const std::string kind = kind_of_rows(text.substr(0, text.find('\n')));
  if (!kind.empty()) return describe_rows(path, kind, text);
  if (name == "timings.json") return path + ": timings of a run of poreshock\n" + text;
  if (name.ends_with(".toml")) return path + ": scene\n" + text;
  if (name == "snapshots.xdmf" || name == "maps.xdmf") {
    std::int64_t count = 0;
    const std::string mark = "<Time ";
    for (std::size_t at = text.find(mark); at != std::string::npos; at = text.find(mark, at + 1)) {
      ++count;
    }
    return path + ": time series of " + std::to_string(count) + " snapshots" +
           (name == "maps.xdmf" ? " on pixels" : "") + ", for ParaView\n";
  }
  throw InputError(path +
                   ": not a file of poreshock; known are *.h5, history.csv, probe_*.csv, "
                   "timings.json, snapshots.xdmf, maps.xdmf and *.toml");
}

}  // namespace poreshock
