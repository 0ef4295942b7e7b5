#include "poreshock/app/commands.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>

#include "poreshock/app/check.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/core/stop_signal.hpp"
#include "poreshock/output/checkpoint.hpp"
#include "poreshock/output/folder.hpp"
#include "poreshock/output/info.hpp"
#include "poreshock/output/posix_file.hpp"
#include "poreshock/output/rank_zero.hpp"
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

/// On restart only the end, the output, the checkpoints and the morphology may differ.
void require_same_physics(const Scene& now, const std::string& stored_text,
                          const std::string& path) {
  Scene stored = parse_scene(stored_text, path);
  stored.title = now.title;
  stored.time.end = now.time.end;
  stored.time.max_steps = now.time.max_steps;
  const double beat = stored.output.beat;
  stored.output = now.output;
  stored.output.beat = beat;
  stored.checkpoint = now.checkpoint;
  stored.morphology = now.morphology;
  if (stored == now) return;
  throw InputError(path +
                   " was written by a scene that differs in more than its end time, output, "
                   "checkpoint and morphology settings: restart with the scene.toml beside it, or "
                   "start a new run");
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

ExitCode execute_run(const Command& command, MPI_Comm communicator) {
  const Scene scene = read_everywhere(command, communicator);
  RunOptions options;
  options.folder = command.output.empty()
                       ? "output/" + std::filesystem::path(command.file).stem().string()
                       : command.output;
  options.wall_limit = command.wall_limit;
  options.force = command.force;
  options.quiet = command.quiet;
  Command resolved = command;
  resolved.output = options.folder;
  if (!command.restart.empty()) {
    options.restart = restart_path(resolved, communicator);
    options.continues = lies_in(options.restart, options.folder);
    const CheckpointHeader header = checkpoint_header(options.restart, communicator);
    require_same_physics(scene, header.scene_text, options.restart);
  }
  require_output_folder(options.folder, options.force, options.continues, communicator);
  catch_stop_signals();
  scene.dimension == 2 ? run<2>(scene, options, communicator)
                       : run<3>(scene, options, communicator);
  return ExitCode::success;
}

}  // namespace

void declare(Command& command, CLI::App& app) {
  CLI::App* run = app.add_subcommand("run", "run a scene");
  declare_scene(command, *run);
  run->add_option("--output", command.output, "output folder (default output/<scene>)");
  run->add_option("--restart", command.restart, "checkpoint file, or latest");
  run->add_option("--wall-time", command.wall_limit,
                  "seconds after which to write a checkpoint and stop")
      ->check(CLI::NonNegativeNumber);
  run->add_flag("--force", command.force, "replace our files in an existing output folder");
  run->add_flag("--quiet", command.quiet, "no progress rows");
  run->callback([&command] { command.kind = CommandKind::run; });
  CLI::App* check = app.add_subcommand("check", "say what a scene means, run nothing");
  declare_scene(command, *check);
  check->callback([&command] { command.kind = CommandKind::check; });
  CLI::App* sample = app.add_subcommand("sample", "make the sample and write it as a snapshot");
  declare_scene(command, *sample);
  sample->add_option("--output", command.output, "output folder (default output/<scene>-sample)");
  sample->add_flag("--force", command.force, "replace our files in an existing output folder");
  sample->callback([&command] { command.kind = CommandKind::sample; });
  CLI::App* info = app.add_subcommand("info", "say what a file of this program holds");
  info->add_option("file", command.file, "HDF5 or CSV file")->required();
  info->callback([&command] { command.kind = CommandKind::info; });
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
    case CommandKind::info:
      on_rank_zero(communicator, [&] { std::printf("%s", describe(command.file).c_str()); });
      return ExitCode::success;
  }
  return ExitCode::system_failure;
}

}  // namespace poreshock
