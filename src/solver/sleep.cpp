#include "poreshock/solver/sleep.hpp"

#include <algorithm>
#include <limits>
#include <numeric>
#include <span>

#include "poreshock/core/shape.hpp"
#include "poreshock/transfer/sweep.hpp"

namespace poreshock {

namespace {

/// Velocity, as a share of the sound speed, below which nothing has arrived. Round-off of a uniform
/// motion stays a thousand times below it.
constexpr double least_disturbance = 1.0e-12;

/// Rows next to an end that stops material, where the first wave starts.
RowRange rows_at_ends(const Boundary& boundary, const GridShape& shape) {
  RowRange rows = {std::numeric_limits<int>::max(), 0};
  if (side_law(boundary.low.kind).mirrors) rows = {shape.first, shape.first + shape.stencil};
  if (side_law(boundary.high.kind).mirrors) {
    rows = {std::min(rows.first, shape.rows - shape.stencil), shape.rows};
  }
  return rows;
}

/// True when particles move as particle p does, straight down or not at all.
template <int Dim, class Places>
bool fall_like(std::uint32_t p, const Places& places, const GridShape& shape,
               const Particles<Dim>& particles) {
  const Vector<Dim> grid = grid_velocity<Dim>(shape);
  bool same = particles.velocity[Dim - 1][p] <= grid[Dim - 1];
  for (int a = 0; a < Dim; ++a) {
    const std::vector<double>& v = particles.velocity[a];
    same = same && (a + 1 == Dim || v[p] == grid[a]);
    for (const std::uint32_t q : places) same = same && v[q] == v[p];
  }
  return same;
}

}  // namespace

template <int Dim>
RowRange disturbed_rows(const Scene& scene, const std::vector<Material>& materials,
                        const GridShape& shape, const Particles<Dim>& particles,
                        std::size_t first) {
  if (!can_sleep(scene)) return {shape.first, shape.rows};
  Vector<Dim> undisturbed;
  for (int a = 0; a < Dim; ++a) undisturbed[a] = scene.loading.frame[a];
  undisturbed[Dim - 1] -= scene.loading.velocity;
  double sound = std::numeric_limits<double>::infinity();
  for (const Material& m : materials) sound = std::min(sound, longitudinal_sound_speed(m));
  const double least = least_disturbance * sound, bottom = shape.first * shape.cell;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t p = first; p < particles.size(); ++p) {
    double change = 0.0;
    bool inside = true;  // what has left is gone before the next step
    for (int a = 0; a < Dim; ++a) {
      const double x = particles.position[a][p];
      const bool periodic = a + 1 < Dim && side_law(scene.boundary.lateral[a]).wraps;
      const double side = a + 1 < Dim ? 0.0 : bottom;
      inside = inside && (periodic || (x >= side && x < side + scene.domain.size[a]));
      change = std::max(change, std::abs(particles.velocity[a][p] - undisturbed[a]));
    }
    change = inside ? change : 0.0;
    const double y = particles.position[Dim - 1][p];
    low = change > least && y < low ? y : low;
    high = change > least && y > high ? y : high;
  }
  RowRange rows = rows_at_ends(scene.boundary, shape);
  if (low <= high) {
    const double inverse_cell = 1.0 / shape.cell;
    rows.first = std::min(rows.first, stencil_base(shape.stencil, low * inverse_cell, shape.rows));
    rows.last =
        std::max(rows.last, stencil_base(shape.stencil, high * inverse_cell, shape.rows) + 1);
  }
  return rows;
}

RowRange awake_around(RowRange disturbed, const GridShape& shape) {
  const int reach = 2 * shape.stencil;
  return {std::max(disturbed.first - reach, shape.first),
          std::min(disturbed.last + reach, shape.rows)};
}

std::int64_t sleeping_particles(const CellOrder& cells, const SlabGrid& grid) {
  const RowRange awake = awake_rows(cells, grid);
  return resting_particles(cells) + std::ssize(cells.order) -
         (first_place(cells, grid, awake.last) - first_place(cells, grid, awake.first));
}

