#pragma once
// A CSV file that grows with a run: names with units in the first line; every row begins with the
// time and the step.

#include <mpi.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include "poreshock/files/posix_file.hpp"

namespace poreshock {

/// Appends a number with 17 significant digits to a row, after a comma unless it is the first.
void add_entry(double value, std::string& line);
/// Appends an integer likewise.
void add_entry(std::int64_t value, std::string& line);

/// Throws the InputError with which a RowFile would refuse to go on with a file, and changes
/// nothing; a missing file is fine. Collective.
void require_rows(const std::string& path, const std::string& header, MPI_Comm communicator);

/// The open file. Only rank 0 has it; all members are collective, and a failing write throws
/// SystemError on all ranks.
class RowFile {
 public:
  /// Starts a new file with the line `header`, given without its end. With `restart_step` it goes
  /// on with the one there is: rows of later steps and a line cut off by a killed run are dropped
  /// first; a missing file is started anew. InputError when the file there has other columns.
  RowFile(const std::string& path, const std::string& header, MPI_Comm communicator,
          std::optional<std::int64_t> restart_step = std::nullopt);

  /// Appends one row or several, ends of line between them but not at the end, and hands them to
  /// the operating system at once. A file that was removed in between is begun again.
  void write(const std::string& rows);

  /// Forces the rows to the disk.
  void sync();

 private:
  void append(const std::string& text);

  std::string path_;
  std::string header_;
  MPI_Comm communicator_;
  std::unique_ptr<FileDescriptor> file_;  // rank 0 only
  std::uint64_t end_ = 0;
};

}  // namespace poreshock
