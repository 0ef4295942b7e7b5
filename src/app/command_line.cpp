#include "poreshock/app/command_line.hpp"

#include <CLI/CLI.hpp>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>

#include "poreshock/app/build_information.hpp"

namespace poreshock {

namespace {

/// An option with nothing for a value is a slip, most often a variable of a script that is not set.
void require_value(CLI::Option* option) {
  option->check(CLI::Validator(
      [](const std::string& value) {
        return std::string(
            value.empty() ? "found an empty text; give a value, or leave the option out" : "");
      },
      ""));
}

void require_values(CLI::App& app) {
  for (CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    for (CLI::Option* option : command->get_options()) {
      if (option->get_items_expected_max() > 0) require_value(option);
    }
  }
}

void declare_scene(Command& command, CLI::App& app) {
  app.add_option("scene", command.file, "scene file (TOML)")->required();
  app.add_option("--set", command.overrides, "override a key, for example --set time.end=2e-7");
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
  analyze->add_option("--mask", options.mask,
                      "array, not zero = material; NaN of the file is void in any case");
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

void declare_all(Command& command, CLI::App& app) {
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
  require_values(app);
}

/// Names what stands where a command should; CLI11 only says that one is missing.
int refuse_command(const CLI::App& app) {
  std::string allowed;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    allowed.append(allowed.empty() ? "" : ", ").append(command->get_name());
  }
  std::fprintf(stderr, "poreshock: unknown command \"%s\", allowed %s; see --help\n",
               app.remaining().front().c_str(), allowed.c_str());
  return static_cast<int>(ExitCode::bad_input);
}

}  // namespace

std::optional<int> read_command_line(int argc, char** argv, Command& command) {
  CLI::App app{"poreshock: strong shocks in porous and granular solids"};
  app.set_version_flag("--version", build_information());
  app.require_subcommand(1);
  app.prefix_command(false);
  declare_all(command, app);
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
    return app.exit(error) == 0 ? 0 : static_cast<int>(ExitCode::bad_input);
  }
  return std::nullopt;
}

}  // namespace poreshock
