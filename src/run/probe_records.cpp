#include <cstdio>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/core/rank_zero.hpp"
#include "poreshock/run/probes.hpp"
#include "poreshock/run/trace.hpp"

namespace poreshock {

namespace {

/// Throws when the probe has nothing to look at.
void require_target(const Probe& probe, const ProbeTarget& target) {
  if (probe.kind == ProbeKind::point || !target.ids.empty()) return;
  throw InputError("probe \"" + probe.name +
                   "\": no material starts where it looks; allowed is a place in a body or the "
                   "sample (particle), "
                   "or with one below it (surface, interface; above it with faces = \"down\"). "
                   "Move probe.at, or "
                   "make probe.width larger");
}

/// rho c0 of the material of a free surface; NaN when it looks at several, and inside of a
/// material, at an interface or before a window, whose fall tells no strength.
double impedance(const Probe& probe, const ProbeTarget& target, const Scene& scene) {
  const auto& side = probe.faces == Facing::up ? scene.boundary.high : scene.boundary.low;
  const bool free = probe.kind == ProbeKind::surface && target.material >= 0 && side.behind.empty();
  if (!free) return std::numeric_limits<double>::quiet_NaN();
  const MaterialParameters& m = scene.materials[static_cast<std::size_t>(target.material)];
  return m.density * m.c0;
}

std::vector<TraceFigure> figures_of(const TraceFigures& f) {
  return {{"arrival", "s", f.arrival},
          {"jump_off", "m/s", f.jump_off},
          {"pull_back", "m/s", f.pull_back},
          {"pull_back_time", "s", f.pull_back_time},
          {"spall_strength", "Pa", f.spall_strength}};
}

void print_figures(const std::string& name, const TraceFigures& f) {
  std::printf("probe %s: ", name.c_str());
  if (!(f.jump_off > 0.0)) {
    std::printf("nothing has arrived\n");
    return;
  }
  std::printf("arrival %.6g ns, jump-off %.6g m/s", f.arrival * 1e9, f.jump_off);
  if (f.pull_back > 0.0) {
    std::printf(", pull-back %.4g m/s at %.6g ns", f.pull_back, f.pull_back_time * 1e9);
  }
  if (f.spall_strength > 0.0) std::printf(", spall strength %.4g GPa", f.spall_strength * 1e-9);
  std::printf("\n");
}

}  // namespace

template <int Dim>
void require_targets(const Simulation<Dim>& sim) {
  for (const Probe& probe : sim.scene.probes) require_target(probe, find_target(probe, sim));
}

template <int Dim>
std::vector<ProbeRecorder> open_probes(const std::string& folder, bool restarted,
                                       const Simulation<Dim>& sim) {
  std::vector<ProbeRecorder> probes;
  for (const Probe& probe : sim.scene.probes) {
    ProbeRecorder& recorder = probes.emplace_back();
    recorder.probe = probe;
    recorder.target = find_target(probe, sim);
    recorder.file = std::make_shared<RowFile>(
        folder + "/" + probe_file_name(probe.name), probe_header(Dim), sim.communicator,
        restarted ? std::optional<std::int64_t>(sim.clock.step) : std::nullopt);
  }
  return probes;
}

template <int Dim>
void note_probes(const Simulation<Dim>& sim, std::vector<ProbeRecorder>& probes) {
  for (ProbeRecorder& recorder : probes) {
    if (recorder.probe.every == Cadence::beat && !sim.clock.on_beat) continue;
    const std::string line = probe_line(look(recorder.probe, sim, recorder.target), Dim);
    recorder.rows.append(recorder.rows.empty() ? "" : "\n").append(line);
  }
}

void write_probe_rows(std::vector<ProbeRecorder>& probes, Backlog& backlog, MPI_Comm communicator) {
  for (ProbeRecorder& recorder : probes) {
    if (recorder.rows.empty()) continue;
    const auto write = [file = recorder.file, rows = std::move(recorder.rows)] {
      file->write(rows);
    };
    recorder.rows.clear();
    write_or_wait({"rows of " + probe_file_name(recorder.probe.name), write}, backlog,
                  communicator);
  }
}

template <int Dim>
void finish_probes(const std::string& folder, const Simulation<Dim>& sim,
                   const std::vector<ProbeRecorder>& probes) {
  if (probes.empty()) return;
  on_rank_zero(sim.communicator, [&] {
    std::map<std::string, ProbeRecord> records;
    for (const ProbeRecorder& recorder : probes) {
      const std::string& name = recorder.probe.name;
      ProbeRecord& record = records[name];
      record.trace = read_trace(folder + "/" + probe_file_name(name));
      const TraceFigures figures =
          read_figures(column(record.trace, "time"),
                       column(record.trace, Dim == 2 ? "velocity_y" : "velocity_z"),
                       impedance(recorder.probe, recorder.target, sim.scene));
      record.figures = figures_of(figures);
      print_figures(name, figures);
    }
    const RecordStamp stamp = {0, sim.clock.step, sim.clock.time, sim.scene_text};
    write_probes(folder + "/probes.h5", stamp, records);
  });
}

template void require_targets<2>(const Simulation<2>&);
template void require_targets<3>(const Simulation<3>&);
template std::vector<ProbeRecorder> open_probes<2>(const std::string&, bool, const Simulation<2>&);
template std::vector<ProbeRecorder> open_probes<3>(const std::string&, bool, const Simulation<3>&);
template void note_probes<2>(const Simulation<2>&, std::vector<ProbeRecorder>&);
template void note_probes<3>(const Simulation<3>&, std::vector<ProbeRecorder>&);
template void finish_probes<2>(const std::string&, const Simulation<2>&,
                               const std::vector<ProbeRecorder>&);
template void finish_probes<3>(const std::string&, const Simulation<3>&,
                               const std::vector<ProbeRecorder>&);

}  // namespace poreshock
