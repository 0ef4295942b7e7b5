#include "poreshock/run/run.hpp"

#include <cstdio>
#include <filesystem>

#include "energy.hpp"
#include "poreshock/core/error.hpp"
#include "poreshock/core/memory.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/core/rank_zero.hpp"
#include "poreshock/core/stop_signal.hpp"
#include "poreshock/files/posix_file.hpp"
#include "poreshock/output/folder.hpp"
#include "poreshock/output/morphology_file.hpp"
#include "poreshock/output/profile_file.hpp"
#include "poreshock/run/checksum.hpp"
#include "poreshock/run/profiles.hpp"
#include "poreshock/run/progress.hpp"
#include "poreshock/run/records.hpp"
#include "poreshock/run/start_warnings.hpp"
#include "poreshock/run/strips.hpp"
#include "poreshock/sample/fill.hpp"
#include "poreshock/scene/read_scene.hpp"
#include "poreshock/solver/ownership.hpp"
#include "poreshock/solver/sleep.hpp"
#include "poreshock/solver/start.hpp"
#include "poreshock/solver/window.hpp"

namespace poreshock {

namespace {

constexpr std::int64_t rebalance_interval = 100;
/// Steps after which freed memory goes back to the system.
constexpr std::int64_t release_interval = 10;
constexpr double seconds_between_rows = 2.0;

/// Refuses records that this run could not go on with, before any is cut.
template <int Dim>
void require_same_records(const std::string& folder, const Simulation<Dim>& sim) {
  require_rows(folder + "/history.csv", history_header(sim), sim.communicator);
  for (const Probe& probe : sim.scene.probes) {
    require_rows(folder + "/" + probe_file_name(probe.name), probe_header(Dim), sim.communicator);
  }
  if (!(sim.scene.profile.every > 0.0)) return;
  std::int64_t floored = 0;
  require_same_profiles(folder, measure_profile(sim, floored), sim.communicator);
}

/// A file there that means the same scene stays, with the comments it may have got.
template <int Dim>
void write_scene_file(const std::string& folder, const Simulation<Dim>& sim) {
  const std::string path = folder + "/scene.toml";
  try {
    if (std::filesystem::exists(path) && parse_scene(read_text(path), path) == sim.scene) return;
  } catch (const InputError&) {
    // Of another version, or damaged: replaced.
  }
  write_text(path, sim.scene_text);
}

/// Prints what can hardly be meant; returns it with what `check` says of the sample. Collective.
template <int Dim>
std::vector<std::string> warn_of_start(const Simulation<Dim>& sim) {
  std::vector<std::string> warnings = start_warnings(sim);
  for (const std::string& warning : warnings) warn(warning, sim.communicator);
  const std::vector<std::string> more = sample_warnings(sim.scene, sim.sample);
  warnings.insert(warnings.end(), more.begin(), more.end());
  return warnings;
}

/// True when nothing is left to compute. Not collective.
bool at_end(const TimeControl& limits, const Clock& clock) {
  return clock.time >= limits.end || (limits.max_steps > 0 && clock.step >= limits.max_steps);
}

/// Prints a row when one is due; rank 0's clock decides. Collective.
template <int Dim>
void show_progress(ProgressRows rows, const Simulation<Dim>& sim, const Recorder<Dim>& recorder,
                   Progress& progress) {
  if (rows == ProgressRows::none) return;
  const double wall = MPI_Wtime() - progress.start_wall;
  const bool waited = wall - progress.to_go.row.wall >= seconds_between_rows;
  int late = (rows == ProgressRows::every_beat ? sim.clock.on_beat : waited) ? 1 : 0;
  check_mpi(MPI_Bcast(&late, 1, MPI_INT, 0, sim.communicator), "MPI_Bcast");
  if (late == 0) return;
  const std::string row =
      progress_row(sim.clock, sim.scene.time.end, energy_status(sim.ledger, recorder.last_row),
                   sim.phases, progress, sim.communicator);
  if (rank(sim.communicator) == 0) std::printf("%s\n", row.c_str()), std::fflush(stdout);
}

/// Step limit, health and stop requests of all ranks; true when the run has been asked to stop.
/// Throws StateError. Collective.
template <int Dim>
bool synchronise(const RunOptions& options, const Progress& progress, Simulation<Dim>& sim) {
  const Phase phase(sim.phases, PhaseName::time_step);
  const double wall = MPI_Wtime() - progress.start_wall;
  const bool out_of_time = options.wall_limit > 0.0 && wall > options.wall_limit;
  const StepAgreement agreement =
      agree_on_step(stop_signal_arrived() || out_of_time, sim.clock, sim.communicator);
  if (agreement.bad_state) {
    throw StateError("at step " + std::to_string(sim.clock.step) + ", time " +
                     std::to_string(sim.clock.time * 1e9) +
                     " ns, particles have a state that is not finite or were turned inside out: "
                     "look at failed.h5, try a smaller time.cfl or a larger viscosity.linear");
  }
  return agreement.stop_asked;
}

/// One step with its housekeeping; true when the run has been asked to stop.
template <int Dim>
bool step(const RunOptions& options, Simulation<Dim>& sim, Recorder<Dim>& recorder,
          Progress& progress) {
  const double dt = next_time_step(sim.scene, sim.clock);
  advance(sim, dt);
  progress.particle_steps += static_cast<std::int64_t>(sim.particles.size());
  progress.sleeping_steps += sleeping_particles(sim.cells, *sim.grid);
  tick(sim.scene, dt, sim.clock);
  // First of all: a checkpoint keeps the limit of all ranks, and a position that is not finite has
  // no row to go to.
  const bool stop_asked = synchronise(options, progress, sim);
  migrate(sim);
  while (must_hand_over(sim)) leave_strip(sim, recorder);
  take_in(sim);
  const bool may_rebalance = sim.clock.step % rebalance_interval == 0;
  if (may_rebalance) rebalance(sim);
  if (may_rebalance || sim.clock.on_beat) note_memory(sim.communicator, progress);
  return stop_asked;
}

template <int Dim>
void finish(RunEnd end, const RunOptions& options, Simulation<Dim>& sim, Recorder<Dim>& recorder,
            Progress& progress) {
  const std::uint64_t bits = checksum(sim);
  const Timings timings = final_timings(sim.clock, sim.phases, sim.work,
                                        std::ssize(sim.particles.id), progress, sim.communicator);
  try {
    write_timings(options.folder + "/timings.json", timings, sim.communicator);
  } catch (const SystemError& failure) {
    warn(std::string(failure.what()) + "; timings.json is left out", sim.communicator);
  }
  const Ledger& l = sim.ledger;
  std::vector<std::int64_t> counts = {l.escaped.particles, l.shortened};
  for (const GuardCounter& guard : guard_counters) counts.push_back(l.guards.*guard.count);
  sum(counts, sim.communicator);
  std::vector<Int128> escaped = {l.escaped.mass};
  sum(escaped, sim.communicator);
  if (rank(sim.communicator) != 0) return;
  if (!options.quiet) std::printf("\n%s", timings_table(timings).c_str());
  std::string guards;
  for (std::size_t k = 0; k < guard_counters.size(); ++k) {
    guards += std::string(k == 0 ? "" : ", ") + guard_counters[k].name + " " +
              std::to_string(counts[k + 2]);
  }
  std::printf("energy drift %.1e, guards: %s; escaped particles %lld (%.6g %s); checksum %016llx\n",
              energy_status(sim.ledger, recorder.last_row).drift, guards.c_str(),
              static_cast<long long>(counts[0]), static_cast<double>(escaped[0]) * mass_quantum(l),
              Dim == 2 ? "kg/m" : "kg", static_cast<unsigned long long>(bits));
  show_heat(recorder.last_row, sim.scene, static_cast<long long>(counts[1]));
  for (const std::string& name : recorder.backlog.left_out) {
    std::printf("left out: %s\n", name.c_str());
  }
  std::printf("%s at step %lld, time %.6g ns, in %s\n",
              end == RunEnd::finished ? "finished" : "stopped",
              static_cast<long long>(sim.clock.step), sim.clock.time * 1e9, options.folder.c_str());
  std::fflush(stdout);
}

/// The checkpoint of a run that was asked to stop; without it the run ends as a failure.
template <int Dim>
void stop_with_checkpoint(Simulation<Dim>& sim, Recorder<Dim>& recorder) {
  std::string path;
  try {
    path = checkpoint_now(sim, recorder);
  } catch (const SystemError& failure) {
    throw SystemError(
        "asked to stop, but no checkpoint can be written: " + std::string(failure.what()) +
        "; the newest checkpoint is " + recorder.backlog.newest_checkpoint);
  }
  if (rank(sim.communicator) == 0) {
    std::printf("asked to stop: checkpoint %s; continue with --restart latest\n", path.c_str());
  }
}

/// The output folder, locked, with its scene and without what the run will write again. Collective.
template <int Dim>
std::unique_ptr<FolderLock> open_folder(const RunOptions& options, const Simulation<Dim>& sim) {
  const std::string& folder = options.folder;
  auto lock = prepare_output_folder(folder, options.force, options.continues, sim.communicator);
  on_rank_zero(sim.communicator, [&] { write_scene_file(folder, sim); });
  if (options.continues) remove_checkpoints_after(folder, sim.clock.step, sim.communicator);
  // A run that is already at its end writes no records again.
  if (!options.restart.empty() && !at_end(sim.scene.time, sim.clock)) {
    remove_morphology_from(folder, sim.clock.beat + 1, sim.communicator);
    remove_profiles_from(folder, sim.clock.beat + 1, sim.communicator);
    remove_records_from(folder, sim.clock.beat + 1, sim.communicator);
  }
  return lock;
}

template <int Dim>
RunEnd time_loop(const RunOptions& options, Simulation<Dim>& sim, Recorder<Dim>& recorder,
                 Progress& progress) {
  const TimeControl& limits = sim.scene.time;
  if (options.restart.empty()) {
    note_probes(sim, recorder.probes);
    record(false, sim, recorder);
  }
  bool stop_asked = synchronise(options, progress, sim);
  while (!at_end(limits, sim.clock)) {
    if (stop_asked) {
      stop_with_checkpoint(sim, recorder);
      return RunEnd::stopped;
    }
    stop_asked = step(options, sim, recorder, progress);
    note_probes(sim, recorder.probes);
    const bool last = at_end(limits, sim.clock);
    const bool records = sim.clock.on_beat || last;
    if (records) {
      record(last, sim, recorder);
      require_closed_ledger(sim, recorder.last_row);
    }
    // A record frees much at once, which would lie in the heap through the steps that follow.
    if (records || sim.clock.step % release_interval == 0) release_freed_memory();
    checkpoint_when_due(MPI_Wtime() - progress.start_wall, sim, recorder);
    show_progress(options.rows, sim, recorder, progress);
  }
  return RunEnd::finished;
}

}  // namespace

template <int Dim>
RunEnd run(const Scene& scene, const RunOptions& options, MPI_Comm communicator) {
  Progress progress;
  progress.start_wall = MPI_Wtime();
  progress.start_memory = peak_memory();
  progress.start_own = own_memory();
  const bool restarted = !options.restart.empty();
  Simulation<Dim> sim = restarted ? resume<Dim>(scene, options.restart, communicator)
                                  : start<Dim>(scene, communicator);
  if (!restarted) {
    require_targets(sim);
    progress.warnings = warn_of_start(sim);
  }
  // The map's rows may not suffice for the ranks, which is better said before anything is removed.
  std::unique_ptr<PixelGrid<Dim>> pixels = make_pixels(sim);
  if (options.continues) require_same_records(options.folder, sim);
  // Not before: a sample that cannot be made and a damaged checkpoint cost no earlier result.
  const auto lock = open_folder(options, sim);
  Recorder<Dim> recorder = make_recorder(options.folder, restarted, std::move(pixels), sim);
  if (options.continues) recorder.backlog.newest_checkpoint = options.restart;
  progress.to_go.start = {sim.clock.time, sim.clock.step, MPI_Wtime() - progress.start_wall};
  progress.to_go.row = progress.to_go.start;
  progress.to_go.asleep = sleeping_weight(sim);
  if (rank(communicator) == 0 && options.rows != ProgressRows::none) {
    std::printf("%s\n", progress_header().c_str());
  }
  try {
    const RunEnd end = time_loop(options, sim, recorder, progress);
    finish(end, options, sim, recorder, progress);
    return end;
  } catch (const StateError&) {
    write_failed_state(sim, recorder);
    throw;
  }
}

template RunEnd run<2>(const Scene&, const RunOptions&, MPI_Comm);
template RunEnd run<3>(const Scene&, const RunOptions&, MPI_Comm);

}  // namespace poreshock
