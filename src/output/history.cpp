#include "poreshock/output/history.hpp"

#include <fcntl.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "poreshock/output/rank_zero.hpp"

namespace poreshock {

namespace {

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
  return row.plastic_work + row.viscous_heat + row.filter_heat + row.wall_heat + row.contact_heat +
         row.friction_heat;
}

double numerical_share(const HistoryRow& row) {
  const double heat = all_heat(row);
  return heat > 0.0 ? (row.filter_heat + row.contact_heat) / heat : 0.0;
}

std::string history_header(int dimension, bool grains) {
  const bool plane = dimension == 2;
  const std::string energy = plane ? " [J/m]" : " [J]";
  const std::string momentum = plane ? " [kg/s]" : " [kg m/s]";
  std::string header = "time [s],step [-],dt [s],particles [-]";
  for (const char* name : {"kinetic", "internal", "escaped", "wall_work", "body_work", "total",
                           "elastic", "plastic_work", "viscous_heat", "filter_heat", "wall_heat",
                           "contact_heat", "friction_heat", "conduction"}) {
    header.append(",").append(name).append(energy);
  }
  for (const char* name :
       {"momentum", "escaped_momentum", "wall_impulse", "body_impulse", "total_momentum"}) {
    for (const char* axis : {"_x", "_y", "_z"}) {
      if (plane && axis[1] == 'z') continue;
      header.append(",").append(name).append(axis).append(momentum);
    }
  }
  header.append(",wall_force").append(plane ? " [N/m]" : " [N]").append(",numerical_share [-]");
  header.append(",guards [-]");
  if (grains) {
    header.append(
        ",contact_nodes [-],crowded_nodes [-],least_gap [m],penetration [m],momentum_residual [-]");
  }
  return header;
}

std::string history_line(const HistoryRow& row, int dimension) {
  std::string line;
  add(row.time, line);
  add(row.step, line);
  add(row.dt, line);
  add(row.particles, line);
  for (const double value :
       {row.kinetic, row.internal, row.escaped, row.wall_work, row.body_work, row.total,
        row.elastic, row.plastic_work, row.viscous_heat, row.filter_heat, row.wall_heat,
        row.contact_heat, row.friction_heat, row.conduction}) {
    add(value, line);
  }
  for (const auto* values : {&row.momentum, &row.escaped_momentum, &row.wall_impulse,
                             &row.body_impulse, &row.total_momentum}) {
    for (int a = 0; a < dimension; ++a) add((*values)[static_cast<std::size_t>(a)], line);
  }
  add(row.wall_force, line);
  add(numerical_share(row), line);
  add(row.guards, line);
  if (row.contact) {
    add(row.contact->nodes, line);
    add(row.contact->crowded, line);
    for (const double value :
         {row.contact->least_gap, row.contact->penetration, row.contact->residual}) {
      add(value, line);
    }
  }
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
