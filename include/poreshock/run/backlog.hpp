#pragma once
// Output that the disk does not take: small records wait in memory, a run goes on without them.

#include <mpi.h>

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace poreshock {

/// A file, or a row of one, that could not be written yet. `write` is collective and throws
/// SystemError on all ranks when it fails.
struct Waiting {
  std::string name;
  std::function<void()> write;
};

/// What the disk owes a run. The same on every rank.
struct Backlog {
  std::vector<Waiting> waiting;            ///< in the order of their times
  std::vector<std::string> left_out;       ///< snapshots that were too large to wait
  std::string reason;                      ///< of the last failure, empty when all is well
  std::string newest_checkpoint = "none";  ///< as a message names it
};

/// Writes what waits, oldest first, until something fails again. True when nothing waits any more;
/// says so after a failure. Collective.
bool catch_up(Backlog& backlog, MPI_Comm communicator);

/// Writes a record that is small enough to wait in memory when the disk does not take it, or when
/// an earlier one waits. Collective.
void write_or_wait(Waiting record, Backlog& backlog, MPI_Comm communicator);

/// Writes a record that is too large to wait: it is left out when the disk does not take it.
/// Collective.
void write_or_leave_out(const Waiting& record, Backlog& backlog, MPI_Comm communicator);

/// Prints a warning on rank 0 at once. Not collective.
void warn(const std::string& text, MPI_Comm communicator);

}  // namespace poreshock
