#include "poreshock/solver/ownership.hpp"

#include <algorithm>
#include <numeric>

#include "poreshock/core/memory.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/core/shape.hpp"
#include "poreshock/material/derived.hpp"
#include "poreshock/particles/exchange.hpp"
#include "poreshock/scene/transfer_scheme.hpp"
#include "poreshock/solver/sleep.hpp"

namespace poreshock {

namespace {

constexpr std::int64_t storage_interval = 20;

template <int Dim>
int row_of(const Particles<Dim>& particles, std::size_t p, const GridShape& shape,
           double inverse_cell) {
  // What lies on the lowest plane may come out a rounding below it.
  return std::max(
      shape.first,
      stencil_base(shape.stencil, particles.position[Dim - 1][p] * inverse_cell, shape.rows));
}

/// Where the domain ends along an axis, m.
struct AxisEnds {
  double low = 0.0, high = 0.0;
};

/// Brings one coordinate outside back into the domain where its sides say so; false when it has
/// escaped.
bool confine(const SideLaw& low, const SideLaw& high, AxisEnds ends, double& x,
             std::int64_t& crossings) {
  if (low.wraps) {
    x += x < 0.0 ? ends.high : -ends.high;
    // Rounding can land on the far end, which is the near one.
    if (x >= ends.high) x = 0.0;
    return x >= 0.0;
  }
  if (x < ends.low) {
    if (low.lets_out) return false;
    x = ends.low;
    ++crossings;
  } else if (x >= ends.high) {
    if (high.lets_out) return false;
    x = std::nextafter(ends.high, 0.0);
    ++crossings;
  }
  return true;
}

template <int Dim>
bool confine(const Scene& scene, double bottom, std::size_t p, Particles<Dim>& particles,
             std::int64_t& crossings) {
  for (int a = 0; a < Dim; ++a) {
    double& x = particles.position[a][p];
    const double low_end = a + 1 < Dim ? 0.0 : bottom;
    const AxisEnds ends = {low_end, low_end + scene.domain.size[a]};
    if (x >= ends.low && x < ends.high) continue;
    const SideLaw& low = side_law(side_kind(scene.boundary, a, false, Dim));
    const SideLaw& high = side_law(side_kind(scene.boundary, a, true, Dim));
    if (!confine(low, high, ends, x, crossings)) return false;
  }
  return true;
}

/// Predicted seconds of a step per row, the same on all ranks. Collective.
template <int Dim>
std::vector<double> row_seconds(const Simulation<Dim>& sim) {
  const GridShape shape = window_shape(sim);
  const double inverse_cell = 1.0 / shape.cell;
  std::vector<std::int64_t> particles(static_cast<std::size_t>(shape.rows - shape.first), 0);
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    const int row = row_of<Dim>(sim.particles, p, shape, inverse_cell);
    ++particles[static_cast<std::size_t>(row - shape.first)];
  }
  sum(particles, sim.communicator);
  std::vector<std::int64_t> contact_nodes;
  // The nodes of the last step, on the slabs of the last step.
  if (has_contact(sim)) {
    contact_nodes.assign(particles.size(), 0);
    for (const NodePlace& node : sim.grain_fields.shared) {
      if (node.row < shape.first || node.row >= sim.grid->last_row()) continue;
      ++contact_nodes[static_cast<std::size_t>(node.row - shape.first)];
    }
    sum(contact_nodes, sim.communicator);
  }
  const RowRange awake = {sim.cells.awake.first - shape.first, sim.cells.awake.last - shape.first};
  return predicted_row_seconds(particles, contact_nodes, awake, sleeping_weight(sim),
                               sim.work.unit_seconds);
}

/// Gives each rank its slab, grids and particles; starts count from the lowest row. Collective.
template <int Dim>
void cut_slabs(std::vector<int> starts, Simulation<Dim>& sim) {
  const double begin = MPI_Wtime();
  {
    const Phase phase(sim.phases, PhaseName::rebalance);
    const GridShape shape = window_shape(sim);
    const double inverse_cell = 1.0 / shape.cell;
    for (int& row : starts) row += shape.first;
    release_fields(sim.grain_fields);
    sim.grid.reset();
    sim.heat.reset();
    sim.ends.forces.reset();
    sim.grid = std::make_unique<SlabGrid>(shape, starts, sim.communicator);
    if (conducts_heat(sim.scene)) {
      sim.heat = std::make_unique<SlabGrid>(shape, starts, sim.communicator);
    }
    if (has_ends(sim.scene)) {
      sim.ends.forces = std::make_unique<SlabGrid>(shape, starts, sim.communicator);
    }
    std::vector<int> destination(sim.particles.size());
    for (std::size_t p = 0; p < sim.particles.size(); ++p) {
      destination[p] = sim.grid->owner(row_of<Dim>(sim.particles, p, shape, inverse_cell));
    }
    redistribute(destination, sim.particles, sim.communicator);
    sim.cells.resting.clear();
    release_freed_memory();
  }
  sim.work.lost = 0.0;
  sim.work.cut_seconds = MPI_Wtime() - begin;
  check_mpi(
      MPI_Allreduce(MPI_IN_PLACE, &sim.work.cut_seconds, 1, MPI_DOUBLE, MPI_MAX, sim.communicator),
      "MPI_Allreduce of the seconds of a cut");
}

/// With self-contact a particle belongs to the quarter that it faces.
template <int Dim>
void find_parts(const Particles<Dim>& particles, std::vector<std::int32_t>& part) {
  if (!particles.options.facing) return;
  part.resize(particles.size());
  for (std::size_t p = 0; p < part.size(); ++p) {
    part[p] = facing_quarter(particles.facing[0][p], particles.facing[1][p]);
  }
}

/// Sorts the particles that do not rest.
template <int Dim>
void sort_all(const SlabGrid& grid, const Particles<Dim>& particles, CellOrder& cells) {
  const GridShape& shape = grid.shape();
  const double inverse_cell = 1.0 / shape.cell;
  const std::size_t count =
      static_cast<std::size_t>(grid.last_row() - grid.first_row()) * shape.row_size;
  cells.cell.resize(particles.size());
  for (std::size_t p = resting_particles(cells); p < particles.size(); ++p) {
    int index = row_of<Dim>(particles, p, shape, inverse_cell) - grid.first_row();
    for (int a = Dim - 2; a >= 0; --a) {
      index = index * shape.nodes[a] +
              stencil_base(shape.stencil, particles.position[a][p] * inverse_cell, shape.nodes[a]);
    }
    cells.cell[p] = static_cast<std::uint32_t>(index);
  }
  find_parts(particles, cells.part);
  sort_by_cell(cells.cell, count, cells.part.empty() ? particles.grain : cells.part, particles.id,
               cells);
}

}  // namespace

