// Steps of small porous samples. Prints a hash of all particle columns and sums after some steps;
// compiled for several instruction sets, it must print the same.

#include <bit>
#include <cstdio>
#include <numeric>

#include "instruction_sets/porous_sample.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/core/shape.hpp"
#include "poreshock/physics/boundary.hpp"
#include "poreshock/physics/momentum.hpp"
#include "poreshock/transfer/particles_to_grid.hpp"
#include "poreshock/transfer/sweep.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::test;

constexpr double sound_speed = 6400.0;
constexpr int steps = 20;

/// Sorts by the stencil cell; every seventh step the storage follows.
template <int Dim>
void sort_particles(const SlabGrid& grid, int n, PorousSample<Dim>& s) {
  const GridShape& shape = grid.shape();
  const double inverse_cell = 1.0 / cell;
  s.cell_of.resize(s.particles.size());
  for (std::size_t p = 0; p < s.particles.size(); ++p) {
    int index = 0;
    for (int a = Dim - 1; a >= 0; --a) {
      const double x = s.particles.position[a][p] * inverse_cell;
      index = index * shape.nodes[a] + stencil_base(shape.stencil, x, shape.nodes[a]);
    }
    s.cell_of[p] = static_cast<std::uint32_t>(index);
  }
  const std::size_t cells = static_cast<std::size_t>(shape.rows) * shape.row_size;
  sort_by_cell(s.cell_of, cells, s.particles.grain, s.particles.id, s.cells);
  if (n % 7 != 0) return;
  reorder(s.cells.order, s.particles);
  std::iota(s.cells.order.begin(), s.cells.order.end(), 0U);
}

/// Wraps periodic sides and holds particles inside the others.
template <int Dim>
void confine(PorousSample<Dim>& s) {
  for (int a = 0; a < Dim; ++a) {
    const double length = s.scene.domain.size[a];
    const bool wraps = a + 1 < Dim && s.scene.boundary.lateral[a] == SideKind::periodic;
    for (double& x : s.particles.position[a]) {
      if (wraps && x < 0.0) x += length;
      if (wraps && x >= length) x -= length;
      x = x < 0.0 ? 0.0 : (x >= length ? length * (1.0 - 0x1p-50) : x);
    }
  }
}

/// One step, as the program does it. `heat` is a grid for conduction.
template <int Dim>
void advance(double dt, int n, SlabGrid& grid, SlabGrid& heat, PorousSample<Dim>& s) {
  const Transfer& transfer = s.scene.transfer;
  Vector<Dim> body_force = Vector<Dim>::Zero();
  body_force[0] = 3.0e8;
  ParticleMotion<Dim> motion;
  motion.dt = dt;
  motion.lost = lost_share(transfer, sound_speed, cell, dt);
  motion.grid_velocity = s.settings.grid_velocity;
  motion.limited = transfer.shape == ShapeFunction::cubic;
  motion.inverse_energy_quantum = s.settings.inverse_energy_quantum;
  sort_particles<Dim>(grid, n, s);
  if (s.conducts) {
    conduct_heat<Dim>(s.materials,
                      {s.scene.thermal, transfer.shape, dt, s.settings.inverse_energy_quantum},
                      s.cells, heat, s.heat_flow, s.particles, s.conduction);
  }
  particles_to_grid(s.particles, s.cells, transfer, grid);
  grid.exchange();
  integrate_momentum<Dim>(body_force, dt, grid);
  apply_boundaries<Dim>(s.scene.boundary, s.settings.grid_velocity, grid, s.ledger);
  add_body_work<Dim>(body_force, dt, grid, s.ledger);
  prepare_gather<Dim>(motion.lost, grid);
  s.transfer +=
      grid_to_particles(grid, s.cells, all_rows(grid), transfer, motion, s.particles, s.step);
  update_stress(s.materials, s.settings, s.step, dt, s.cells.order, s.particles, s.report);
  confine<Dim>(s);
}

/// FNV-1a over 64-bit words.
struct Hash {
  std::uint64_t value = 0xcbf29ce484222325ULL;
  void add(std::uint64_t word) { value = (value ^ word) * 0x100000001b3ULL; }
};

template <int Dim>
std::uint64_t hash_of(const PorousSample<Dim>& s) {
  Hash hash;
  for_each_column(s.particles, [&](std::string_view, int, const auto& column) {
    for (const auto x : column) {
      if constexpr (sizeof(x) == 8) {
        hash.add(std::bit_cast<std::uint64_t>(x));
      } else {
        hash.add(static_cast<std::uint64_t>(x));
      }
    }
  });
  const NodeLedger& l = s.ledger;
  std::vector<Int128> sums = {
      l.wall_heat,         l.wall_work,          l.body_work,           s.transfer.heat,
      s.transfer.negative, s.transfer.shortened, s.report.viscous_heat, s.report.compression_work,
      s.report.step_heat,  s.conduction};
  sums.insert(sums.end(), l.body_impulse.begin(), l.body_impulse.end());
  sums.insert(sums.end(), l.wall_impulse.begin(), l.wall_impulse.end());
  for (const std::int64_t word : to_words(sums)) hash.add(static_cast<std::uint64_t>(word));
  hash.add(std::bit_cast<std::uint64_t>(s.report.dt_limit));
  return hash.value;
}

