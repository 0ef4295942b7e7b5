#include "poreshock/app/commands.hpp"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <string_view>

#include "poreshock/app/check.hpp"
#include "poreshock/app/reference.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/core/stop_signal.hpp"
#include "poreshock/output/checkpoint.hpp"
#include "poreshock/output/folder.hpp"
#include "poreshock/output/info.hpp"
#include "poreshock/output/posix_file.hpp"
#include "poreshock/output/rank_zero.hpp"
#include "poreshock/scene/compare_scenes.hpp"
#include "poreshock/scene/read_scene.hpp"
#include "poreshock/solver/run.hpp"

namespace poreshock {

namespace {

void declare_scene(Command& command, CLI::App& app) {
  app.add_option("scene", command.file, "scene file (TOML)")->required();
  app.add_option("--set", command.overrides, "override a key, for example --set time.end=2e-7");
}

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
    require_same_run(scene, checkpoint_header(options.restart, communicator), options.restart,
                     options.continues);
  }
  require_output_folder(options.folder, options.force, options.continues, communicator);
  catch_stop_signals();
  scene.dimension == 2 ? run<2>(scene, options, communicator)
                       : run<3>(scene, options, communicator);
  return ExitCode::success;
}

void declare_analyze(Command& command, CLI::App& app) {
  AnalyzeOptions& options = command.analyze;
  CLI::App* analyze = app.add_subcommand("analyze", "morphology of stored fields");
  analyze->add_option("files", options.files, "snapshots, FILE.npy or FILE.h5:/path")->required();
  analyze->add_option("--thresholds", options.thresholds, "FROM:TO:STEP or A,B,C");
  analyze->add_option("--quantiles", options.quantiles,
                      "instead: shares of the material below each threshold, written the same way");
  analyze->add_option("--voids", options.voids, "in chi: black (default), white, fill or exclude");
  analyze->add_flag("--isoline", options.isoline,
                    "lengths (3-D: areas) of interpolated boundaries too");
  analyze->add_option("--hot-spots", options.hot_spots,
                      "thresholds at which every hot spot is listed, written the same way");
  analyze->add_option("--field", options.field,
                      "field of a snapshot (default temperature), name of an array");
  analyze->add_option("--mask", options.mask, "array, not zero = material (default: not NaN)");
  analyze->add_option("--periodic", options.periodic, "lateral axes of an array that wrap: x, y");
  analyze->add_option("--pixel", options.pixel, "side of a pixel in metres");
  analyze->add_option("--output", options.output, "folder for morphology.h5");
  analyze->add_flag("--force", options.force, "replace our files in an existing output folder");
  analyze->callback([&command] { command.kind = CommandKind::analyze; });
}

void declare_compare(Command& command, CLI::App& app) {
  CompareOptions& options = command.compare;
  CLI::App* compare = app.add_subcommand("compare", "similarity of runs from their morphology");
  compare
      ->add_option("runs", options.runs,
                   "output folders, or morphology files; the first one is "
                   "the reference")
      ->required();
  compare->add_option("--field", options.field, "field (default temperature)");
  compare->add_option("--threshold", options.threshold,
                      "thresholds of the reference, A,B,C (default all that it measured)");
  compare->add_option(
      "--window", options.window,
      "BEGIN:END in seconds, or slower (default) or faster: to that run's end of loading");
  compare->add_option("--time", options.time,
                      "common (default), or loading: in units of each run's own loading time");
  compare->add_option("--chi", options.chi, "chi (default), chi4, chi6 or chi_paper");
  compare->add_option("--length", options.length,
                      "unit of length in metres (default: the pixel, the same in all runs)");
  compare->add_option("--output", options.output, "file to write, .h5 or .csv");
  compare->callback([&command] { command.kind = CommandKind::compare; });
}

}  // namespace

void declare(Command& command, CLI::App& app) {
  CLI::App* run = app.add_subcommand("run", "run a scene");
  declare_scene(command, *run);
  run->add_option("--output", command.output, "output folder (default output/<scene>)");
  run->add_option("--restart", command.restart, "checkpoint file, or latest");
  run->add_option("--wall-time", command.wall_limit,
                  "seconds after which to write a checkpoint and stop");
  run->add_flag("--force", command.force, "replace our files in an existing output folder");
  CLI::Option* quiet =
      run->add_flag("--quiet", command.quiet, "no progress rows, no table of timings");
  run->add_flag("--verbose", command.verbose,
                "a progress row for every output.beat, not only on a terminal")
      ->excludes(quiet);
  run->callback([&command] { command.kind = CommandKind::run; });
  CLI::App* check = app.add_subcommand("check", "say what a scene means, run nothing");
  declare_scene(command, *check);
  check->callback([&command] { command.kind = CommandKind::check; });
  CLI::App* sample = app.add_subcommand("sample", "make the sample and write it as a snapshot");
  declare_scene(command, *sample);
  sample->add_option("--output", command.output, "output folder (default output/<scene>-sample)");
  sample->add_flag("--force", command.force, "replace our files in an existing output folder");
  sample->callback([&command] { command.kind = CommandKind::sample; });
  declare_analyze(command, app);
  declare_compare(command, app);
  CLI::App* info = app.add_subcommand("info", "say what a file of this program holds");
  info->add_option("file", command.file, "HDF5 or CSV file")->required();
  info->callback([&command] { command.kind = CommandKind::info; });
  CLI::App* materials = app.add_subcommand("materials", "list the materials of the library");
  materials->add_option("name", command.file, "one of them, with all its numbers");
  materials->callback([&command] { command.kind = CommandKind::materials; });
  CLI::App* keys = app.add_subcommand("keys", "list all keys of a scene as Markdown");
  keys->callback([&command] { command.kind = CommandKind::keys; });
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
