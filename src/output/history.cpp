#include "poreshock/output/history.hpp"

#include <fcntl.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "poreshock/output/rank_zero.hpp"

namespace poreshock {

namespace {

/// What an energy of a row is: none of the heat so far, heat, or heat that the numerics made.
enum class Heat { none, physical, numerical };

struct EnergyColumn {
  const char* name;
  double HistoryRow::*value;
  Heat heat = Heat::none;
};

/// Energies in the order of the file.
constexpr std::array<EnergyColumn, 14> energy_columns = {{
    {"kinetic", &HistoryRow::kinetic},
    {"internal", &HistoryRow::internal},
    {"escaped", &HistoryRow::escaped},
    {"wall_work", &HistoryRow::wall_work},
    {"body_work", &HistoryRow::body_work},
    {"total", &HistoryRow::total},
    {"elastic", &HistoryRow::elastic},
    {"plastic_work", &HistoryRow::plastic_work, Heat::physical},
    {"viscous_heat", &HistoryRow::viscous_heat, Heat::physical},
    {"filter_heat", &HistoryRow::filter_heat, Heat::numerical},
    {"wall_heat", &HistoryRow::wall_heat, Heat::physical},
    {"contact_heat", &HistoryRow::contact_heat, Heat::numerical},
    {"friction_heat", &HistoryRow::friction_heat, Heat::physical},
    {"conduction", &HistoryRow::conduction},
}};

struct MomentumColumn {
  const char* name;
  std::array<double, 3> HistoryRow::*value;
};

constexpr std::array<MomentumColumn, 5> momentum_columns = {{
    {"momentum", &HistoryRow::momentum},
    {"escaped_momentum", &HistoryRow::escaped_momentum},
    {"wall_impulse", &HistoryRow::wall_impulse},
    {"body_impulse", &HistoryRow::body_impulse},
    {"total_momentum", &HistoryRow::total_momentum},
}};

/// Calls visit(name, unit, value) for all numbers of a row in the order of the file.
template <class Visitor>
void for_each_value(const HistoryRow& row, int dimension, Visitor&& visit) {
  const bool plane = dimension == 2;
  visit("time", "s", row.time);
  visit("step", "-", row.step);
  visit("dt", "s", row.dt);
  visit("particles", "-", row.particles);
  for (const EnergyColumn& column : energy_columns) {
    visit(column.name, plane ? "J/m" : "J", row.*column.value);
  }
  for (const MomentumColumn& column : momentum_columns) {
    for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
      visit(std::string(column.name) + "_" + "xyz"[a], plane ? "kg/s" : "kg m/s",
            (row.*column.value)[a]);
    }
  }
  visit("wall_force", plane ? "N/m" : "N", row.wall_force);
  visit("numerical_share", "-", numerical_share(row));
  visit("guards", "-", row.guards);
  if (!row.contact) return;
  visit("contact_nodes", "-", row.contact->nodes);
  visit("crowded_nodes", "-", row.contact->crowded);
  visit("least_gap", "m", row.contact->least_gap);
  visit("penetration", "m", row.contact->penetration);
  visit("momentum_residual", "-", row.contact->residual);
}

void add(double value, std::string& line) {
  char text[64];
  const auto end =
      std::to_chars(text, text + sizeof(text), value, std::chars_format::general, 17).ptr;
  line.append(line.empty() ? "" : ",").append(text, end);
}

void add(std::int64_t value, std::string& line) {
  line.append(line.empty() ? "" : ",").append(std::to_string(value));
}

/// Step of a complete row; nothing when it cannot be read.
std::optional<std::int64_t> row_step(const std::string& line) {
  const std::size_t first = line.find(',');
  if (first == std::string::npos) return std::nullopt;
  std::int64_t step = 0;
  const auto result = std::from_chars(line.data() + first + 1, line.data() + line.size(), step);
  if (result.ec != std::errc{} || *result.ptr != ',') return std::nullopt;
  return step;
}

/// Throws the InputError of a file with other columns than the header; says how to go on.
void require_header(const std::string& path, const std::string& found, const std::string& header) {
  if (found == header) return;
  throw InputError(path +
                   ":1: its columns are not those that this program writes for this scene; go on "
                   "with the program that wrote it, or leave it as it is and go on in another "
                   "folder with --output DIR --restart CHECKPOINT");
}

/// The rows to go on from: header and complete rows up to `last_step`.
std::string kept_rows(const std::string& path, int dimension, bool grains, std::int64_t last_step) {
  const std::string text = read_text(path);
  std::istringstream in(text);
  std::string line;
  const std::string header = history_header(dimension, grains);
  std::getline(in, line);
  require_header(path, line, header);
  std::string kept = header + '\n';
  // A row without an end of line was cut off when the run was killed.
  while (std::getline(in, line) && !in.eof()) {
    const auto step = row_step(line);
    if (step && *step <= last_step) kept += line + '\n';
  }
  return kept;
}

}  // namespace

