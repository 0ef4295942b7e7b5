#include "poreshock/run/backlog.hpp"

#include <cstdio>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"

namespace poreshock {

void warn(const std::string& text, MPI_Comm communicator) {
  if (rank(communicator) != 0) return;
  std::fprintf(stderr, "warning: %s\n", text.c_str());
  std::fflush(stderr);
}

bool catch_up(Backlog& backlog, MPI_Comm communicator) {
  std::size_t written = 0;
  try {
    for (; written < backlog.waiting.size(); ++written) backlog.waiting[written].write();
  } catch (const SystemError& failure) {
    backlog.reason = failure.what();
  }
  const auto end = backlog.waiting.begin() + static_cast<std::ptrdiff_t>(written);
  backlog.waiting.erase(backlog.waiting.begin(), end);
  if (!backlog.waiting.empty()) return false;
  if (written > 0) {
    warn("the disk takes files again: " + std::to_string(written) + " waiting records are written",
         communicator);
  }
  backlog.reason.clear();
  return true;
}

void write_or_wait(Waiting record, Backlog& backlog, MPI_Comm communicator) {
  if (backlog.waiting.empty()) {
    try {
      record.write();
      return;
    } catch (const SystemError& failure) {
      backlog.reason = failure.what();
      warn(backlog.reason + "; " + record.name +
               " and the records after it wait in memory, the run goes on and tries again at the "
               "next record",
           communicator);
    }
  }
  backlog.waiting.push_back(std::move(record));
}

void write_or_leave_out(const Waiting& record, Backlog& backlog, MPI_Comm communicator) {
  try {
    record.write();
  } catch (const SystemError& failure) {
    backlog.reason = failure.what();
    backlog.left_out.push_back(record.name);
    warn(backlog.reason + "; " + record.name + " is left out, the run goes on", communicator);
  }
}

}  // namespace poreshock
