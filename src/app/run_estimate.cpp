#include "run_estimate.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/core/text.hpp"
#include "poreshock/output/snapshot.hpp"
#include "poreshock/solver/grain_fields.hpp"

namespace poreshock {

namespace {

std::string whole_number(double value) {
  char text[64];
  std::snprintf(text, sizeof text, "%.0f", value);
  return text;
}

std::string gigabytes(double bytes) {
  return significant<3>(bytes * 1e-9) + " GB";
}

/// Mean step of the motion. Behind a plane shock sound is about 1.2 times as fast as at rest and
/// the linear viscosity acts: within a tenth up to 1500 m/s. Where voids collapse or bodies meet,
/// hotter and faster spots make 1.4 to 1.8 times as many steps.
template <int Dim>
double mechanical_step(const Simulation<Dim>& sim) {
  constexpr double shocked = 1.2, rough = 1.6;
  const Scene& scene = sim.scene;
  double rate = 0.0;
  for (const Material& material : sim.materials) {
    const double c = shocked * longitudinal_sound_speed(material);
    const double Q = scene.viscosity.linear * c;
    const double wave = (scene.loading.velocity + Q + std::hypot(Q, c)) / scene.time.cfl;
    const double lone = lone_rate<Dim>(stress_settings(sim), material);
    rate = std::max({rate, wave, scene.loading.velocity + lone * c});
  }
  const bool plane =
      scene.sample.kind == SampleKind::solid && scene.bodies.empty() && scene.voids.empty();
  return scene.domain.cell / (rate * (plane ? 1.0 : rough));
}

/// State, sort order, cell number and one column in flight while particles are
/// reordered, bytes per particle; what is kept for chunks of rows alone does not grow with them.
template <int Dim>
double bytes_of_a_particle(const Simulation<Dim>& sim) {
  double columns = 1.0;
  if (sim.heat) columns += Dim + 1.0;
  return static_cast<double>(bytes_per_particle(sim.particles)) + 8.0 * columns + 8.0;
}

/// Of the maps of one snapshot.
double bytes_of_maps(const Scene& scene) {
  if (!(scene.morphology.every > 0.0)) return 0.0;
  const bool single = scene.output.precision == Precision::single_precision;
  double bytes = static_cast<double>(scene.morphology.fields.size()) * (single ? 4.0 : 8.0);
  for (int axis = 0; axis < scene.dimension; ++axis) {
    bytes *= scene.domain.size[axis] / scene.morphology.pixel;
  }
  return bytes;
}

template <int Dim>
double bytes_of_nodes(const Simulation<Dim>& sim) {
  std::int64_t bytes = 0;
  for (const SlabGrid* grid : {sim.grid.get(), sim.heat.get()}) {
    if (grid != nullptr) bytes += static_cast<std::int64_t>(grid->bytes());
  }
  return static_cast<double>(sum(bytes, sim.communicator));
}

std::string memory_sentence(const Scene& scene, double bytes, const Resources& resources) {
  const double coarser = std::pow(bytes / resources.memory, 1.0 / scene.dimension);
  return "The run needs about " + gigabytes(bytes) + " of memory, here are " +
         gigabytes(resources.memory) + ". Set domain.cell to " +
         significant<3>(scene.domain.cell * coarser) +
         " m or more, lower sample.particles_per_cell, or start on more machines.";
}

/// Steps of this size (s) until the end when each beat is landed on.
double steps_on_beats(const Scene& scene, double step) {
  constexpr double rounding = 1e-9;
  const double beats = std::floor(scene.time.end / scene.output.beat * (1.0 + rounding));
  const double rest = scene.time.end - beats * scene.output.beat;
  const double last = rest > rounding * scene.output.beat ? std::ceil(rest / step) : 0.0;
  return beats * std::ceil(scene.output.beat / step * (1.0 - rounding)) + last;
}

void warn_beat(const Scene& scene, const RunEstimate& estimate,
               std::vector<std::string>& warnings) {
  constexpr double noticed = 1.25, few = 50.0;
  const double step = std::min(estimate.mechanical_step, estimate.conduction_step);
  const double steps = steps_on_beats(scene, step);
  if (steps < noticed * estimate.free_steps || steps < estimate.free_steps + few) return;
  warnings.push_back("output.beat = " + significant<3>(scene.output.beat) +
                     " s sets the time step, which else were about " + significant<3>(step) +
                     " s: steps land on its multiples, and " + whole_number(steps) +
                     " of them reach time.end instead of " + whole_number(estimate.free_steps) +
                     ". Set output.beat to " + significant<3>(10.0 * step) +
                     " s or more; output.snapshot, history and the other cadences are whole "
                     "multiples of it.");
}

void warn_conduction(const Scene& scene, const RunEstimate& estimate,
                     std::vector<std::string>& warnings) {
  constexpr double least_cells = 2.0, least_diameters = 0.2;
  const bool has_voids = scene.sample.kind == SampleKind::random_voids;
  for (const MaterialParameters& m : scene.materials) {
    const double length = diffusion_length(scene, m);
    if (!(length > 0.0)) continue;
    const std::string heat =
        "Heat gets " + significant<3>(length) + " m far in " + m.name + " until the end, ";
    const double cells = length / scene.domain.cell;
    const double diameters = length / (2.0 * scene.sample.void_radius);
    if (scene.conduction.on && cells < least_cells) {
      warnings.push_back(heat + significant<3>(cells) +
                         " cells; below 2 its conduction is not resolved. Set domain.cell to " +
                         significant<3>(length / least_cells) +
                         " m or less, or conduction.on = false.");
    }
    if (!scene.conduction.on && has_voids && diameters > least_diameters) {
      warnings.push_back(
          heat + significant<3>(diameters) +
          " void diameters, and does not flow: hot spots of that size stay too hot. "
          "Set conduction.on = true, or material.conductivity = 0 where it shall not.");
    }
  }
  const double times_smaller = estimate.mechanical_step / estimate.conduction_step;
  if (times_smaller > 2.0) {
    warnings.push_back("Heat conduction makes the time step " + significant<3>(times_smaller) +
                       " times smaller than the motion does. Set domain.cell to " +
                       significant<3>(scene.domain.cell * times_smaller) +
                       " m, where the two are equal, or conduction.on = false.");
  }
}

}  // namespace

void require_memory(const Scene& scene, const Resources& resources) {
  // Of a particle, without what only some schemes keep.
  const double bytes = scene.dimension == 2 ? 200.0 : 300.0;
  const int shock = scene.dimension - 1;
  double cells = scene.sample.kind == SampleKind::none ? 0.0 : scene.sample.height;
  for (int axis = 0; axis < shock; ++axis) cells *= scene.domain.size[axis];
  cells /= std::pow(scene.domain.cell, scene.dimension);
  const double particles = cells * (1.0 - scene.sample.porosity) *
                           std::pow(scene.sample.particles_per_cell, scene.dimension);
  if (particles * bytes > resources.memory) {
    throw InputError(memory_sentence(scene, particles * bytes, resources));
  }
}

double assumed_rate(int dimension) {
  // Half of what a quiet core of 2025 makes (tests/benchmark/README.md).
  return dimension == 2 ? 8.0e6 : 3.0e6;
}

double diffusion_length(const Scene& scene, const MaterialParameters& material) {
  const double diffusivity = material.conductivity / (material.density * material.cv);
  return std::sqrt(4.0 * diffusivity * scene.time.end);
}

template <int Dim>
RunEstimate estimate_run(const Simulation<Dim>& sim) {
  const Scene& scene = sim.scene;
  const auto particles = static_cast<double>(sim.sample.particles);
  RunEstimate e;
  e.mechanical_step = mechanical_step(sim);
  e.conduction_step = sim.conduction_limit;
  const double step = std::min(e.mechanical_step, e.conduction_step);
  e.free_steps = std::ceil(scene.time.end / step);
  e.steps = steps_on_beats(scene, step);
  if (scene.time.max_steps > 0) {
    e.steps = std::min(e.steps, static_cast<double>(scene.time.max_steps));
  }
  e.particle_bytes = bytes_of_a_particle(sim);
  e.memory = particles * e.particle_bytes + bytes_of_nodes(sim);
  e.snapshots = scene.output.snapshot > 0.0
                    ? 1.0 + std::ceil(scene.time.end / scene.output.snapshot * (1.0 - 1e-12))
                    : 2.0;
  const SnapshotInput<Dim> input{scene, sim.scene_text, sim.materials, sim.particles};
  e.snapshot_bytes =
      particles * static_cast<double>(snapshot_bytes_per_particle(input, has_contact(sim))) +
      bytes_of_maps(scene);
  e.checkpoint_bytes = particles * static_cast<double>(bytes_per_particle(sim.particles));
  const Checkpoint& when = scene.checkpoint;
  const bool checkpoints = when.every_steps > 0 || when.every_time > 0.0 || when.every_wall > 0.0;
  // The new one is whole before the oldest goes.
  e.disk = e.snapshots * e.snapshot_bytes +
           (checkpoints ? (static_cast<double>(when.keep) + 1.0) * e.checkpoint_bytes : 0.0);
  e.seconds = particles * e.steps / (assumed_rate(Dim) * size(sim.communicator));
  return e;
}

Resources find_resources(MPI_Comm communicator) {
  MPI_Comm machine = MPI_COMM_NULL;
  check_mpi(MPI_Comm_split_type(communicator, MPI_COMM_TYPE_SHARED, 0, MPI_INFO_NULL, &machine),
            "MPI_Comm_split_type");
  std::int64_t memory = 0;
  if (rank(machine) == 0) {
    memory = std::int64_t{sysconf(_SC_PHYS_PAGES)} * std::int64_t{sysconf(_SC_PAGESIZE)};
  }
  MPI_Comm_free(&machine);
  std::error_code error;
  const auto space = std::filesystem::space(".", error);
  return {static_cast<double>(sum(memory, communicator)),
          error ? INFINITY : static_cast<double>(space.available), size(communicator)};
}

std::vector<std::string> run_warnings(const Scene& scene, const RunEstimate& estimate,
                                      const Resources& resources) {
  constexpr double day = 86400.0;
  std::vector<std::string> warnings;
  warn_beat(scene, estimate, warnings);
  if (scene.transfer.velocity == VelocityTransfer::polyflip) {
    warnings.emplace_back(
        "With transfer.velocity = \"polyflip\" a particle may run away where a jet meets the far "
        "wall "
        "of a void, and the run then stops. Set transfer.velocity = \"aflip\" for samples with "
        "voids.");
  }
  const auto is_smooth = [](const auto& shape) { return shape.smoothness > 0; };
  if (!of_shape(scene.transfer.shape, is_smooth)) {
    warnings.emplace_back(
        "With transfer.shape = \"linear\" runs stop where voids collapse: hats let forces jump "
        "where particles cross cells. Set transfer.shape to \"gimp\" or \"cubic\".");
  }
  warn_conduction(scene, estimate, warnings);
  if (estimate.memory > resources.memory) {
    warnings.push_back(memory_sentence(scene, estimate.memory, resources));
  }
  if (estimate.disk > resources.disk) {
    warnings.push_back("The files of the run need about " + gigabytes(estimate.disk) + ", " +
                       significant<3>(estimate.snapshots) + " snapshots of " +
                       gigabytes(estimate.snapshot_bytes) + " among them; this disk has " +
                       gigabytes(resources.disk) +
                       " left. Raise output.snapshot, name fewer output.fields, set "
                       "output.precision = \"single\", or lower checkpoint.keep.");
  }
  if (estimate.seconds > day) {
    // In 2-D work goes with the third power of the cell, in 3-D with the fourth.
    const double coarser = std::pow(estimate.seconds / day, 1.0 / (scene.dimension + 1));
    warnings.push_back("The run takes about " + significant<3>(estimate.seconds / day) +
                       " days on " + std::to_string(resources.ranks) +
                       " ranks. Start it on more, end it earlier with time.end, or set domain.cell "
                       "to " +
                       significant<3>(scene.domain.cell * coarser) + " m for one day.");
  }
  return warnings;
}

template RunEstimate estimate_run<2>(const Simulation<2>&);
template RunEstimate estimate_run<3>(const Simulation<3>&);

}  // namespace poreshock