/// Runs one case and prints its hashes; false when it did not do what it is for.
template <int Dim>
bool run(const Case& c, const std::array<int, Dim>& cells, reference::Random& random) {
  PorousSample<Dim> s = prepare<Dim>(c, cells);
  fill<Dim>(random, s);
  const GridShape shape = make_grid_shape(s.scene);
  SlabGrid grid(shape, {0, shape.rows}, MPI_COMM_WORLD);
  SlabGrid heat(shape, {0, shape.rows}, MPI_COMM_WORLD);
  double dt = 0.3 * s.report.dt_limit;
  for (int n = 1; n <= steps; ++n) {
    advance<Dim>(dt, n, grid, heat, s);
    if (s.report.bad > 0) return false;
    dt = s.report.dt_limit < 1.1 * dt ? s.report.dt_limit : 1.1 * dt;
    if (n == 1 || n % 5 == 0) {
      std::printf("%-28s %zu particles, step %2d %016llx\n", c.name, s.particles.size(), n,
                  static_cast<unsigned long long>(hash_of<Dim>(s)));
    }
  }
  // The wall was hit, the solid yielded, and some of it failed where it can.
  int yielded = 0, failed = 0;
  for (const std::int32_t f : s.particles.failed) failed += f != 0 ? 1 : 0;
  for (const double strain : s.particles.plastic_strain) yielded += strain > 0.01;
  const bool good = s.ledger.wall_heat > 0 && 4 * yielded > static_cast<int>(s.particles.size()) &&
                    (!c.conduction_and_spall || failed >= 5);
  if (!good) std::printf("%s: only %d yielded, %d failed\n", c.name, yielded, failed);
  return good;
}

}  // namespace

int main(int argc, char** argv) {
  const Runtime runtime(argc, argv);
  using enum ShapeFunction;
  using enum VelocityTransfer;
  using enum SideKind;
  constexpr Thermal paper = Thermal::paper, conserving = Thermal::conserving;
  const std::array<Case, 11> plane = {
      {{"plane cubic APIC", {.shape = cubic, .velocity = apic}, conserving, symmetry},
       {"plane quadratic FLIP",
        {.shape = quadratic, .velocity = flip, .damping = 0.1},
        paper,
        periodic},
       {"plane cubic FLIP", {.shape = cubic, .velocity = flip, .damping = 0.1}, conserving, wall},
       {"plane quadratic AFLIP",
        {.shape = quadratic, .velocity = aflip, .damping = 0.1},
        paper,
        wall},
       {"plane GIMP FLIP", {.shape = gimp, .velocity = flip, .half_length = 0.25}, paper, wall},
       {"plane cubic PIC", {.shape = cubic, .velocity = pic}, conserving, periodic},
       {"plane cubic iAPIC",
        {.shape = cubic, .velocity = iapic, .damping = 0.2},
        conserving,
        periodic},
       {"plane cubic PolyPIC", {.shape = cubic, .velocity = polypic}, paper, symmetry},
       {"plane cubic iPolyPIC",
        {.shape = cubic, .velocity = ipolypic, .damping = 1.0},
        conserving,
        wall},
       {"plane cubic, heat and spall",
        {.shape = cubic, .velocity = polyflip},
        conserving,
        periodic,
        true},
       {"plane quadratic, heat and spall",
        {.shape = quadratic, .velocity = flip},
        paper,
        wall,
        true}}};
  const std::array<Case, 4> space = {
      {{"space cubic APIC", {.shape = cubic, .velocity = apic}, conserving, wall},
       {"space quadratic FLIP",
        {.shape = quadratic, .velocity = flip, .damping = 0.1},
        conserving,
        periodic},
       {"space cubic iPolyPIC",
        {.shape = cubic, .velocity = ipolypic, .damping = 1.0},
        conserving,
        periodic},
       {"space cubic, heat and spall",
        {.shape = cubic, .velocity = polyflip, .damping = 0.02},
        paper,
        wall,
        true}}};
  reference::Random random{20240607};
  bool good = true;
  for (const Case& c : plane) good = run<2>(c, {8, 13}, random) && good;
  for (const Case& c : space) good = run<3>(c, {6, 5, 9}, random) && good;
  if (!good) std::printf("a case went bad, missed the wall or hardly yielded\n");
  return good ? 0 : 1;
}
