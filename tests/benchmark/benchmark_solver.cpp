// Speed of the sweeps of a step and of the whole step on one core, in particles per second, and of
// AFLIP and PolyFLIP done plainly (support/plain_step.hpp). A square of solid aluminium with two by
// two particles a cell, stirred so that it yields; nothing sleeps and no rank is beside it.
// Before anything is timed, one step of both kinds must agree to 1e-11.

#include <benchmark/benchmark.h>
#include <petscsys.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>

#include "poreshock/physics/momentum.hpp"
#include "poreshock/transfer/grid_to_particles.hpp"
#include "poreshock/transfer/particles_to_grid.hpp"
#include "poreshock/transfer/sweep.hpp"
#include "support/plain_step.hpp"
#include "support/runs.hpp"

namespace poreshock {
namespace {

constexpr double time_step = 1e-14;  // s, so short that all repetitions see the same state

std::string square_text(const std::string& shape, const std::string& velocity) {
  return std::string(R"(
title = "square"
[domain]
size = [1.3e-3, 1.3e-3]
cell = 10e-6
[boundary]
low = "free"
high = "free"
[[body]]
shape = "box"
low = [0.1e-3, 0.1e-3]
high = [1.2e-3, 1.2e-3]
[viscosity]
linear = 0.6
quadratic = 8.0
limited = )") +
         (shape == "cubic" ? "true" : "false") + R"(
[time]
end = 1e-6
sleep = false
[transfer]
)" + "shape = \"" +
         shape + "\"\nvelocity = \"" + velocity + "\"\n" + test::aluminium_text;
}

/// The square after a few steps of stirring.
Simulation<2> stirred(const std::string& shape, const std::string& velocity) {
  Simulation<2> sim = start<2>(test::scene_of(square_text(shape, velocity)), MPI_COMM_SELF);
  const double wave = 2.0 * std::numbers::pi / 0.2e-3;
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    const double x = sim.particles.position[0][p], y = sim.particles.position[1][p];
    sim.particles.velocity[0][p] = 200.0 * std::sin(wave * y) + 50.0 * std::sin(wave * x);
    sim.particles.velocity[1][p] = 100.0 * std::cos(wave * (x + y));
  }
  sim.clock.disturbed = {0, sim.grid->shape().rows};
  test::advance_to(20, 0, sim);
  sort_particles(sim.clock.step, *sim.grid, sim.particles, sim.cells);
  return sim;
}

/// Schemes that are timed, the two that are done plainly first.
constexpr struct {
  const char *shape, *velocity;
} schemes[] = {{"cubic", "aflip"}, {"cubic", "polyflip"},  {"cubic", "apic"},
               {"cubic", "flip"},  {"quadratic", "aflip"}, {"cubic", "ipolypic"}};

Simulation<2> scheme(std::int64_t number) {
  return stirred(schemes[number].shape, schemes[number].velocity);
}

/// The number of the scheme with these modes that is done plainly.
template <Modes M>
constexpr int number_of = M == Modes::affine ? 0 : 1;

double lost_in(double dt, const Simulation<2>& sim) {
  return lost_share(sim.scene.transfer, sim.sound_speed, sim.scene.domain.cell, dt);
}

template <Modes M>
reference::PlainBody<M> plain(double dt, const Simulation<2>& sim) {
  reference::PlainBody<M> body = reference::plain_body<M>(
      sim.particles, sim.grid->shape(), sim.materials[0], stress_settings(sim), lost_in(dt, sim));
  body.rounding = 1e-16 * sim.sound_speed * sim.sound_speed;
  return body;
}

/// Largest difference of one step of the program and one of the plain kind, each column over its
/// largest value.
template <Modes M>
double difference() {
  constexpr double dt = 5e-10;
  Simulation<2> sim = scheme(number_of<M>);
  reference::PlainBody<M> body = plain<M>(dt, sim);
  advance(sim, dt);
  reference::plain_step(dt, body);
  using Plain = reference::PlainParticle<M>;
  std::map<std::int64_t, const Plain*> by_id;
  for (const auto& p : body.particles) by_id[p.id] = &p;
  double worst = 0.0;
  const auto compare = [&](const std::vector<double>& column, auto&& value) {
    double error = 0.0, largest = 0.0;
    for (std::size_t p = 0; p < column.size(); ++p) {
      error = std::max(error, std::abs(column[p] - value(*by_id.at(sim.particles.id[p]))));
      largest = std::max(largest, std::abs(column[p]));
    }
    worst = std::max(worst, error / largest);
  };
  for (int a = 0; a < 2; ++a) {
    compare(sim.particles.position[a], [a](const Plain& p) { return p.x[a]; });
    compare(sim.particles.velocity[a], [a](const Plain& p) { return p.mode[a][0]; });
    const double size = sim.scene.domain.cell * std::sqrt(1.0 / 3.0);
    for (int k = 0; k < 2; ++k) {
      compare(sim.particles.affine[2 * a + k],
              [=](const Plain& p) { return p.mode[a][1 + k] / size; });
    }
    if constexpr (M == Modes::quadratic) {
      for (int k = 0; k < 3; ++k) {
        compare(sim.particles.quadratic[3 * a + k],
                [=](const Plain& p) { return p.mode[a][3 + k]; });
      }
    }
  }
  for (int k = 0; k < 4; ++k) {
    compare(sim.particles.deviator[k], [k](const Plain& p) { return p.deviator[k]; });
  }
  compare(sim.particles.density, [](const Plain& p) { return p.density; });
  compare(sim.particles.pressure, [](const Plain& p) { return p.pressure; });
  compare(sim.particles.viscous_pressure, [](const Plain& p) { return p.viscous_pressure; });
  compare(sim.particles.internal_energy, [](const Plain& p) { return p.energy; });
  compare(sim.particles.plastic_strain, [](const Plain& p) { return p.plastic_strain; });
  compare(sim.particles.plastic_work, [](const Plain& p) { return p.plastic_work; });
  return worst;
}

