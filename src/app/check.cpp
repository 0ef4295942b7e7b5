#include "poreshock/app/check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "poreshock/core/parallel.hpp"
#include "poreshock/output/folder.hpp"
#include "poreshock/output/snapshot.hpp"
#include "poreshock/output/xdmf.hpp"
#include "poreshock/scene/read_scene.hpp"
#include "poreshock/solver/simulation.hpp"

namespace poreshock {

namespace {

/// Rate the estimate of the run time assumes, particle-steps per second per core, 2-D and 3-D.
constexpr double assumed_rate[2] = {4.0e6, 1.0e6};

/// Typical step of the motion: the shocked sound speed is about 1.2 times the initial one.
double mechanical_step(const Scene& scene) {
  double speed = 0.0;
  for (const MaterialParameters& m : scene.materials) {
    speed = std::max(speed, longitudinal_sound_speed(make_material(m)));
  }
  return scene.time.cfl * scene.domain.cell / (1.2 * speed + scene.loading.velocity);
}

/// How far heat gets until the end, beside the size of the voids; nothing without conduction.
void print_conduction(const Scene& scene, double mechanical, double limit) {
  if (!scene.conduction.on) return;
  if (!conducts_heat(scene)) {
    std::printf("heat conduction         none: every material.conductivity is 0\n");
    return;
  }
  for (const MaterialParameters& m : scene.materials) {
    const double a = m.conductivity / (m.density * m.cv);
    const double length = std::sqrt(4.0 * a * scene.time.end);
    std::printf("diffusion length        %.3g m in %s until the end, %.2g cells", length,
                m.name.c_str(), length / scene.domain.cell);
    if (scene.sample.kind == SampleKind::random_voids) {
      std::printf(", %.2g void diameters", length / (2.0 * scene.sample.void_radius));
    }
    std::printf("\n");
  }
  std::printf("step of heat conduction at most %.3g s, %s the motion's\n", limit,
              limit < mechanical ? "below" : "above");
}

void print_sample(const Scene& scene, const SampleReport& report) {
  if (scene.sample.kind == SampleKind::random_voids) {
    std::printf("voids                   %zu, void fraction %.6f (asked %.6f), least gap %.3g m\n",
                report.voids.size(), report.geometric_void_fraction, scene.sample.porosity,
                report.least_gap);
    std::printf("void fraction of the particles  %.6f\n", report.particle_void_fraction);
    std::printf("cells per void diameter %.1f\n",
                2.0 * scene.sample.void_radius / scene.domain.cell);
    if (report.islands > 0) {
      std::printf("floating islands %s %lld, with %lld particles\n",
                  scene.sample.islands == Islands::grains ? "made grains" : "removed",
                  static_cast<long long>(report.islands),
                  static_cast<long long>(report.island_particles));
    }
  }
  if (makes_grains(scene.sample.kind)) {
    std::printf("grains                  %zu, void fraction %.6f", report.grains.size(),
                report.geometric_void_fraction);
    if (scene.sample.kind != SampleKind::image) {
      std::printf(" (asked %.6f), least gap %.3g m", scene.sample.porosity, report.least_gap);
    }
    std::printf("\nvoid fraction of the particles  %.6f\n", report.particle_void_fraction);
  }
  std::printf("particles               %lld\n", static_cast<long long>(report.particles));
  for (const std::string& warning : sample_warnings(scene, report)) {
    std::printf("warning: %s\n", warning.c_str());
  }
}

/// State, averaged pressure, sort order, cell number and one column in flight while particles are
/// reordered, bytes per particle; what is kept for chunks of rows alone does not grow with them.
template <int Dim>
double bytes_of_a_run(const Simulation<Dim>& sim) {
  const Transfer& transfer = sim.scene.transfer;
  double columns = 1.0;
  if (transfer.averaging > 0.0) columns += 1.0;
  if (transfer.velocity == VelocityTransfer::fmpm) columns += Dim + 1.0;
  if (sim.heat) columns += Dim + 1.0;
  return static_cast<double>(bytes_per_particle(sim.particles)) + 8.0 * columns + 8.0;
}

template <int Dim>
void check(const Scene& scene, MPI_Comm communicator) {
  const Simulation<Dim> sim = start<Dim>(scene, communicator);
  std::int64_t grid_bytes = 0;
  for (const SlabGrid* grid : {sim.grid.get(), sim.averages.get(), sim.heat.get()}) {
    if (grid != nullptr) grid_bytes += static_cast<std::int64_t>(grid->bytes());
  }
  grid_bytes = sum(grid_bytes, communicator);
  if (rank(communicator) != 0) return;
  std::printf("%s\n", sim.scene_text.c_str());
  print_sample(scene, sim.sample);
  const double particles = static_cast<double>(sim.sample.particles);
  const double mechanical = mechanical_step(scene);
  const double dt = std::min(mechanical, sim.conduction_limit);
  const double steps = std::ceil(scene.time.end / dt);
  const double bytes = bytes_of_a_run(sim);
  print_conduction(scene, mechanical, sim.conduction_limit);
  const double rate = assumed_rate[Dim - 2] * size(communicator);
  std::printf("typical time step       %.3g s, about %.0f steps\n", dt, steps);
  std::printf(
      "memory                  %.0f MB for particles (%.0f bytes each), %.0f MB for nodes\n",
      particles * bytes * 1e-6, bytes, static_cast<double>(grid_bytes) * 1e-6);
  std::printf(
      "time to go              about %.0f s on %d ranks at %.1f million particle-steps per "
      "second per core\n",
      particles * steps / rate, size(communicator), assumed_rate[Dim - 2] * 1e-6);
}

template <int Dim>
void sample(const Scene& scene, const std::string& folder, bool force, MPI_Comm communicator) {
  const Simulation<Dim> sim = start<Dim>(scene, communicator);
  prepare_output_folder(folder, force, false, communicator);
  write_snapshot<Dim>(folder + "/" + snapshot_name(0),
                      {sim.scene, sim.scene_text, sim.materials, sim.particles, 0, 0, 0.0},
                      communicator);
  write_xdmf(folder, communicator);
  if (rank(communicator) != 0) return;
  print_sample(scene, sim.sample);
  std::printf("sample in               %s/%s\n", folder.c_str(), snapshot_name(0).c_str());
}

}  // namespace

void check_scene(const Scene& scene, MPI_Comm communicator) {
  scene.dimension == 2 ? check<2>(scene, communicator) : check<3>(scene, communicator);
}

void write_sample(const Scene& scene, const std::string& folder, bool force,
                  MPI_Comm communicator) {
  scene.dimension == 2 ? sample<2>(scene, folder, force, communicator)
                       : sample<3>(scene, folder, force, communicator);
}

}  // namespace poreshock
