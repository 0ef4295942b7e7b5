#include "poreshock/app/check.hpp"

#include <algorithm>
#include <cstdio>

#include "poreshock/core/parallel.hpp"
#include "poreshock/output/folder.hpp"
#include "poreshock/output/snapshot.hpp"
#include "poreshock/output/xdmf.hpp"
#include "poreshock/run/start_warnings.hpp"
#include "poreshock/scene/read_scene.hpp"
#include "poreshock/solver/start.hpp"
#include "run_estimate.hpp"

namespace poreshock {

namespace {

/// How far heat gets until the end, beside the size of the voids; nothing without conduction.
void print_conduction(const Scene& scene, const RunEstimate& e) {
  if (!scene.conduction.on) return;
  if (!conducts_heat(scene)) {
    std::printf("heat conduction         none: every material.conductivity is 0\n");
    return;
  }
  for (const MaterialParameters& m : scene.materials) {
    const double length = diffusion_length(scene, m);
    std::printf("diffusion length        %.3g m in %s until the end, %.2g cells", length,
                m.name.c_str(), length / scene.domain.cell);
    if (scene.sample.kind == SampleKind::random_voids) {
      std::printf(", %.2g void diameters", length / (2.0 * scene.sample.void_radius));
    }
    std::printf("\n");
  }
  std::printf("step of heat conduction at most %.3g s, %s the motion's\n", e.conduction_step,
              e.conduction_step < e.mechanical_step ? "below" : "above");
}

void print_warnings(const std::vector<std::string>& warnings) {
  for (const std::string& warning : warnings) std::printf("warning: %s\n", warning.c_str());
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
  const bool image = scene.sample.kind == SampleKind::image;
  if (makes_grains(scene.sample) || image) {
    std::printf("grains                  %zu, void fraction %.6f",
                std::max(report.grains.size(), std::size_t{1}), report.geometric_void_fraction);
    if (!image) {
      std::printf(" (asked %.6f), least gap %.3g m", scene.sample.porosity, report.least_gap);
    }
    std::printf("\nvoid fraction of the particles  %.6f\n", report.particle_void_fraction);
  }
  std::printf("particles               %lld\n", static_cast<long long>(report.particles));
}

template <int Dim>
void check(const Scene& scene, MPI_Comm communicator) {
  const Resources resources = find_resources(communicator);
  require_memory(scene, resources);
  const Simulation<Dim> sim = start<Dim>(scene, communicator);
  const RunEstimate e = estimate_run(sim);
  const std::vector<std::string> unmeant = start_warnings(sim);
  if (rank(communicator) != 0) return;
  std::printf("%s\n", sim.scene_text.c_str());
  print_sample(scene, sim.sample);
  print_conduction(scene, e);
  std::printf("typical time step       %.3g s, about %.0f steps\n",
              std::min({e.mechanical_step, e.conduction_step, scene.output.beat}), e.steps);
  const double of_particles = static_cast<double>(sim.sample.particles) * e.particle_bytes;
  std::printf(
      "memory                  %.0f MB for particles (%.0f bytes each), %.0f MB for nodes\n",
      of_particles * 1e-6, e.particle_bytes, (e.memory - of_particles) * 1e-6);
  std::printf("disk                    %.0f MB for %.0f snapshots, %.0f MB a checkpoint\n",
              e.snapshots * e.snapshot_bytes * 1e-6, e.snapshots, e.checkpoint_bytes * 1e-6);
  std::printf(
      "time to go              about %.0f s on %d ranks at %.1f million particle-steps per "
      "second per core\n",
      e.seconds, resources.ranks, assumed_rate(Dim) * 1e-6);
  print_warnings(unmeant);
  print_warnings(sample_warnings(scene, sim.sample));
  print_warnings(run_warnings(scene, e, resources));
}

template <int Dim>
void sample(const Scene& scene, const std::string& folder, bool force, MPI_Comm communicator) {
  const Simulation<Dim> sim = start<Dim>(scene, communicator);
  const auto lock = prepare_output_folder(folder, force, false, communicator);
  write_snapshot<Dim>(folder + "/" + snapshot_name(0),
                      {sim.scene, sim.scene_text, sim.materials, sim.particles, 0, 0, 0.0},
                      communicator);
  write_xdmf(folder, communicator);
  if (rank(communicator) != 0) return;
  print_sample(scene, sim.sample);
  print_warnings(body_warnings(scene, sim.sample));
  print_warnings(sample_warnings(scene, sim.sample));
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
