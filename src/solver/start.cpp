#include "poreshock/solver/start.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/scene/particle_options.hpp"
#include "poreshock/scene/read_scene.hpp"
#include "poreshock/solver/check_state.hpp"
#include "poreshock/solver/ownership.hpp"
#include "poreshock/solver/sleep.hpp"
#include "stress_report.hpp"

namespace poreshock {

namespace {

template <int Dim>
Simulation<Dim> prepare(const Scene& scene, MPI_Comm communicator) {
  Simulation<Dim> sim;
  // First of all: a grid that cannot be counted is refused before the sample is made.
  require_countable_seam(make_grid_shape(scene), size(communicator));
  sim.scene = scene;
  sim.scene_text = write_scene(scene);
  sim.communicator = communicator;
  for (const MaterialParameters& parameters : scene.materials) {
    sim.materials.push_back(make_material(parameters));
    sim.sound_speed = std::max(sim.sound_speed, longitudinal_sound_speed(sim.materials.back()));
  }
  sim.particles.options = particle_options(scene);
  if (has_ends(scene)) sim.ends = find_ends(scene);
  for (int a = 0; a < Dim; ++a) sim.body_force[a] = scene.body_force[a];
  sim.conduction_limit =
      conducts_heat(scene)
          ? conduction_limit(sim.materials, scene.transfer.shape, Dim, scene.domain.cell)
          : std::numeric_limits<double>::infinity();
  sim.phases = make_phase_table();
  sim.window = open_window(scene);
  sim.ledger.follows = follows_front(scene);
  return sim;
}

/// Takes the window of a checkpoint, whose integers stand behind the others, and places its voids
/// or grains again. Throws InputError when the number of integers is not the one of run_state().
template <int Dim>
void read_window(const std::string& path, const RunState& state, Simulation<Dim>& sim) {
  std::size_t expected = 5 + save(sim.ledger, MPI_COMM_SELF).size();
  if (follows_front(sim.scene) && state.integers.size() >= expected + 4) {
    sim.window = window_of(
        {state.integers.begin() + static_cast<std::ptrdiff_t>(expected), state.integers.end()});
    Particles<Dim> none;
    fill<Dim>(sim.scene, {0, 0}, MPI_COMM_SELF, none, sim.sample);
    expected += save(sim.window).size();
  }
  if (state.integers.size() == expected) return;
  throw InputError(path + ": written by another version of this program, its ledger has " +
                   std::to_string(state.integers.size()) + " numbers instead of " +
                   std::to_string(expected) + "; restart with that version");
}

}  // namespace

template <int Dim>
Simulation<Dim> start(const Scene& scene, MPI_Comm communicator) {
  Simulation<Dim> sim = prepare<Dim>(scene, communicator);
  SampleReport report;
  fill<Dim>(scene, own_layers(sim.window.next, communicator), communicator, sim.particles, report);
  sim.sample = total(report, communicator);
  find_grains(sim);
  distribute(sim);
  if (has_contact(sim)) {
    sort_particles(0, *sim.grid, sim.particles, sim.cells);
    mark_surfaces(sim);
    split_by_colour(sim);
  }
  release_spare(sim.particles);
  sim.ledger = make_ledger<Dim>(scene, sim.materials, sim.particles, communicator);
  StepReport first;
  initialise_stress<Dim>(sim.materials, stress_settings(sim), sim.particles, first.stress);
  take_report(first, sim.conduction_limit, sim.clock, sim.ledger);
  sim.clock.disturbed = disturbed_rows(scene, sim.materials, sim.grid->shape(), sim.particles);
  agree_on_step(false, sim.clock, communicator);
  return sim;
}

template <int Dim>
Simulation<Dim> resume(const Scene& scene, const std::string& path, MPI_Comm communicator) {
  Simulation<Dim> sim = prepare<Dim>(scene, communicator);
  std::string stored_scene;
  RunState state;
  const ParticleOptions expected = sim.particles.options;
  read_checkpoint<Dim>(path, communicator, stored_scene, state, sim.particles);
  read_window(path, state, sim);
  require_sound_state(path, sim, expected, state);
  sim.clock.step = state.step;
  sim.work.measured_step = state.step;
  sim.clock.time = state.time;
  sim.clock.allowed = state.last_dt;
  sim.clock.beat = state.beat;
  sim.clock.limit = std::bit_cast<double>(state.integers.at(0));
  sim.clock.first_limit = std::bit_cast<double>(state.integers.at(1));
  set_quanta(std::bit_cast<double>(state.integers.at(2)),
             std::bit_cast<double>(state.integers.at(3)), sim.ledger);
  sim.ledger.row_time = std::bit_cast<double>(state.integers.at(4));
  restore({state.integers.begin() + 5, state.integers.end()}, rank(communicator) == 0, sim.ledger);
  sim.ledger.first_total = state.first_total;
  find_grains(sim);
  distribute(sim);
  sim.clock.disturbed = disturbed_rows(scene, sim.materials, sim.grid->shape(), sim.particles);
  agree_on_step(false, sim.clock, communicator);
  return sim;
}

template <int Dim>
RunState run_state(const Simulation<Dim>& sim) {
  RunState state;
  state.step = sim.clock.step;
  state.time = sim.clock.time;
  state.last_dt = sim.clock.allowed;
  state.beat = sim.clock.beat;
  state.record = sim.clock.beat + 1;
  state.first_total = sim.ledger.first_total;
  // Before agree_on_step every rank knows only its own particles' limit; the next step needs all.
  double limit = sim.clock.limit;
  check_mpi(MPI_Allreduce(MPI_IN_PLACE, &limit, 1, MPI_DOUBLE, MPI_MIN, sim.communicator),
            "MPI_Allreduce of the time step");
  for (const double x : {limit, sim.clock.first_limit, sim.ledger.energy_quantum,
                         sim.ledger.momentum_quantum, sim.ledger.row_time}) {
    state.integers.push_back(std::bit_cast<std::int64_t>(x));
  }
  const std::vector<std::int64_t> ledger = save(sim.ledger, sim.communicator);
  state.integers.insert(state.integers.end(), ledger.begin(), ledger.end());
  if (!follows_front(sim.scene)) return state;
  const std::vector<std::int64_t> window = save(sim.window);
  state.integers.insert(state.integers.end(), window.begin(), window.end());
  return state;
}

template Simulation<2> start<2>(const Scene&, MPI_Comm);
template Simulation<3> start<3>(const Scene&, MPI_Comm);
template Simulation<2> resume<2>(const Scene&, const std::string&, MPI_Comm);
template Simulation<3> resume<3>(const Scene&, const std::string&, MPI_Comm);
template RunState run_state<2>(const Simulation<2>&);
template RunState run_state<3>(const Simulation<3>&);

}  // namespace poreshock
