#include "poreshock/transfer/velocity_filter.hpp"

#include <algorithm>
#include <span>

#include "moments.hpp"
#include "poreshock/transfer/blocks.hpp"

namespace poreshock {

namespace {

/// Lanes of a node: sums of mass, momentum and m |r|^2 (at `square`), then mean velocity R, |R|^2
/// and the mean of |r|^2 less |R|^2.
template <int Dim>
struct ResidualLane {
  static constexpr int mass = 0;
  static constexpr int velocity = 1;
  static constexpr int square = 1 + Dim;
  static constexpr int variance = 2 + Dim;
};

template <int Dim, class Spline>
void scatter_residual(const Spline& spline, const Particles<Dim>& particles, const CellOrder& cells,
                      const StepData<Dim>& step, SlabGrid& grid) {
  scatter_values<Dim, 2 + Dim>(
      spline, particles, cells,
      [&](std::uint32_t p) {
        const double m = particles.mass[p];
        std::array<double, 2 + Dim> values{m};
        double square = 0.0;
        for (int a = 0; a < Dim; ++a) {
          const double r = step.residual[a][p];
          values[ResidualLane<Dim>::velocity + a] = m * r;
          square += r * r;
        }
        values[ResidualLane<Dim>::square] = m * square;
        return values;
      },
      grid);
}

/// Sums to means; fills periodic images.
template <int Dim>
void divide_by_mass(SlabGrid& grid) {
  using Lane = ResidualLane<Dim>;
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    Lanes* nodes = grid.row(row);
    for (int i = 0; i < grid.shape().row_size; ++i) {
      const double mass = nodes[i][Lane::mass];
      if (!(mass > 0.0)) continue;
      nodes[i] = nodes[i] / mass;
      const double mean_square = nodes[i][Lane::square];
      double square = 0.0;
      for (int a = 0; a < Dim; ++a) {
        square += nodes[i][Lane::velocity + a] * nodes[i][Lane::velocity + a];
      }
      nodes[i][Lane::square] = square;
      const double rest = mean_square - square;
      nodes[i][Lane::variance] = rest > 0.0 ? rest : 0.0;
    }
  }
  grid.fill_periodic_images();
}

/// r <- r - P r, and the heat of this application (see filter_velocity).
template <int Dim, class Spline>
void subtract_average(const Spline& spline, const Particles<Dim>& particles, const CellOrder& cells,
                      int order, int applied, const SlabGrid& grid, StepData<Dim>& step) {
  using Lane = ResidualLane<Dim>;
  const bool takes_residual = order % 2 == 0 && applied + 1 == order / 2;
  const bool takes_variance = order % 2 == 1 && applied == order / 2;
  const bool takes_nodes = 2 * applied >= order;
  const bool takes_spread = 2 * applied + 1 >= order;
  const double inverse_cell = 1.0 / grid.shape().cell;
  gather_with<Dim, Spline>(
      [&](std::uint32_t p, const std::array<int, Dim>& base) {
        return point_weights<Dim>(spline, particles, p, base, inverse_cell);
      },
      particles, cells, grid, awake_rows(cells, grid),
      [&](std::uint32_t p, const PointWeights<Dim>& w, const Lanes* nodes) {
        const Lanes mean = interpolate<Dim, Spline>(w, nodes);
        double rest2 = 0.0, mean2 = 0.0;
        for (int a = 0; a < Dim; ++a) {
          const double average = mean[Lane::velocity + a];
          const double r = step.residual[a][p] - average;
          step.residual[a][p] = r;
          rest2 += r * r;
          mean2 += average * average;
        }
        double heat = 0.0;
        if (takes_residual) heat += rest2;
        if (takes_variance) heat += mean[Lane::variance];
        if (takes_nodes) heat += mean[Lane::square];
        if (takes_spread) heat += mean[Lane::square] - mean2;
        step.filter_heat[p] += 0.5 * heat;
      });
}

}  // namespace

template <int Dim>
void filter_velocity(const CellOrder& cells, const Transfer& transfer, double inverse_quantum,
                     SlabGrid& grid, Particles<Dim>& particles, StepData<Dim>& step,
                     Int128& filter_heat) {
  const RowRange rows = awake_rows(cells, grid);
  const std::span places(
      cells.order.data() + first_place(cells, grid, rows.first),
      first_place(cells, grid, rows.last) - first_place(cells, grid, rows.first));
  for (int a = 0; a < Dim; ++a) {
    step.residual[a].resize(particles.size());
    for (const std::uint32_t p : places) step.residual[a][p] = particles.velocity[a][p];
  }
  step.filter_heat.resize(particles.size());
  for (const std::uint32_t p : places) step.filter_heat[p] = 0.0;
  with_shape(transfer, [&](const auto& spline) {
    for (int applied = 0; applied < transfer.order; ++applied) {
      scatter_residual<Dim>(spline, particles, cells, step, grid);
      grid.exchange();
      divide_by_mass<Dim>(grid);
      subtract_average<Dim>(spline, particles, cells, transfer.order, applied, grid, step);
    }
  });
  for (const std::uint32_t p : places) {
    for (int a = 0; a < Dim; ++a) particles.velocity[a][p] -= step.residual[a][p];
    particles.internal_energy[p] += step.filter_heat[p];
    filter_heat += quantise(particles.mass[p] * step.filter_heat[p], inverse_quantum);
  }
}

template void filter_velocity<2>(const CellOrder&, const Transfer&, double, SlabGrid&,
                                 Particles<2>&, StepData<2>&, Int128&);
template void filter_velocity<3>(const CellOrder&, const Transfer&, double, SlabGrid&,
                                 Particles<3>&, StepData<3>&, Int128&);

}  // namespace poreshock
