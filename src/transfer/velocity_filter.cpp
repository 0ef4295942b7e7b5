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

/// Sums to means.
template <int Dim>
void divide_by_mass(SlabGrid& grid) {
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    Lanes* nodes = grid.row(row);
    for (int i = 0; i < grid.shape().row_size; ++i) {
      const double mass = nodes[i][ResidualLane<Dim>::mass];
      if (mass > 0.0) nodes[i] = nodes[i] / mass;
    }
  }
}

/// Means to what the ties leave of them; mean squares grow by twice what brings the variance about
/// the old mean to that about the new one.
template <int Dim>
void apply_ties(const TiedNodes<Dim>& tied, std::span<const FilterField> fields) {
  using Lane = ResidualLane<Dim>;
  for (const TiedNode<Dim>& node : tied.nodes) {
    std::array<Lanes*, most_colours> lanes{};
    FieldNumbers<Dim> mean;
    for (int f = 0; f < node.count; ++f) {
      lanes[f] = &fields[static_cast<std::size_t>(node.field[f])].grid->row(node.row)[node.lateral];
      for (int a = 0; a < Dim; ++a) mean[f][a] = (*lanes[f])[Lane::velocity + a];
    }
    const FieldNumbers<Dim> held = tie_velocities<Dim>(tied, node, mean);
    for (int f = 0; f < node.count; ++f) {
      double more = 0.0;
      for (int a = 0; a < Dim; ++a) {
        (*lanes[f])[Lane::velocity + a] = held[f][a];
        more += held[f][a] * (held[f][a] - mean[f][a]);
      }
      (*lanes[f])[Lane::square] += 2.0 * more;
    }
  }
}

/// Squares of the means and variances about them; fills periodic images.
template <int Dim>
void finish_means(SlabGrid& grid) {
  using Lane = ResidualLane<Dim>;
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    Lanes* nodes = grid.row(row);
    for (int i = 0; i < grid.shape().row_size; ++i) {
      if (!(nodes[i][Lane::mass] > 0.0)) continue;
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

/// Places of the particles of a field that are awake.
std::span<const std::uint32_t> awake_places(const FilterField& field) {
  const CellOrder& cells = *field.cells;
  const RowRange rows = awake_rows(cells, *field.grid);
  const std::uint32_t first = first_place(cells, *field.grid, rows.first);
  return {cells.order.data() + first, first_place(cells, *field.grid, rows.last) - first};
}

}  // namespace

template <int Dim>
void filter_velocity(std::span<const FilterField> fields, const TiedNodes<Dim>& tied,
                     const Transfer& transfer, double inverse_quantum, Particles<Dim>& particles,
                     StepData<Dim>& step, Int128& filter_heat) {
  for (int a = 0; a < Dim; ++a) step.residual[a].resize(particles.size());
  step.filter_heat.resize(particles.size());
  for (const FilterField& field : fields) {
    for (const std::uint32_t p : awake_places(field)) {
      for (int a = 0; a < Dim; ++a) step.residual[a][p] = particles.velocity[a][p];
      step.filter_heat[p] = 0.0;
    }
  }
  with_shape(transfer, [&](const auto& spline) {
    for (int applied = 0; applied < transfer.order; ++applied) {
      for (const FilterField& field : fields) {
        scatter_residual<Dim>(spline, particles, *field.cells, step, *field.grid);
        field.grid->exchange();
        divide_by_mass<Dim>(*field.grid);
      }
      apply_ties<Dim>(tied, fields);
      for (const FilterField& field : fields) {
        finish_means<Dim>(*field.grid);
        subtract_average<Dim>(spline, particles, *field.cells, transfer.order, applied, *field.grid,
                              step);
      }
    }
  });
  for (const FilterField& field : fields) {
    for (const std::uint32_t p : awake_places(field)) {
      for (int a = 0; a < Dim; ++a) particles.velocity[a][p] -= step.residual[a][p];
      particles.internal_energy[p] += step.filter_heat[p];
      filter_heat += quantise(particles.mass[p] * step.filter_heat[p], inverse_quantum);
    }
  }
}

template void filter_velocity<2>(std::span<const FilterField>, const TiedNodes<2>&, const Transfer&,
                                 double, Particles<2>&, StepData<2>&, Int128&);
template void filter_velocity<3>(std::span<const FilterField>, const TiedNodes<3>&, const Transfer&,
                                 double, Particles<3>&, StepData<3>&, Int128&);

}  // namespace poreshock
