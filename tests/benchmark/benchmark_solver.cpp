// Speed of the sweeps of a step and of the whole step on one core, in particles per second, and of
// the same step done plainly (support/plain_step.hpp). A square of solid aluminium with two by two
// particles a cell, stirred so that it yields; nothing sleeps and no rank is beside it.
// Before anything is timed, one step of both must agree to 1e-11.

#include <benchmark/benchmark.h>
#include <petscsys.h>

#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>

#include "poreshock/physics/momentum.hpp"
#include "poreshock/transfer/average.hpp"
#include "poreshock/transfer/grid_to_particles.hpp"
#include "poreshock/transfer/particles_to_grid.hpp"
#include "poreshock/transfer/sweep.hpp"
#include "support/plain_step.hpp"
#include "support/runs.hpp"

namespace poreshock {
namespace {

constexpr double time_step = 1e-14;  // s, so short that all repetitions see the same state

std::string square_text(const std::string& shape, const std::string& velocity, double averaging) {
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
[time]
end = 1e-6
sleep = false
[transfer]
)") + "shape = \"" +
         shape + "\"\nvelocity = \"" + velocity + "\"\naveraging = " + std::to_string(averaging) +
         "\ndamping = 0.0\norder = 3\n" + test::aluminium_text;
}

/// The square after a few steps of stirring.
Simulation<2> stirred(const std::string& shape, const std::string& velocity, double averaging) {
  Simulation<2> sim =
      start<2>(test::scene_of(square_text(shape, velocity, averaging)), MPI_COMM_SELF);
  const double wave = 2.0 * std::numbers::pi / 0.2e-3;
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    const double x = sim.particles.position[0][p], y = sim.particles.position[1][p];
    sim.particles.velocity[0][p] = 200.0 * std::sin(wave * y) + 50.0 * std::sin(wave * x);
    sim.particles.velocity[1][p] = 100.0 * std::cos(wave * (x + y));
  }
  sim.clock.disturbed = {0, sim.grid->shape().rows};
  test::advance_to(20, 0, sim);
  sort_particles(sim);
  return sim;
}

reference::PlainBody plain(const Simulation<2>& sim) {
  return reference::plain_body(sim.particles, sim.grid->shape(), sim.materials[0],
                               sim.stress_settings);
}

