#include "poreshock/run/records.hpp"

#include "maps.hpp"
#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/material/derived.hpp"
#include "poreshock/output/folder.hpp"
#include "poreshock/output/morphology_file.hpp"
#include "poreshock/output/profile_file.hpp"
#include "poreshock/output/snapshot.hpp"
#include "poreshock/output/xdmf.hpp"
#include "poreshock/run/profiles.hpp"
#include "poreshock/solver/check_state.hpp"
#include "poreshock/solver/start.hpp"

namespace poreshock {

namespace {

bool due(std::int64_t beats, std::int64_t beat) {
  return beats > 0 && beat % beats == 0;
}

/// Number of the record at this time: the beat, or the one after the last beat when the run ends
/// between two.
template <int Dim>
std::int64_t record_number(const Simulation<Dim>& sim) {
  const double landed = static_cast<double>(sim.clock.beat) * sim.scene.output.beat;
  return sim.clock.beat + (sim.clock.time - landed > 1e-9 * sim.scene.output.beat ? 1 : 0);
}

template <int Dim>
void write_morphology_record(const PixelField<Dim>& map, Simulation<Dim>& sim,
                             Recorder<Dim>& recorder) {
  const std::vector<MorphologyRecord> records = measure_fields(map, sim);
  const std::int64_t number = record_number(sim);
  const RecordStamp stamp = {number,
                             sim.clock.step,
                             sim.clock.time,
                             sim.scene_text,
                             {{"pixel", sim.scene.morphology.pixel}}};
  const std::string name = morphology_name(number);
  const auto write = [path = recorder.folder + "/" + name, stamp, records,
                      communicator = sim.communicator] {
    write_morphology(path, stamp, records, communicator);
  };
  write_or_wait({name, write}, recorder.backlog, sim.communicator);
}

template <int Dim>
void write_profile_record(Simulation<Dim>& sim, Recorder<Dim>& recorder) {
  const Phase phase(sim.phases, PhaseName::profile);
  std::int64_t floored = 0;
  const Profile profile = measure_profile(sim, floored);
  sim.ledger.guards.temperature += floored;
  const std::int64_t number = record_number(sim);
  const RecordStamp stamp = {number, sim.clock.step, sim.clock.time, sim.scene_text};
  const std::string name = profile_name(number);
  const auto write = [path = recorder.folder + "/" + name, stamp, profile,
                      communicator = sim.communicator] {
    write_profile(path, stamp, profile, communicator);
  };
  write_or_wait({name, write}, recorder.backlog, sim.communicator);
}

template <int Dim>
SnapshotInput<Dim> snapshot_input(const Simulation<Dim>& sim) {
  return {sim.scene,
          sim.scene_text,
          sim.materials,
          sim.particles,
          record_number(sim),
          sim.clock.step,
          sim.clock.time,
          grid_shift(sim),
          particle_colours(sim),
          {},
          sim.window.first * sim.scene.domain.cell};
}

template <int Dim>
void write_history(Simulation<Dim>& sim, Recorder<Dim>& recorder) {
  const Phase phase(sim.phases, PhaseName::history);
  HistoryRow row =
      take_stock(sim.scene, sim.materials, sim.particles, sim.ledger, sim.communicator);
  row.time = sim.clock.time;
  row.step = sim.clock.step;
  row.dt = sim.clock.allowed;
  row.wall_force = mean_wall_force(sim.ledger, Dim, row.time, sim.communicator);
  mark_row(Dim, row.time, sim.ledger);
  if (has_contact(sim)) row.contact = contact_row(sim);
  const auto write = [history = recorder.history, line = history_line(row, Dim)] {
    history->write(line);
  };
  write_or_wait({"a row of history.csv", write}, recorder.backlog, sim.communicator);
  if (!sim.ledger.first_total) sim.ledger.first_total = row.total;
  recorder.last_row = row;
}

template <int Dim>
void write_snapshot_record(const std::optional<PixelField<Dim>>& map, Simulation<Dim>& sim,
                           Recorder<Dim>& recorder) {
  const Phase phase(sim.phases, PhaseName::snapshot);
  const std::string name = snapshot_name(record_number(sim));
  SnapshotInput<Dim> input = snapshot_input(sim);
  if (map) input.maps = snapshot_maps(*map, *recorder.pixels, sim);
  const auto write = [&] {
    const std::int64_t floored =
        write_snapshot<Dim>(recorder.folder + "/" + name, input, sim.communicator);
    if (rank(sim.communicator) == 0) sim.ledger.guards.temperature += floored;
  };
  write_or_leave_out({name, write}, recorder.backlog, sim.communicator);
  const auto list = [folder = recorder.folder, communicator = sim.communicator] {
    write_xdmf(folder, communicator);
  };
  write_or_wait({"snapshots.xdmf", list}, recorder.backlog, sim.communicator);
}

/// The last record of a run is what it was made for: without it the run has not come to its end.
template <int Dim>
void finish_records(const std::string& last_snapshot, MPI_Comm communicator,
                    Recorder<Dim>& recorder) {
  Backlog& backlog = recorder.backlog;
  const bool whole = catch_up(backlog, communicator) &&
                     (backlog.left_out.empty() || backlog.left_out.back() != last_snapshot);
  if (!whole) {
    throw SystemError("the end is reached, but its last records cannot be written: " +
                      (backlog.reason.empty() ? last_snapshot + " did not fit" : backlog.reason) +
                      "; make room and compute the last part again with --restart latest, the " +
                      "newest checkpoint is " + backlog.newest_checkpoint);
  }
  collect_morphology(recorder.folder, communicator);
  collect_profiles(recorder.folder, communicator);
  collect_morphology(recorder.folder, communicator, MapPart::strip);
  sync_records(recorder.folder, recorder.first_unforced, communicator);
}

}  // namespace

template <int Dim>
std::unique_ptr<PixelGrid<Dim>> make_pixels(const Simulation<Dim>& sim) {
  const Scene& scene = sim.scene;
  if (scene.morphology.every <= 0.0) return nullptr;
  if (follows_front(scene)) {
    // A strip that is too thin is better refused now than when it is handed over.
    PixelGrid<Dim>(sim.communicator, map_layout<Dim>(scene, strip_heights(scene).first));
  }
  return std::make_unique<PixelGrid<Dim>>(sim.communicator,
                                          map_layout<Dim>(scene, scene.domain.cells[Dim - 1]));
}

template <int Dim>
Recorder<Dim> make_recorder(const std::string& folder, bool restarted,
                            std::unique_ptr<PixelGrid<Dim>> pixels, const Simulation<Dim>& sim) {
  Recorder<Dim> recorder;
  recorder.folder = folder;
  recorder.history = std::make_shared<RowFile>(
      folder + "/history.csv", history_header(sim), sim.communicator,
      restarted ? std::optional<std::int64_t>(sim.clock.step) : std::nullopt);
  recorder.probes = open_probes(folder, restarted, sim);
  recorder.pixels = std::move(pixels);
  recorder.last_checkpoint_step = sim.clock.step;
  recorder.first_unforced = restarted ? sim.clock.beat : 0;
  return recorder;
}

template <int Dim>
void record(bool last, Simulation<Dim>& sim, Recorder<Dim>& recorder) {
  const Output& output = sim.scene.output;
  const std::int64_t beat = sim.clock.beat;
  const bool all = last || sim.clock.step == 0;
  catch_up(recorder.backlog, sim.communicator);
  write_probe_rows(recorder.probes, recorder.backlog, sim.communicator);
  const bool measures =
      recorder.pixels && (all || due(beats_of(sim.scene.morphology.every, output.beat), beat));
  const bool shows = all || due(beats_of(output.snapshot, output.beat), beat);
  // All others come before the history: what they floor is counted in its row.
  std::optional<PixelField<Dim>> map;
  if (recorder.pixels && (measures || shows)) {
    const Phase phase(sim.phases, PhaseName::morphology);
    map = make_map(*recorder.pixels, sim);
    if (measures) write_morphology_record(*map, sim, recorder);
  }
  const std::int64_t profile = beats_of(sim.scene.profile.every, output.beat);
  if (profile > 0 && (all || due(profile, beat))) write_profile_record(sim, recorder);
  if (shows) write_snapshot_record(map, sim, recorder);
  const std::int64_t history = std::max<std::int64_t>(1, beats_of(output.history, output.beat));
  if (all || due(history, beat)) write_history(sim, recorder);
  if (!last) return;
  finish_records(snapshot_name(record_number(sim)), sim.communicator, recorder);
  finish_probes(recorder.folder, sim, recorder.probes);
}

template <int Dim>
void checkpoint_when_due(double wall_seconds, Simulation<Dim>& sim, Recorder<Dim>& recorder) {
  const Checkpoint& when = sim.scene.checkpoint;
  const std::int64_t beats = beats_of(when.every_time, sim.scene.output.beat);
  bool now = when.every_steps > 0 && sim.clock.step % when.every_steps == 0;
  now = now || (sim.clock.on_beat && due(beats, sim.clock.beat));
  if (when.every_wall > 0.0) {
    // Clocks differ between ranks; rank 0's decides.
    int late = wall_seconds - recorder.last_checkpoint_wall >= when.every_wall ? 1 : 0;
    check_mpi(MPI_Bcast(&late, 1, MPI_INT, 0, sim.communicator), "MPI_Bcast");
    now = now || late == 1;
  }
  if (!now || sim.clock.step == recorder.last_checkpoint_step) return;
  recorder.last_checkpoint_wall = wall_seconds;
  try {
    checkpoint_now(sim, recorder);
  } catch (const SystemError& failure) {
    warn(std::string(failure.what()) +
             "; the run goes on and tries again at the next checkpoint, " + "the newest one is " +
             recorder.backlog.newest_checkpoint,
         sim.communicator);
  }
}

template <int Dim>
std::string checkpoint_now(Simulation<Dim>& sim, Recorder<Dim>& recorder) {
  const Phase phase(sim.phases, PhaseName::checkpoint);
  const std::string name = checkpoint_name(sim.clock.step);
  if (const std::string found = unsound_particles(sim); !found.empty()) {
    throw StateError("at step " + std::to_string(sim.clock.step) +
                     " no checkpoint can be made of " + found +
                     ": look at failed.h5, restart from the newest checkpoint");
  }
  write_probe_rows(recorder.probes, recorder.backlog, sim.communicator);
  // A run that goes on from here writes later records only: the earlier ones come first.
  if (!catch_up(recorder.backlog, sim.communicator)) {
    throw SystemError("cannot write " + name +
                      " before the records that wait: " + recorder.backlog.reason);
  }
  recorder.history->sync();
  for (const ProbeRecorder& probe : recorder.probes) probe.file->sync();
  sync_records(recorder.folder, recorder.first_unforced, sim.communicator);
  recorder.first_unforced = record_number(sim);
  const std::string path = recorder.folder + "/" + name;
  write_checkpoint(path, sim.scene_text, run_state(sim), sim.particles, sim.communicator);
  recorder.backlog.newest_checkpoint = path;
  recorder.last_checkpoint_step = sim.clock.step;
  prune_checkpoints(recorder.folder, sim.scene.checkpoint.keep, sim.communicator);
  return path;
}

template <int Dim>
void write_failed_state(Simulation<Dim>& sim, Recorder<Dim>& recorder) {
  write_probe_rows(recorder.probes, recorder.backlog, sim.communicator);
  try {
    write_snapshot<Dim>(recorder.folder + "/failed.h5", snapshot_input(sim), sim.communicator);
  } catch (const SystemError& failure) {
    warn(std::string(failure.what()) + "; failed.h5 is left out", sim.communicator);
  }
}

template std::unique_ptr<PixelGrid<2>> make_pixels<2>(const Simulation<2>&);
template std::unique_ptr<PixelGrid<3>> make_pixels<3>(const Simulation<3>&);
template Recorder<2> make_recorder<2>(const std::string&, bool, std::unique_ptr<PixelGrid<2>>,
                                      const Simulation<2>&);
template Recorder<3> make_recorder<3>(const std::string&, bool, std::unique_ptr<PixelGrid<3>>,
                                      const Simulation<3>&);
template void record<2>(bool, Simulation<2>&, Recorder<2>&);
template void record<3>(bool, Simulation<3>&, Recorder<3>&);
template void checkpoint_when_due<2>(double, Simulation<2>&, Recorder<2>&);
template void checkpoint_when_due<3>(double, Simulation<3>&, Recorder<3>&);
template std::string checkpoint_now<2>(Simulation<2>&, Recorder<2>&);
template std::string checkpoint_now<3>(Simulation<3>&, Recorder<3>&);
template void write_failed_state<2>(Simulation<2>&, Recorder<2>&);
template void write_failed_state<3>(Simulation<3>&, Recorder<3>&);

}  // namespace poreshock