template <int Dim>
void sort_particles(std::int64_t step, const SlabGrid& grid, Particles<Dim>& particles,
                    CellOrder& cells) {
  end_rest(std::max(cells.awake.last, grid.first_row() + 1), grid.shape(), particles, cells);
  sort_all(grid, particles, cells);
  if (step % storage_interval != 0) return;
  if (rest_pays(cells, grid)) {
    const bool some_rest = !cells.resting.empty();
    cells.resting.clear();
    if (some_rest) sort_all(grid, particles, cells);
    let_rest(grid, particles, cells);
  } else {
    const std::uint32_t resting = resting_particles(cells);
    reorder(cells.order, particles, resting);
    std::iota(cells.order.begin(), cells.order.end(), resting);
  }
  find_parts(particles, cells.part);
}

template <int Dim>
void migrate(Simulation<Dim>& sim) {
  const Phase phase(sim.phases, PhaseName::migrate);
  const GridShape& shape = sim.grid->shape();
  const double inverse_cell = 1.0 / shape.cell;
  const double bottom = shape.first * shape.cell;
  const double inertia = affine_inertia(sim.scene.transfer, sim.scene.domain.cell);
  Particles<Dim>& particles = sim.particles;
  // Those that rest after that are inside and stay here.
  end_rest(sim.grid->first_row() + 1, shape, particles, sim.cells);
  std::vector<std::uint32_t> down, up, gone;
  for (std::size_t p = resting_particles(sim.cells); p < particles.size(); ++p) {
    if (!confine<Dim>(sim.scene, bottom, p, particles, sim.ledger.guards.wall_crossing)) {
      book(particles, p, inertia, sim.ledger, sim.ledger.escaped);
      gone.push_back(static_cast<std::uint32_t>(p));
      continue;
    }
    const int row = row_of<Dim>(particles, p, shape, inverse_cell);
    if (row < sim.grid->first_row()) down.push_back(static_cast<std::uint32_t>(p));
    if (row >= sim.grid->last_row()) up.push_back(static_cast<std::uint32_t>(p));
  }
  exchange_with_neighbours(down, up, gone, particles, sim.communicator);
}

template <int Dim>
void distribute(Simulation<Dim>& sim) {
  cut_slabs(
      partition_rows(row_seconds(sim), size(sim.communicator), slab_limits(window_shape(sim))),
      sim);
}

template <int Dim>
void rebalance(Simulation<Dim>& sim) {
  WorkMeter& work = sim.work;
  const std::int64_t steps = sim.clock.step - work.measured_step;
  if (size(sim.communicator) == 1 || steps == 0) return;
  std::vector<int> now = sim.grid->starts();
  for (int& row : now) row -= sim.grid->shape().first;
  std::vector<double> weights;
  std::vector<int> best;
  {
    const Phase phase(sim.phases, PhaseName::rebalance);
    const PerWork<double> seconds = work_seconds(sim.phases);
    PerWork<double> since = seconds;
    for (std::size_t k = 0; k < since.size(); ++k) since[k] -= work.seconds[k];
    work.unit_seconds =
        measured_unit_seconds(work.done, since, work.unit_seconds, sim.communicator);
    const std::vector<double> factors =
        slab_factors(work.done, since, work.unit_seconds, sim.communicator);
    work.seconds = seconds;
    work.done = {};
    work.measured_step = sim.clock.step;
    weights = row_seconds(sim);
    for (std::size_t r = 0; r < factors.size(); ++r) {
      for (int row = now[r]; row < now[r + 1]; ++row) {
        weights[static_cast<std::size_t>(row)] *= factors[r];
      }
    }
    best = partition_rows(weights, size(sim.communicator), slab_limits(sim.grid->shape()));
  }
  if (cutting_pays(heaviest(weights, now), heaviest(weights, best), steps, work)) {
    cut_slabs(best, sim);
    ++work.cuts;
  }
}

template void sort_particles<2>(std::int64_t, const SlabGrid&, Particles<2>&, CellOrder&);
template void sort_particles<3>(std::int64_t, const SlabGrid&, Particles<3>&, CellOrder&);
template void migrate<2>(Simulation<2>&);
template void migrate<3>(Simulation<3>&);
template void distribute<2>(Simulation<2>&);
template void distribute<3>(Simulation<3>&);
template void rebalance<2>(Simulation<2>&);
template void rebalance<3>(Simulation<3>&);

}  // namespace poreshock
