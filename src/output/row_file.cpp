#include "poreshock/output/row_file.hpp"

#include <fcntl.h>

#include <charconv>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "poreshock/core/error.hpp"
#include "poreshock/core/rank_zero.hpp"

namespace poreshock {

namespace {

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
std::string kept_rows(const std::string& path, const std::string& header, std::int64_t last_step) {
  const std::string text = read_text(path);
  std::istringstream in(text);
  std::string line;
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

void add_entry(double value, std::string& line) {
  char text[64];
  const auto end =
      std::to_chars(text, text + sizeof(text), value, std::chars_format::general, 17).ptr;
  line.append(line.empty() ? "" : ",").append(text, end);
}

void add_entry(std::int64_t value, std::string& line) {
  line.append(line.empty() ? "" : ",").append(std::to_string(value));
}

void require_rows(const std::string& path, const std::string& header, MPI_Comm communicator) {
  on_rank_zero(communicator, [&] {
    if (!std::filesystem::exists(path)) return;
    std::string line;
    std::getline(std::ifstream(path), line);
    require_header(path, line, header);
  });
}

RowFile::RowFile(const std::string& path, const std::string& header, MPI_Comm communicator,
                 std::optional<std::int64_t> restart_step)
    : path_(path), header_(header), communicator_(communicator) {
  on_rank_zero(communicator_, [&] {
    if (restart_step && std::filesystem::exists(path)) {
      write_text(path, kept_rows(path, header, *restart_step));
      file_ = std::make_unique<FileDescriptor>(path, O_WRONLY);
      end_ = file_->size();
    } else {
      file_ = std::make_unique<FileDescriptor>(path, O_WRONLY | O_CREAT | O_TRUNC);
      append({});
    }
  });
}

void RowFile::write(const std::string& rows) {
  on_rank_zero(communicator_, [&] { append(rows + '\n'); });
}

void RowFile::sync() {
  on_rank_zero(communicator_, [&] { file_->sync(); });
}

void RowFile::append(const std::string& text) {
  if (!file_->is_at(path_)) {
    file_ = std::make_unique<FileDescriptor>(path_, O_WRONLY | O_CREAT | O_EXCL);
    end_ = 0;
  }
  // In one piece with the first row, so that no file is left without its header.
  const std::string whole = (end_ == 0 ? header_ + '\n' : "") + text;
  file_->write(end_, reinterpret_cast<const std::byte*>(whole.data()), whole.size());
  end_ += whole.size();
}

}  // namespace poreshock
