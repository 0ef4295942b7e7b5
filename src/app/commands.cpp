#include "poreshock/app/commands.hpp"

#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "poreshock/app/check.hpp"
#include "poreshock/app/reference.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/core/rank_zero.hpp"
#include "poreshock/core/stop_signal.hpp"
#include "poreshock/core/text.hpp"
#include "poreshock/files/posix_file.hpp"
#include "poreshock/output/checkpoint.hpp"
#include "poreshock/output/folder.hpp"
#include "poreshock/output/info.hpp"
#include "poreshock/run/run.hpp"
#include "poreshock/scene/compare_scenes.hpp"
#include "poreshock/scene/read_scene.hpp"

namespace poreshock {

namespace {

/// Rank 0 reads the file; all ranks parse the resolved text, so a slow disk is read once.
Scene read_everywhere(const Command& command, MPI_Comm communicator) {
  std::string text;
  on_rank_zero(communicator,
               [&] { text = write_scene(read_scene(command.file, command.overrides)); });
  broadcast(text, communicator);
  return parse_scene(text, command.file);
}

/// What a scene has that the checkpoint's may not differ from, by key; empty when it may go on.
std::string differences(const Scene& now, const Scene& allowed) {
  if (now == allowed) return {};
  std::string names;
  for (const std::string& key : different_keys(now, allowed)) {
    names.append(names.empty() ? "" : ", ").append(key);
  }
  return names.empty() ? "a setting that is not written out" : names;
}

/// The stored scene with all that may differ on a restart taken from the scene of now.
Scene with_free_settings(Scene stored, const Scene& now) {
  stored.title = now.title;
  stored.time.end = now.time.end;
  stored.time.max_steps = now.time.max_steps;
  const double beat = stored.output.beat;
  stored.output = now.output;
  stored.output.beat = beat;
  stored.checkpoint = now.checkpoint;
  stored.morphology = now.morphology;
  stored.profile = now.profile;
  return stored;
}

/// On restart only the end, the output, checkpoints, profiles and morphology may differ; where the
/// records of the checkpoint's folder go on, the morphology must measure the same as before.
void require_same_run(const Scene& now, const CheckpointHeader& header, const std::string& path,
                      bool continues) {
  if (header.dimension != now.dimension) {
    throw InputError(path + ": holds a " + std::to_string(header.dimension) +
                     "-D run, the scene asks for " + std::to_string(now.dimension) + "-D");
  }
  const Scene stored = parse_scene(header.scene_text, path);
  const std::string names = differences(now, with_free_settings(stored, now));
  if (!names.empty()) {
    throw InputError(
        path + " was written by a scene that differs in " + names +
        "; allowed are differences in the title, time.end, time.max_steps, output, "
        "checkpoint, profile and morphology: restart with the scene.toml beside it, or start a "
        "new run");
  }
  const Morphology& a = now.morphology;
  const Morphology& b = stored.morphology;
  if (!continues || a.every == 0.0 || b.every == 0.0) return;
  Morphology same = a;
  same.every = b.every;
  if (same == b) return;
  throw InputError(
      path +
      " was written with other morphology fields, thresholds, domains, lattice or pixel, which "
      "cannot go on in the same folder: keep them, or choose another folder with --output");
}

/// A run that would end before its checkpoint has nothing to compute, and much to cut off.
void require_time_left(const Scene& scene, const CheckpointHeader& header,
                       const std::string& path) {
  constexpr double rounding = 1e-9;
  const TimeControl& limits = scene.time;
  const std::string advice =
      "; nothing was changed. Raise it, or name an earlier checkpoint with --restart FILE";
  if (limits.end < header.time * (1.0 - rounding)) {
    throw InputError("time.end: found " + significant<9>(limits.end) +
                     " s, allowed at least the time of " + path + ", " +
                     significant<9>(header.time) + " s" + advice);
  }
  if (limits.max_steps > 0 && limits.max_steps < header.step) {
    throw InputError("time.max_steps: found " + std::to_string(limits.max_steps) +
                     ", allowed 0 or at least the step of " + path + ", " +
                     std::to_string(header.step) + advice);
  }
}

/// A checkpoint from elsewhere does not make an existing folder ours to go on in.
bool lies_in(const std::string& file, const std::string& folder) {
  std::error_code none;
  return std::filesystem::equivalent(folder_of(file), folder, none);
}

std::string restart_path(const Command& command, MPI_Comm communicator) {
  if (command.restart != "latest") return command.restart;
  std::string note;
  const std::string path = latest_checkpoint(command.output, communicator, note);
  if (rank(communicator) == 0) {
    if (!note.empty()) std::printf("%s\n", note.c_str());
    std::printf("restart from %s\n", path.c_str());
  }
  return path;
}

/// Rows go to a terminal only, unless asked for. mpirun gives its first process a terminal of its
/// own, so that tools/mpirun says what it writes to itself.
ProgressRows progress_rows(const Command& command) {
  if (command.quiet) return ProgressRows::none;
  if (command.verbose) return ProgressRows::every_beat;
  const char* terminal = std::getenv("PORESHOCK_TERMINAL");
  const bool shown = terminal != nullptr ? std::string_view(terminal) != "no" : isatty(1) != 0;
  return shown ? ProgressRows::timed : ProgressRows::none;
}

ExitCode execute_run(const Command& command, MPI_Comm communicator) {
  // Written so that a NaN is refused too.
  if (!(command.wall_limit >= 0.0)) {
    throw InputError("--wall-time: found " + std::to_string(command.wall_limit) +
                     ", allowed a number >= 0 (s), 0 = no limit");
  }
  const Scene scene = read_everywhere(command, communicator);
  RunOptions options;
  options.folder = command.output.empty()
                       ? "output/" + std::filesystem::path(command.file).stem().string()
                       : command.output;
  options.wall_limit = command.wall_limit;
  options.force = command.force;
  // One rank asks: the others may have another terminal, or none.
  int rows = static_cast<int>(progress_rows(command));
  check_mpi(MPI_Bcast(&rows, 1, MPI_INT, 0, communicator), "MPI_Bcast");
  options.rows = static_cast<ProgressRows>(rows);
  options.quiet = command.quiet;
  Command resolved = command;
  resolved.output = options.folder;
  if (!command.restart.empty()) {
    options.restart = restart_path(resolved, communicator);
    // One rank asks: on a network file system the others might see something else.
    int continues = lies_in(options.restart, options.folder) ? 1 : 0;
    check_mpi(MPI_Bcast(&continues, 1, MPI_INT, 0, communicator), "MPI_Bcast");
    options.continues = continues == 1;
    const CheckpointHeader header = checkpoint_header(options.restart, communicator);
    require_same_run(scene, header, options.restart, options.continues);
    require_time_left(scene, header, options.restart);
  }
  require_output_folder(options.folder, options.force, options.continues, communicator);
  catch_stop_signals();
  scene.dimension == 2 ? run<2>(scene, options, communicator)
                       : run<3>(scene, options, communicator);
  return ExitCode::success;
}

}  // namespace

std::string page_of(CommandKind kind, ExitCode code) {
  if (code != ExitCode::bad_input) return "src/output/README.md, what stops a run";
  switch (kind) {
    case CommandKind::analyze:
    case CommandKind::compare:
      return "src/morphology/README.md";
    case CommandKind::info:
      return "src/output/README.md";
    default:
      return "input/README.md";
  }
}

ExitCode execute(const Command& command, MPI_Comm communicator) {
  switch (command.kind) {
    case CommandKind::run:
      return execute_run(command, communicator);
    case CommandKind::check:
      check_scene(read_everywhere(command, communicator), communicator);
      return ExitCode::success;
    case CommandKind::sample: {
      const Scene scene = read_everywhere(command, communicator);
      const std::string folder =
          command.output.empty()
              ? "output/" + std::filesystem::path(command.file).stem().string() + "-sample"
              : command.output;
      require_output_folder(folder, command.force, false, communicator);
      write_sample(scene, folder, command.force, communicator);
      return ExitCode::success;
    }
    case CommandKind::analyze:
      analyze(command.analyze, communicator);
      return ExitCode::success;
    case CommandKind::compare:
      compare(command.compare, communicator);
      return ExitCode::success;
    case CommandKind::info:
      on_rank_zero(communicator, [&] { std::printf("%s", describe(command.file).c_str()); });
      return ExitCode::success;
    case CommandKind::materials:
      on_rank_zero(communicator,
                   [&] { std::printf("%s", describe_materials(command.file).c_str()); });
      return ExitCode::success;
    case CommandKind::keys:
      on_rank_zero(communicator, [] { std::printf("%s", describe_keys().c_str()); });
      return ExitCode::success;
  }
  return ExitCode::system_failure;
}

}  // namespace poreshock
