// The program: one command line, one place where errors become messages and exit codes.

#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "poreshock/app/command_line.hpp"
#include "poreshock/app/commands.hpp"
#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"

namespace {

constexpr double seconds_for_all = 10.0;

/// Ends all ranks because of what only this one knows.
int end_all(poreshock::ExitCode code, const std::string& what) {
  std::fprintf(stderr, "poreshock: rank %d: %s\n", poreshock::rank(MPI_COMM_WORLD), what.c_str());
  std::fflush(stderr);
  MPI_Abort(MPI_COMM_WORLD, static_cast<int>(code));
  return static_cast<int>(code);
}

/// An error that every rank knows of is said once, with the page that explains; should a rank be
/// alone with it after all, it does not wait for the others for ever.
int fail(poreshock::CommandKind kind, poreshock::ExitCode code, const char* what,
         MPI_Comm farewell) {
  if (!poreshock::all_arrive(seconds_for_all, farewell)) return end_all(code, what);
  if (poreshock::rank(farewell) == 0) {
    std::fprintf(stderr, "poreshock: %s\nexplained in %s\n", what,
                 poreshock::page_of(kind, code).c_str());
  }
  return static_cast<int>(code);
}

/// Every error that all ranks know of ends here; one that a single rank throws is fatal to all.
/// `farewell` is a communicator that nothing else uses.
int guarded(const poreshock::Command& command, MPI_Comm communicator, MPI_Comm farewell) {
  using poreshock::ExitCode;
  try {
    return static_cast<int>(poreshock::execute(command, communicator));
  } catch (const poreshock::InputError& error) {
    return fail(command.kind, ExitCode::bad_input, error.what(), farewell);
  } catch (const poreshock::StateError& error) {
    return fail(command.kind, ExitCode::bad_state, error.what(), farewell);
  } catch (const poreshock::SystemError& error) {
    return fail(command.kind, ExitCode::system_failure, error.what(), farewell);
  } catch (const std::bad_alloc&) {
    return end_all(ExitCode::system_failure,
                   "out of memory: use more nodes, larger cells or fewer particles per cell");
  } catch (const std::exception& error) {
    return end_all(ExitCode::system_failure, error.what());
  }
}

/// The exit code of a command whose result standard output has not taken, a full disk for example:
/// a failure, unless there was another one before.
int with_lost_output(int code) {
  const bool lost = std::fflush(stdout) != 0 || std::ferror(stdout) != 0;
  if (!lost || code != static_cast<int>(poreshock::ExitCode::success)) return code;
  std::fprintf(
      stderr,
      "poreshock: cannot write all of the result to standard output: make room, or give it "
      "another place, and start again; the files of a run are not touched by this\n");
  return static_cast<int>(poreshock::ExitCode::system_failure);
}

/// Reads the command line, starts MPI and runs the command; returns the exit code.
int run(int argc, char** argv) {
  poreshock::Command command;
  if (const auto code = poreshock::read_command_line(argc, argv, command)) {
    return with_lost_output(*code);
  }
  const poreshock::Runtime runtime(argc, argv);
  MPI_Comm farewell = MPI_COMM_NULL;
  MPI_Comm_dup(runtime.communicator(), &farewell);
  const int code = with_lost_output(guarded(command, runtime.communicator(), farewell));
  MPI_Comm_free(&farewell);
  return code;
}

}  // namespace

int main(int argc, char** argv) {
  // What comes here was thrown outside of the command, where no rank knows of the others.
  try {
    return run(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "poreshock: %s\n", error.what());
    return static_cast<int>(poreshock::ExitCode::system_failure);
  }
}
