#include "poreshock/transfer/average.hpp"

#include "poreshock/transfer/blocks.hpp"
#include "poreshock/transfer/node_lanes.hpp"

namespace poreshock {

namespace {

/// Divergences of the nodal velocities at one particle, at the end of the step and in its middle.
template <int Dim, class Spline, class Nodes>
inline std::array<double, 2> divergences(const BlockWeights<Dim, Spline>& w, const Nodes& nodes,
                                         double inverse_cell) {
  Lanes end{}, start{};
  for (int b = 0; b < stencil_blocks<Dim, Spline>; ++b) {
    for (int a = 0; a < Dim; ++a) {
      const Lanes slope = slope_in<Dim, Spline>(w, a, b);
      end = fused(slope, nodes[a][b], end);
      start = fused(slope, nodes[Dim + a][b], start);
    }
  }
  constexpr double inverse_scale = 1.0 / total_scale<Dim, Spline>;
  const double at_end = sum_of_lanes(end) * (inverse_scale * inverse_cell);
  const double at_start = sum_of_lanes(start) * (inverse_scale * inverse_cell);
  return {at_end, 0.5 * (at_start + at_end)};
}

/// Scatters volume, volume x div v' and volume x div v_mid.
template <int Dim, class Spline>
void scatter_dilatation(const Spline& spline, const Particles<Dim>& particles,
                        const CellOrder& cells, const SlabGrid& grid, SlabGrid& averages) {
  using Lane = MotionLane<Dim>;
  constexpr int velocities = 2 * Dim;
  const double inverse_cell = 1.0 / grid.shape().cell;
  std::array<int, velocities> lanes;
  for (int a = 0; a < Dim; ++a) {
    lanes[a] = Lane::end_velocity + a;
    lanes[Dim + a] = Lane::start_velocity + a;
  }
  BlockReader<Dim, Spline, velocities> reader(grid, lanes);
  scatter_blocks<Dim, 3>(
      spline, particles, cells, [&](int row, int lateral) { reader.load(row, lateral); },
      [&](std::uint32_t p, const BlockWeights<Dim, Spline>& w, auto& sums) {
        const auto [end, mid] = divergences<Dim, Spline>(w, reader.nodes, inverse_cell);
        const double volume = unscaled<Dim, Spline>(particles.mass[p] / particles.density[p]);
        std::array<double, 3> values{};
        values[AverageLane::volume] = volume;
        values[AverageLane::end] = volume * end;
        values[AverageLane::mid] = volume * mid;
        add_values(w, values, sums);
      },
      averages);
}

/// Puts the averages beside the motion of the nodes, so that one gather takes both.
void join_motion(const SlabGrid& averages, SlabGrid& grid) {
  using Lane = MotionLane<2>;
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    const Lanes* source = averages.row(row);
    Lanes* nodes = grid.row(row);
    for (int i = 0; i < grid.shape().row_size; ++i) {
      nodes[i][Lane::dilatation_end] = source[i][AverageLane::end];
      nodes[i][Lane::dilatation_mid] = source[i][AverageLane::mid];
    }
  }
}

}  // namespace

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

template <int Dim>
void sum_pressure(const Particles<Dim>& particles, const CellOrder& cells, const Transfer& transfer,
                  SlabGrid& averages) {
  with_shape(transfer, [&](const auto& spline) {
    scatter_values<Dim, 2>(
        spline, particles, cells,
        [&](std::uint32_t p) {
          const double volume = particles.mass[p] / particles.density[p];
          return std::array{volume,
                            volume * (particles.pressure[p] + particles.viscous_pressure[p])};
        },
        averages);
  });
  averages.exchange();
}

template <int Dim>
void average_pressure(const Particles<Dim>& particles, const CellOrder& cells,
                      const Transfer& transfer, SlabGrid& averages) {
  sum_pressure(particles, cells, transfer, averages);
  divide_by_volume(averages);
}

template <int Dim>
void sum_dilatation(const Particles<Dim>& particles, const CellOrder& cells,
                    const Transfer& transfer, const SlabGrid& grid, SlabGrid& averages) {
  with_shape(transfer, [&](const auto& spline) {
    scatter_dilatation<Dim>(spline, particles, cells, grid, averages);
  });
  averages.exchange();
}

template <int Dim>
void divide_dilatation(SlabGrid& grid, SlabGrid& averages) {
  divide_by_volume(averages);
  if constexpr (Dim == 2) join_motion(averages, grid);
}

template <int Dim>
void average_dilatation(const Particles<Dim>& particles, const CellOrder& cells,
                        const Transfer& transfer, SlabGrid& grid, SlabGrid& averages) {
  sum_dilatation(particles, cells, transfer, grid, averages);
  divide_dilatation<Dim>(grid, averages);
}

template void sum_pressure<2>(const Particles<2>&, const CellOrder&, const Transfer&, SlabGrid&);
template void sum_pressure<3>(const Particles<3>&, const CellOrder&, const Transfer&, SlabGrid&);
template void sum_dilatation<2>(const Particles<2>&, const CellOrder&, const Transfer&,
                                const SlabGrid&, SlabGrid&);
template void sum_dilatation<3>(const Particles<3>&, const CellOrder&, const Transfer&,
                                const SlabGrid&, SlabGrid&);
template void divide_dilatation<2>(SlabGrid&, SlabGrid&);
template void divide_dilatation<3>(SlabGrid&, SlabGrid&);

template void average_pressure<2>(const Particles<2>&, const CellOrder&, const Transfer&,
                                  SlabGrid&);
template void average_pressure<3>(const Particles<3>&, const CellOrder&, const Transfer&,
                                  SlabGrid&);
template void average_dilatation<2>(const Particles<2>&, const CellOrder&, const Transfer&,
                                    SlabGrid&, SlabGrid&);
template void average_dilatation<3>(const Particles<3>&, const CellOrder&, const Transfer&,
                                    SlabGrid&, SlabGrid&);

}  // namespace poreshock
