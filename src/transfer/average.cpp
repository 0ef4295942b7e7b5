#include "poreshock/transfer/average.hpp"

#include "poreshock/transfer/node_lanes.hpp"
#include "poreshock/transfer/sweep.hpp"

namespace poreshock {

namespace {

/// Turns sums of volume x quantity into averages; empty nodes stay zero. Fills periodic images.
void divide_by_volume(SlabGrid& averages) {
  for (int row = averages.first_row(); row < averages.node_end(); ++row) {
    Lanes* nodes = averages.row(row);
    for (int i = 0; i < averages.shape().row_size; ++i) {
      const double volume = nodes[i][AverageLane::volume];
      if (volume > 0.0) nodes[i] = nodes[i] / volume;
    }
  }
  averages.fill_periodic_images();
}

template <int Dim, class Spline, class Quantities>
void scatter_averages(const Spline& spline, const Particles<Dim>& particles, const CellOrder& cells,
                      Quantities&& quantities, SlabGrid& averages) {
  scatter<Dim>(
      spline, particles, cells,
      [&](std::uint32_t p, const Stencil<Dim, Spline>& stencil, Lanes* sums) {
        const double volume = particles.mass[p] / particles.density[p];
        const Lanes q = volume * quantities(p);
        add_weighted<Dim, Spline>(stencil, q, sums);
      },
      averages);
  averages.exchange();
  divide_by_volume(averages);
}

template <int Dim, class Spline>
void pressure_sweeps(const Spline& spline, const Particles<Dim>& particles, const CellOrder& cells,
                     double share, SlabGrid& averages, StepData<Dim>& step) {
  const auto total = [&](std::uint32_t p) {
    return particles.pressure[p] + particles.viscous_pressure[p];
  };
  scatter_averages<Dim>(
      spline, particles, cells,
      [&](std::uint32_t p) {
        return Lanes{1.0, total(p)};
      },
      averages);
  gather<Dim>(spline, particles, cells, averages,
              [&](std::uint32_t p, const Stencil<Dim, Spline>& stencil, const Lanes* nodes) {
                const double average =
                    interpolate<Dim, Spline>(stencil, nodes)[AverageLane::pressure];
                step.averaged_pressure[p] = (1.0 - share) * total(p) + share * average;
              });
}

template <int Dim, class Spline>
void dilatation_sweeps(const Spline& spline, const Particles<Dim>& particles,
                       const CellOrder& cells, double share, const SlabGrid& grid,
                       SlabGrid& averages, StepData<Dim>& step) {
  using Lane = MotionLane<Dim>;
  const double inverse_cell = 1.0 / grid.shape().cell;
  gather<Dim>(spline, particles, cells, grid,
              [&](std::uint32_t p, const Stencil<Dim, Spline>& s, const Lanes* nodes) {
                double end = 0.0, start = 0.0;
                for (int n = 0; n < stencil_nodes<Dim, Spline>; ++n) {
                  for (int a = 0; a < Dim; ++a) {
                    const double slope = node_slope<Dim, Spline>(s, n, a);
                    end += slope * nodes[n][Lane::end_velocity + a];
                    start += slope * nodes[n][Lane::start_velocity + a];
                  }
                }
                step.dilatation_end[p] = end * inverse_cell;
                step.dilatation_mid[p] = 0.5 * (start + end) * inverse_cell;
              });
  scatter_averages<Dim>(
      spline, particles, cells,
      [&](std::uint32_t p) {
        return Lanes{1.0, 0.0, step.dilatation_end[p], step.dilatation_mid[p]};
      },
      averages);
  gather<Dim>(spline, particles, cells, averages,
              [&](std::uint32_t p, const Stencil<Dim, Spline>& stencil, const Lanes* nodes) {
                const Lanes average = interpolate<Dim, Spline>(stencil, nodes);
                step.dilatation_end[p] =
                    (1.0 - share) * step.dilatation_end[p] + share * average[AverageLane::end];
                step.dilatation_mid[p] =
                    (1.0 - share) * step.dilatation_mid[p] + share * average[AverageLane::mid];
              });
}

}  // namespace

template <int Dim>
void average_pressure(const Particles<Dim>& particles, const CellOrder& cells,
                      const Transfer& transfer, SlabGrid& averages, StepData<Dim>& step) {
  with_shape(transfer, [&](const auto& spline) {
    pressure_sweeps<Dim>(spline, particles, cells, transfer.averaging, averages, step);
  });
}

template <int Dim>
void average_dilatation(const Particles<Dim>& particles, const CellOrder& cells,
                        const Transfer& transfer, const SlabGrid& grid, SlabGrid& averages,
                        StepData<Dim>& step) {
  with_shape(transfer, [&](const auto& spline) {
    dilatation_sweeps<Dim>(spline, particles, cells, transfer.averaging, grid, averages, step);
  });
}

template void average_pressure<2>(const Particles<2>&, const CellOrder&, const Transfer&, SlabGrid&,
                                  StepData<2>&);
template void average_pressure<3>(const Particles<3>&, const CellOrder&, const Transfer&, SlabGrid&,
                                  StepData<3>&);
template void average_dilatation<2>(const Particles<2>&, const CellOrder&, const Transfer&,
                                    const SlabGrid&, SlabGrid&, StepData<2>&);
template void average_dilatation<3>(const Particles<3>&, const CellOrder&, const Transfer&,
                                    const SlabGrid&, SlabGrid&, StepData<3>&);

}  // namespace poreshock
