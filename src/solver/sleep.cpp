#include "poreshock/solver/sleep.hpp"

#include <algorithm>
#include <limits>

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

}  // namespace

template <int Dim>
RowRange disturbed_rows(const Scene& scene, const std::vector<Material>& materials,
                        const GridShape& shape, const Particles<Dim>& particles) {
  if (!can_sleep(scene)) return {shape.first, shape.rows};
  Vector<Dim> undisturbed;
  for (int a = 0; a < Dim; ++a) undisturbed[a] = scene.loading.frame[a];
  undisturbed[Dim - 1] -= scene.loading.velocity;
  double sound = std::numeric_limits<double>::infinity();
  for (const Material& m : materials) sound = std::min(sound, longitudinal_sound_speed(m));
  const double least = least_disturbance * sound, bottom = shape.first * shape.cell;
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (std::size_t p = 0; p < particles.size(); ++p) {
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
  return std::ssize(cells.order) -
         (first_place(cells, grid, awake.last) - first_place(cells, grid, awake.first));
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
}

template RowRange disturbed_rows<2>(const Scene&, const std::vector<Material>&, const GridShape&,
                                    const Particles<2>&);
template RowRange disturbed_rows<3>(const Scene&, const std::vector<Material>&, const GridShape&,
                                    const Particles<3>&);
template void move_sleeping<2>(double, const CellOrder&, const SlabGrid&, Particles<2>&);
template void move_sleeping<3>(double, const CellOrder&, const SlabGrid&, Particles<3>&);

}  // namespace poreshock
