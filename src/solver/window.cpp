#include "poreshock/solver/window.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numeric>

#include "poreshock/core/parallel.hpp"
#include "poreshock/particles/exchange.hpp"
#include "poreshock/scene/transfer_scheme.hpp"
#include "poreshock/solver/ownership.hpp"
#include "poreshock/solver/simulation.hpp"
#include "poreshock/solver/sleep.hpp"

namespace poreshock {

namespace {

/// Height below which layers have particles, m on the grid: one row below the top, so that no
/// particle is above it.
double filled_height(const GridShape& shape) {
  return (shape.rows - 4) * shape.cell;
}

/// Layers from the lowest on that have come into the window.
std::ptrdiff_t layers_inside(const Window& window, const GridShape& shape) {
  return std::lower_bound(window.heights.begin(), window.heights.end(), filled_height(shape)) -
         window.heights.begin();
}

/// Those of them, counted from the lowest, whose rows this rank owns.
template <int Dim>
LatticeRange own_layers_inside(const Simulation<Dim>& sim) {
  const GridShape& shape = sim.grid->shape();
  const double inverse_cell = 1.0 / shape.cell;
  const std::ptrdiff_t inside = layers_inside(sim.window, shape);
  LatticeRange own;
  for (std::ptrdiff_t k = 0; k < inside; ++k) {
    const double s = sim.window.heights[static_cast<std::size_t>(k)] * inverse_cell;
    const int row = std::max(shape.first, stencil_base(shape.stencil, s, shape.rows));
    if (row < sim.grid->first_row()) own.first = k + 1;
    if (row < sim.grid->last_row()) own.last = k + 1;
  }
  return {own.first, std::max(own.first, own.last)};
}

}  // namespace

StripHeights strip_heights(const Scene& scene) {
  constexpr int least = 16;
  const int most = std::max(scene.domain.cells[scene.dimension - 1] / 8, least);
  const double cells =
      scene.morphology.every > 0.0 ? scene.morphology.pixel / scene.domain.cell : 1.0;
  const int step = std::max(1, static_cast<int>(std::lround(cells)));
  // Never less than a pixel, which is at most the least strip.
  return {std::max(step, most / 2 / step * step), most / step * step, step};
}

Window open_window(const Scene& scene) {
  Window window;
  window.next = lattice_layers(scene);
  if (!follows_front(scene)) return window;
  for (std::int64_t k = 0; k < sample_layers(scene); ++k) {
    window.heights.push_back(layer_height(scene, k));
  }
  window.next = layers_inside(window, make_grid_shape(scene));
  window.heights.erase(window.heights.begin(), window.heights.begin() + window.next);
  return window;
}

template <int Dim>
GridShape window_shape(const Simulation<Dim>& sim) {
  return moved_up(make_grid_shape(sim.scene), sim.window.first);
}

template <int Dim>
void move_layers(double dt, Simulation<Dim>& sim) {
  const double velocity = sim.scene.loading.frame[Dim - 1] - sim.scene.loading.velocity;
  const double of_grid = grid_velocity<Dim>(sim.grid->shape())[Dim - 1];
  for (double& height : sim.window.heights) height += dt * (velocity - of_grid);
}

template <int Dim>
bool must_hand_over(const Simulation<Dim>& sim) {
  const GridShape& shape = sim.grid->shape();
  return !sim.window.heights.empty() &&
         awake_around(sim.clock.disturbed, shape).last > shape.rows - 4;
}

template <int Dim>
int best_strip(const Simulation<Dim>& sim) {
  const StripHeights heights = strip_heights(sim.scene);
  const double cell = sim.scene.domain.cell, per_quantum = 1.0 / mass_quantum(sim.ledger);
  const double spacing = cell / sim.scene.sample.particles_per_cell;
  const double inverse_face = 1.0 / (Dim == 2 ? spacing : spacing * spacing);
  std::vector<Int128> excess(static_cast<std::size_t>(heights.last) + 1);
  const Particles<Dim>& particles = sim.particles;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double length = std::min(cell, particles.mass[p] / particles.density[p] * inverse_face);
    const double y = particles.position[Dim - 1][p];
    const double row = std::nearbyint(y / cell) - sim.window.first;
    if (row < heights.first || row > heights.last) continue;
    const double above = y - (row + sim.window.first) * cell;
    if (std::abs(above) >= 0.5 * length) continue;
    const double share = 0.5 - above / length;
    excess[static_cast<std::size_t>(row)] +=
        quantise(particles.mass[p] * (share - (above < 0.0 ? 1.0 : 0.0)), per_quantum);
  }
  sum(excess, sim.communicator);
  int best = heights.first;
  const auto size = [&](int row) {
    const Int128 x = excess[static_cast<std::size_t>(row)];
    return x < 0 ? -x : x;
  };
  for (int row = heights.first; row <= heights.last; row += heights.step) {
    if (size(row) <= size(best)) best = row;
  }
  return best;
}

