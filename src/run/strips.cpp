#include "poreshock/run/strips.hpp"

#include <cmath>

#include "maps.hpp"
#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/files/posix_file.hpp"
#include "poreshock/output/morphology_file.hpp"
#include "poreshock/output/snapshot.hpp"
#include "poreshock/run/profiles.hpp"

namespace poreshock {

namespace {

template <int Dim>
void write_strip_particles(int rows, Simulation<Dim>& sim, Recorder<Dim>& recorder) {
  const Phase phase(sim.phases, PhaseName::snapshot);
  const std::vector<std::uint32_t> places = strip_particles(rows, sim);
  Particles<Dim> strip;
  strip.options = sim.particles.options;
  append(sim.particles, places, strip);
  SnapshotInput<Dim> input{sim.scene,         sim.scene_text, sim.materials,  strip,
                           sim.window.strips, sim.clock.step, sim.clock.time, grid_shift(sim)};
  const std::vector<std::int32_t> colours = particle_colours(sim);
  for (const std::uint32_t p : places) {
    if (!colours.empty()) input.colour.push_back(colours[p]);
  }
  input.bottom = sim.window.first * sim.scene.domain.cell;
  const std::string name = strip_name(sim.window.strips);
  const auto write = [&] {
    const std::int64_t floored =
        write_snapshot<Dim>(recorder.folder + "/" + name, input, sim.communicator);
    if (rank(sim.communicator) == 0) sim.ledger.guards.temperature += floored;
  };
  write_or_leave_out({name, write}, recorder.backlog, sim.communicator);
}

template <int Dim>
void write_strip_morphology(int rows, Simulation<Dim>& sim, Recorder<Dim>& recorder) {
  if (!recorder.pixels) return;
  const Phase phase(sim.phases, PhaseName::morphology);
  // The map begins where the domain does, so that it shows the lowest strip alone.
  const PixelGrid<Dim> pixels(sim.communicator, map_layout<Dim>(sim.scene, rows));
  const PixelField<Dim> map = make_map(pixels, sim);
  const RecordStamp stamp = {sim.window.strips,
                             sim.clock.step,
                             sim.clock.time,
                             sim.scene_text,
                             {{"pixel", sim.scene.morphology.pixel}}};
  const std::string name = morphology_name(sim.window.strips, MapPart::strip);
  const auto write = [path = recorder.folder + "/" + name, stamp,
                      records = measure_fields(map, sim), communicator = sim.communicator] {
    write_morphology(path, stamp, records, communicator, MapPart::strip);
  };
  write_or_wait({name, write}, recorder.backlog, sim.communicator);
}

/// Throws where the rows above the strip, a quarter of the domain, still move much like what lies
/// ahead of the front.
template <int Dim>
void require_shocked(int rows, Simulation<Dim>& sim) {
  constexpr double most = 0.25;
  const Scene& scene = sim.scene;
  const double ahead = scene.loading.frame[Dim - 1] - scene.loading.velocity;
  const double behind = scene.loading.frame[Dim - 1] + scene.boundary.low.velocity;
  std::int64_t floored = 0;
  const Profile profile = measure_profile(sim, floored);
  double sum = 0.0, count = 0.0;
  for (int j = rows; j < rows + scene.domain.cells[Dim - 1] / 4; ++j) {
    const double v = profile.velocity[Dim - 1][static_cast<std::size_t>(j)];
    if (std::isnan(v)) continue;
    sum += (v - behind) / (ahead - behind);
    count += 1.0;
  }
  if (!(sum > most * count)) return;
  throw StateError(
      "at step " + std::to_string(sim.clock.step) + ", time " +
      std::to_string(sim.clock.time * 1e9) +
      " ns, waves ahead of the front have come to the top of the domain, but the front is not yet "
      "far above its lowest rows: the domain is too low to hold both. Set domain.size higher along "
      "the shock axis, or time.end earlier.");
}

}  // namespace

std::string strip_name(std::int64_t strip) {
  return numbered_name("handed_over_", strip, 6, ".h5");
}

template <int Dim>
void leave_strip(Simulation<Dim>& sim, Recorder<Dim>& recorder) {
  const int rows = best_strip(sim);
  require_shocked(rows, sim);
  write_strip_morphology(rows, sim, recorder);
  write_strip_particles(rows, sim, recorder);
  hand_over(rows, sim);
}

template void leave_strip<2>(Simulation<2>&, Recorder<2>&);
template void leave_strip<3>(Simulation<3>&, Recorder<3>&);

}  // namespace poreshock