bool rest_pays(const CellOrder& cells, const SlabGrid& grid) {
  const std::int64_t count = std::ssize(cells.order);
  const std::int64_t above = count - first_place(cells, grid, awake_rows(cells, grid).last);
  return cells.may_rest && above > 0 && 8 * above >= count;
}

template <int Dim>
void let_rest(const SlabGrid& grid, Particles<Dim>& particles, CellOrder& cells) {
  const auto place = [&](int row) { return cells.order.begin() + first_place(cells, grid, row); };
  const int lowest = std::max(awake_rows(cells, grid).last, grid.first_row() + 1);
  std::uint32_t count = 0;
  int row = grid.last_row();
  for (; row > lowest; --row) {
    const std::span next(place(row - 1), place(row));
    if (!fall_like(cells.order.back(), next, grid.shape(), particles)) break;
    if (next.empty()) continue;
    // All will be turned as a whole.
    std::reverse(next.begin(), next.end());
    cells.resting.push_back(count += static_cast<std::uint32_t>(next.size()));
  }
  std::reverse(place(row), cells.order.end());
  std::rotate(cells.order.begin(), place(row), cells.order.end());
  reorder(cells.order, particles);
  const std::uint32_t others = first_place(cells, grid, row);
  const std::ptrdiff_t cell = std::ptrdiff_t{row - grid.first_row()} * grid.shape().row_size;
  std::fill(cells.start.begin() + cell, cells.start.end(), others);
  cells.order.resize(others);
  std::iota(cells.order.begin(), cells.order.end(), count);
}

template <int Dim>
void end_rest(int first, const GridShape& shape, const Particles<Dim>& particles,
              CellOrder& cells) {
  const auto& height = particles.position[Dim - 1];
  const double inverse_cell = 1.0 / shape.cell;
  while (!cells.resting.empty()) {
    const std::size_t rows = cells.resting.size();
    const auto begin = height.begin() + (rows > 1 ? cells.resting[rows - 2] : 0);
    const auto end = height.begin() + cells.resting[rows - 1];
    // Lower rows were lower all the time: the same is added to all.
    const bool stays = std::all_of(begin, end, [&](double y) {
      return stencil_base(shape.stencil, y * inverse_cell, shape.rows) >= first;
    });
    if (stays) return;
    cells.resting.pop_back();
  }
}

template <int Dim>
void move_sleeping(double dt, const CellOrder& cells, const SlabGrid& grid,
                   Particles<Dim>& particles) {
  const RowRange awake = awake_rows(cells, grid);
  const Vector<Dim> velocity = grid_velocity<Dim>(grid.shape());
  const auto move = [&](int first_row, int last_row) {
    const std::uint32_t last = first_place(cells, grid, last_row);
    for (std::uint32_t k = first_place(cells, grid, first_row); k < last; ++k) {
      const std::uint32_t p = cells.order[k];
      for (int a = 0; a < Dim; ++a) {
        particles.position[a][p] += dt * (particles.velocity[a][p] - velocity[a]);
      }
    }
  };
  move(grid.first_row(), awake.first);
  move(awake.last, grid.last_row());
  const std::uint32_t resting = resting_particles(cells);
  if (resting == 0) return;
  double* const height = particles.position[Dim - 1].data();
  const double fall = dt * (particles.velocity[Dim - 1][0] - velocity[Dim - 1]);
  for (std::uint32_t p = 0; p < resting; ++p) height[p] += fall;
}

template RowRange disturbed_rows<2>(const Scene&, const std::vector<Material>&, const GridShape&,
                                    const Particles<2>&, std::size_t);
template RowRange disturbed_rows<3>(const Scene&, const std::vector<Material>&, const GridShape&,
                                    const Particles<3>&, std::size_t);
template void let_rest<2>(const SlabGrid&, Particles<2>&, CellOrder&);
template void let_rest<3>(const SlabGrid&, Particles<3>&, CellOrder&);
template void end_rest<2>(int, const GridShape&, const Particles<2>&, CellOrder&);
template void end_rest<3>(int, const GridShape&, const Particles<3>&, CellOrder&);
template void move_sleeping<2>(double, const CellOrder&, const SlabGrid&, Particles<2>&);
template void move_sleeping<3>(double, const CellOrder&, const SlabGrid&, Particles<3>&);

}  // namespace poreshock