template <int Dim>
std::vector<std::uint32_t> strip_particles(int rows, const Simulation<Dim>& sim) {
  const double plane = (sim.window.first + rows) * sim.scene.domain.cell;
  std::vector<std::uint32_t> strip;
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    if (sim.particles.position[Dim - 1][p] < plane) strip.push_back(static_cast<std::uint32_t>(p));
  }
  return strip;
}

template <int Dim>
void hand_over(int rows, Simulation<Dim>& sim) {
  const double inertia = affine_inertia(sim.scene.transfer, sim.scene.domain.cell);
  const std::vector<std::uint32_t> strip = strip_particles(rows, sim);
  for (const std::uint32_t p : strip) {
    book(sim.particles, p, inertia, sim.ledger, sim.ledger.handed_over);
    sim.ledger.handed_plastic_work +=
        quantise(sim.particles.mass[p] * sim.particles.plastic_work[p],
                 sim.ledger.nodes.inverse_energy_quantum);
  }
  exchange_with_neighbours({}, {}, strip, sim.particles, sim.communicator);
  sim.window.first += rows;
  ++sim.window.strips;
  distribute(sim);
}

template <int Dim>
void take_in(Simulation<Dim>& sim) {
  Window& window = sim.window;
  const LatticeRange own = own_layers_inside(sim);
  if (own.first < own.last) {
    Particles<Dim> made;
    made.options = sim.particles.options;
    fill_layers<Dim>(sim.scene, sim.sample, {window.next + own.first, window.next + own.last},
                     made);
    const std::int64_t layer = layer_sites(sim.scene);
    for (std::size_t p = 0; p < made.size(); ++p) {
      const std::int64_t k = made.id[p] / layer - window.next;
      made.position[Dim - 1][p] = window.heights[static_cast<std::size_t>(k)];
    }
    StressReport at_rest;
    initialise_stress<Dim>(sim.materials, stress_settings(sim), made, at_rest);
    const double inertia = affine_inertia(sim.scene.transfer, sim.scene.domain.cell);
    for (std::size_t p = 0; p < made.size(); ++p) {
      book(made, p, inertia, sim.ledger, sim.ledger.taken_in);
    }
    std::vector<std::uint32_t> all(made.size());
    std::iota(all.begin(), all.end(), 0U);
    append(made, all, sim.particles);
  }
  const std::ptrdiff_t inside = layers_inside(window, sim.grid->shape());
  window.heights.erase(window.heights.begin(), window.heights.begin() + inside);
  window.next += inside;
}

template <int Dim>
void follow_front(Simulation<Dim>& sim) {
  while (must_hand_over(sim)) hand_over(best_strip(sim), sim);
  take_in(sim);
}

std::vector<std::int64_t> save(const Window& window) {
  std::vector<std::int64_t> words = {window.first, window.strips, window.next,
                                     std::ssize(window.heights)};
  for (const double height : window.heights) words.push_back(std::bit_cast<std::int64_t>(height));
  return words;
}

Window window_of(const std::vector<std::int64_t>& words) {
  Window window;
  window.first = static_cast<int>(words.at(0));
  window.strips = words.at(1);
  window.next = words.at(2);
  for (std::size_t k = 4; k < 4 + static_cast<std::size_t>(words.at(3)); ++k) {
    window.heights.push_back(std::bit_cast<double>(words.at(k)));
  }
  return window;
}

template GridShape window_shape<2>(const Simulation<2>&);
template GridShape window_shape<3>(const Simulation<3>&);
template void move_layers<2>(double, Simulation<2>&);
template void move_layers<3>(double, Simulation<3>&);
template bool must_hand_over<2>(const Simulation<2>&);
template bool must_hand_over<3>(const Simulation<3>&);
template int best_strip<2>(const Simulation<2>&);
template int best_strip<3>(const Simulation<3>&);
template std::vector<std::uint32_t> strip_particles<2>(int, const Simulation<2>&);
template std::vector<std::uint32_t> strip_particles<3>(int, const Simulation<3>&);
template void hand_over<2>(int, Simulation<2>&);
template void hand_over<3>(int, Simulation<3>&);
template void take_in<2>(Simulation<2>&);
template void take_in<3>(Simulation<3>&);
template void follow_front<2>(Simulation<2>&);
template void follow_front<3>(Simulation<3>&);

}  // namespace poreshock
