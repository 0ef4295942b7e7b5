// The program: one command line, one place where errors become messages and exit codes.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <new>
#include <string>

#include "poreshock/app/build_information.hpp"
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

/// An error that every rank knows of is said once; should a rank be alone with it after all, it
/// does not wait for the others for ever.
int fail(poreshock::ExitCode code, const char* what, MPI_Comm farewell) {
  if (!poreshock::all_arrive(seconds_for_all, farewell)) return end_all(code, what);
  if (poreshock::rank(farewell) == 0) std::fprintf(stderr, "poreshock: %s\n", what);
  return static_cast<int>(code);
}

/// Names what stands where a command should; CLI11 only says that one is missing.
int refuse_command(const CLI::App& app) {
  std::string allowed;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    allowed.append(allowed.empty() ? "" : ", ").append(command->get_name());
  }
  std::fprintf(stderr, "poreshock: unknown command \"%s\", allowed %s; see --help\n",
               app.remaining().front().c_str(), allowed.c_str());
  return static_cast<int>(poreshock::ExitCode::bad_input);
}

/// Every error that all ranks know of ends here; one that a single rank throws is fatal to all.
/// `farewell` is a communicator that nothing else uses.
int guarded(const poreshock::Command& command, MPI_Comm communicator, MPI_Comm farewell) {
  using poreshock::ExitCode;
  try {
    return static_cast<int>(poreshock::execute(command, communicator));
  } catch (const poreshock::InputError& error) {
    return fail(ExitCode::bad_input, error.what(), farewell);
  } catch (const poreshock::StateError& error) {
    return fail(ExitCode::bad_state, error.what(), farewell);
  } catch (const poreshock::SystemError& error) {
    return fail(ExitCode::system_failure, error.what(), farewell);
  } catch (const std::bad_alloc&) {
    return end_all(ExitCode::system_failure,
                   "out of memory: use more nodes, larger cells or fewer particles per cell");
  } catch (const std::exception& error) {
    return end_all(ExitCode::system_failure, error.what());
  }
}

/// Reads the command line, starts MPI and runs the command; returns the exit code.
int run(int argc, char** argv) {
  CLI::App app{"poreshock: strong shocks in porous and granular solids"};
  app.set_version_flag("--version", poreshock::build_information());
  app.require_subcommand(1);
  app.prefix_command(false);
  poreshock::Command command;
  poreshock::declare(command, app);
  // PETSc's own options (such as -log_view) come after a double dash.
  int program_argc = argc;
  for (int i = 1; i < argc; ++i) {
    if (std::string_view(argv[i]) == "--") program_argc = i;
  }
  try {
    app.parse(program_argc, argv);
  } catch (const CLI::ParseError& error) {
    const char* ranked = std::getenv("OMPI_COMM_WORLD_RANK");
    // mpirun ends all ranks as soon as one fails, so that only the rank that prints may.
    if (ranked != nullptr && std::string_view(ranked) != "0") return 0;
    if (error.get_exit_code() != 0 && app.get_subcommands().empty() && !app.remaining().empty()) {
      return refuse_command(app);
    }
    return app.exit(error) == 0 ? 0 : static_cast<int>(poreshock::ExitCode::bad_input);
  }
  const poreshock::Runtime runtime(argc, argv);
  MPI_Comm farewell = MPI_COMM_NULL;
  MPI_Comm_dup(runtime.communicator(), &farewell);
  const int code = guarded(command, runtime.communicator(), farewell);
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