double all_heat(const HistoryRow& row) {
  double heat = 0.0;
  for (const EnergyColumn& column : energy_columns) {
    if (column.heat != Heat::none) heat += row.*column.value;
  }
  return heat;
}

double numerical_share(const HistoryRow& row) {
  const double heat = all_heat(row);
  double numerical = 0.0;
  for (const EnergyColumn& column : energy_columns) {
    if (column.heat == Heat::numerical) numerical += row.*column.value;
  }
  return heat > 0.0 ? numerical / heat : 0.0;
}

std::string history_header(int dimension, bool grains) {
  HistoryRow row;
  if (grains) row.contact.emplace();
  std::string header;
  for_each_value(row, dimension, [&](const std::string& name, const char* unit, auto) {
    header.append(header.empty() ? "" : ",").append(name + " [" + unit + "]");
  });
  return header;
}

std::string history_line(const HistoryRow& row, int dimension) {
  std::string line;
  for_each_value(row, dimension,
                 [&](const std::string&, const char*, auto value) { add(value, line); });
  return line;
}

void require_history(const std::string& path, int dimension, bool grains, MPI_Comm communicator) {
  on_rank_zero(communicator, [&] {
    if (!std::filesystem::exists(path)) return;
    std::string line;
    std::getline(std::ifstream(path), line);
    require_header(path, line, history_header(dimension, grains));
  });
}

HistoryWriter::HistoryWriter(const std::string& path, int dimension, bool grains,
                             MPI_Comm communicator, std::optional<std::int64_t> restart_step)
    : path_(path), dimension_(dimension), grains_(grains), communicator_(communicator) {
  on_rank_zero(communicator_, [&] {
    if (restart_step && std::filesystem::exists(path)) {
      write_text(path, kept_rows(path, dimension, grains, *restart_step));
      file_ = std::make_unique<FileDescriptor>(path, O_WRONLY);
      end_ = file_->size();
    } else {
      file_ = std::make_unique<FileDescriptor>(path, O_WRONLY | O_CREAT | O_TRUNC);
      append({});
    }
  });
}

void HistoryWriter::write(const HistoryRow& row) {
  on_rank_zero(communicator_, [&] { append(history_line(row, dimension_) + '\n'); });
}

void HistoryWriter::sync() {
  on_rank_zero(communicator_, [&] { file_->sync(); });
}

void HistoryWriter::append(const std::string& line) {
  if (!file_->is_at(path_)) {
    file_ = std::make_unique<FileDescriptor>(path_, O_WRONLY | O_CREAT | O_EXCL);
    end_ = 0;
  }
  // In one piece with the first row, so that no file is left without its header.
  const std::string text = (end_ == 0 ? history_header(dimension_, grains_) + '\n' : "") + line;
  file_->write(end_, reinterpret_cast<const std::byte*>(text.data()), text.size());
  end_ += text.size();
}

}  // namespace poreshock