void count(const Simulation<2>& sim, benchmark::State& state) {
  const double particles = static_cast<double>(sim.particles.size());
  state.counters["Mparticle/s"] = benchmark::Counter(
      1e-6 * particles * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void program_step(benchmark::State& state) {
  Simulation<2> sim = scheme(state.range(0));
  for (auto _ : state) {
    advance(sim, time_step);
    migrate(sim);
    ++sim.clock.step;
  }
  count(sim, state);
}

template <Modes M>
void plain_step(benchmark::State& state) {
  const Simulation<2> sim = scheme(number_of<M>);
  reference::PlainBody<M> body = plain<M>(time_step, sim);
  for (auto _ : state) {
    reference::plain_sort(body);
    reference::plain_step(time_step, body);
  }
  count(sim, state);
}

void sort(benchmark::State& state) {
  Simulation<2> sim = scheme(0);
  sim.clock.step = 1;  // not one in which the storage is sorted too
  for (auto _ : state) sort_particles(sim.clock.step, *sim.grid, sim.particles, sim.cells);
  count(sim, state);
}

void scatter(benchmark::State& state) {
  Simulation<2> sim = scheme(state.range(0));
  for (auto _ : state) {
    particles_to_grid(sim.particles, sim.cells, sim.scene.transfer, *sim.grid);
  }
  count(sim, state);
}

/// Nodes in motion, as the gathers find them.
void move_nodes(Simulation<2>& sim) {
  particles_to_grid(sim.particles, sim.cells, sim.scene.transfer, *sim.grid);
  sim.grid->exchange();
  integrate_momentum<2>(sim.body_force, time_step, *sim.grid);
  prepare_gather<2>(lost_in(time_step, sim), *sim.grid);
}

void gather_and_stress(benchmark::State& state) {
  Simulation<2> sim = scheme(state.range(0));
  move_nodes(sim);
  ParticleMotion<2> motion;
  motion.dt = time_step;
  motion.lost = lost_in(time_step, sim);
  motion.limited = sim.scene.viscosity.limited;
  TransferReport transfer;
  const bool stress = state.range(1) != 0;
  StressReport report;
  for (auto _ : state) {
    const RowRange all = {sim.grid->first_row(), sim.grid->last_row()};
    for (RowRange rows = {all.first, all.first + 4}; rows.first < all.last;
         rows = {rows.last, rows.last + 4}) {
      rows.last = std::min(rows.last, all.last);
      transfer += grid_to_particles<2>(*sim.grid, sim.cells, rows, sim.scene.transfer, motion,
                                       sim.particles, sim.step_data);
      if (!stress) continue;
      const std::uint32_t first = first_place(sim.cells, *sim.grid, rows.first);
      const std::span places(sim.cells.order.data() + first,
                             first_place(sim.cells, *sim.grid, rows.last) - first);
      update_stress<2>(sim.materials, stress_settings(sim), sim.step_data, time_step, places,
                       sim.particles, report);
    }
  }
  count(sim, state);
}

BENCHMARK(plain_step<Modes::affine>)->Name("plain_step/aflip")->Unit(benchmark::kMillisecond);
BENCHMARK(plain_step<Modes::quadratic>)->Name("plain_step/polyflip")->Unit(benchmark::kMillisecond);
BENCHMARK(program_step)->ArgName("scheme")->DenseRange(0, 5)->Unit(benchmark::kMillisecond);
BENCHMARK(sort)->Unit(benchmark::kMillisecond);
BENCHMARK(scatter)->ArgName("scheme")->DenseRange(0, 5)->Unit(benchmark::kMillisecond);
BENCHMARK(gather_and_stress)
    ->ArgNames({"scheme", "stress"})
    ->ArgsProduct({{0, 1, 2, 3, 4, 5}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace poreshock

int main(int argc, char** argv) {
  PetscInitialize(nullptr, nullptr, nullptr, nullptr);
  using poreshock::Modes;
  const double off =
      std::max(poreshock::difference<Modes::affine>(), poreshock::difference<Modes::quadratic>());
  if (!(off < 1e-11)) {
    std::fprintf(stderr, "the plain step and the program's differ by %.3g\n", off);
    return 1;
  }
  benchmark::Initialize(&argc, argv);
  benchmark::AddCustomContext("difference from the plain step", std::to_string(off));
  benchmark::RunSpecifiedBenchmarks();
  PetscFinalize();
  return 0;
}