/// Largest difference of one step of the program and one of the plain kind, each column over its
/// largest value.
double difference() {
  constexpr double dt = 5e-10;
  Simulation<2> sim = stirred("cubic", "apic", 1.0);
  reference::PlainBody body = plain(sim);
  advance(sim, dt);
  reference::plain_step(dt, body);
  std::map<std::int64_t, const reference::PlainParticle*> by_id;
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
  using Plain = reference::PlainParticle;
  for (int a = 0; a < 2; ++a) {
    compare(sim.particles.position[a], [a](const Plain& p) { return p.x[a]; });
    compare(sim.particles.velocity[a], [a](const Plain& p) { return p.v[a]; });
    for (int k = 0; k < 2; ++k) {
      compare(sim.particles.affine[2 * a + k], [a, k](const Plain& p) { return p.C[a][k]; });
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

/// A scheme by number: shape, transfer, averaging.
Simulation<2> scheme(std::int64_t number) {
  switch (number) {
    case 1:
      return stirred("cubic", "apic", 0.0);
    case 2:
      return stirred("cubic", "flip", 0.0);
    case 3:
      return stirred("quadratic", "apic", 1.0);
    case 4:
      return stirred("quadratic", "apic", 0.0);
    default:
      return stirred("cubic", "apic", 1.0);
  }
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

void plain_step(benchmark::State& state) {
  const Simulation<2> sim = stirred("cubic", "apic", 1.0);
  reference::PlainBody body = plain(sim);
  for (auto _ : state) {
    reference::plain_sort(body);
    reference::plain_step(time_step, body);
  }
  count(sim, state);
}

void sort(benchmark::State& state) {
  Simulation<2> sim = scheme(0);
  sim.clock.step = 1;  // not one in which the storage is sorted too
  for (auto _ : state) sort_particles(sim);
  count(sim, state);
}

void scatter(benchmark::State& state) {
  Simulation<2> sim = scheme(state.range(0));
  for (auto _ : state) {
    particles_to_grid(sim.particles, sim.cells, sim.scene.transfer, sim.averages.get(), *sim.grid);
  }
  count(sim, state);
}

void pressure_average(benchmark::State& state) {
  Simulation<2> sim = scheme(state.range(0));
  for (auto _ : state) {
    average_pressure(sim.particles, sim.cells, sim.scene.transfer, *sim.averages);
  }
  count(sim, state);
}

/// Nodes in motion, as the gathers find them.
void move_nodes(Simulation<2>& sim) {
  particles_to_grid(sim.particles, sim.cells, sim.scene.transfer, sim.averages.get(), *sim.grid);
  sim.grid->exchange();
  integrate_momentum<2>(sim.body_force, projects(sim.scene.transfer.velocity), time_step, *sim.grid,
                        sim.ledger.nodes);
  prepare_gather<2>(sim.scene.transfer, 0.0, *sim.grid);
}

void dilatation_average(benchmark::State& state) {
  Simulation<2> sim = scheme(state.range(0));
  move_nodes(sim);
  for (auto _ : state) {
    average_dilatation(sim.particles, sim.cells, sim.scene.transfer, *sim.grid, *sim.averages);
  }
  count(sim, state);
}

void gather_and_stress(benchmark::State& state) {
  Simulation<2> sim = scheme(state.range(0));
  move_nodes(sim);
  const bool averaging = sim.scene.transfer.averaging > 0.0;
  if (averaging) {
    average_dilatation(sim.particles, sim.cells, sim.scene.transfer, *sim.grid, *sim.averages);
  }
  const bool stress = state.range(1) != 0;
  StressReport report;
  for (auto _ : state) {
    const RowRange all = {sim.grid->first_row(), sim.grid->last_row()};
    for (RowRange rows = {all.first, all.first + 4}; rows.first < all.last;
         rows = {rows.last, rows.last + 4}) {
      rows.last = std::min(rows.last, all.last);
      grid_to_particles<2>(*sim.grid, averaging ? sim.averages.get() : nullptr, sim.cells, rows,
                           sim.scene.transfer, sim.stress_settings.grid_velocity, time_step, 1.0,
                           sim.particles, sim.step_data, sim.ledger.transfer_heat);
      if (!stress) continue;
      const std::uint32_t first = first_place(sim.cells, *sim.grid, rows.first);
      const std::span places(sim.cells.order.data() + first,
                             first_place(sim.cells, *sim.grid, rows.last) - first);
      update_stress<2>(sim.materials, sim.stress_settings, sim.step_data, time_step, places,
                       sim.particles, report);
    }
  }
  count(sim, state);
}

BENCHMARK(plain_step)->Unit(benchmark::kMillisecond);
BENCHMARK(program_step)->ArgName("scheme")->DenseRange(0, 5)->Unit(benchmark::kMillisecond);
BENCHMARK(sort)->Unit(benchmark::kMillisecond);
BENCHMARK(scatter)->ArgName("scheme")->DenseRange(0, 4)->Unit(benchmark::kMillisecond);
BENCHMARK(pressure_average)->ArgName("scheme")->Arg(0)->Arg(3)->Unit(benchmark::kMillisecond);
BENCHMARK(dilatation_average)->ArgName("scheme")->Arg(0)->Arg(3)->Unit(benchmark::kMillisecond);
BENCHMARK(gather_and_stress)
    ->ArgNames({"scheme", "stress"})
    ->ArgsProduct({{0, 1, 2, 3, 4}, {0, 1}})
    ->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace poreshock

int main(int argc, char** argv) {
  PetscInitialize(nullptr, nullptr, nullptr, nullptr);
  const double off = poreshock::difference();
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
