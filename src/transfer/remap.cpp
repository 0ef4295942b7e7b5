#include "poreshock/transfer/remap.hpp"

#include "poreshock/transfer/blocks.hpp"
#include "poreshock/transfer/node_lanes.hpp"

namespace poreshock {

template <int Dim>
void remap_velocity(const Particles<Dim>& particles, const CellOrder& cells,
                    const Transfer& transfer, SlabGrid& grid) {
  with_hat(transfer, [&](const auto& spline) {
    scatter_values<Dim, 1 + Dim>(
        spline, particles, cells,
        [&](std::uint32_t p) {
          std::array<double, 1 + Dim> values{particles.mass[p]};
          for (int a = 0; a < Dim; ++a)
            values[1 + a] = particles.mass[p] * particles.velocity[a][p];
          return values;
        },
        grid);
  });
}

template <int Dim>
void gather_remapped(const SlabGrid& grid, const CellOrder& cells, const Transfer& transfer,
                     const Vector<Dim>& grid_velocity, double dt, Particles<Dim>& particles,
                     StepData<Dim>& step) {
  const double inverse_cell = 1.0 / grid.shape().cell;
  std::size_t place = 0;
  with_hat(transfer, [&]<class Spline>(const Spline& spline) {
    gather<Dim>(spline, particles, cells, grid,
                [&](std::uint32_t p, const Stencil<Dim, Spline>& stencil, const Lanes* nodes) {
                  std::array<Lanes, Dim> gradient{};
                  for (int n = 0; n < stencil_nodes<Dim, Spline>; ++n) {
                    for (int k = 0; k < Dim; ++k) {
                      gradient[k] += node_slope<Dim, Spline>(stencil, n, k) * nodes[n];
                    }
                  }
                  std::array<std::array<double, Dim>, Dim> g;
                  for (int a = 0; a < Dim; ++a) {
                    for (int k = 0; k < Dim; ++k) {
                      g[a][k] = gradient[k][MotionLane<Dim>::end_velocity + a] * inverse_cell;
                      step.gradient[a * Dim + k][place] = g[a][k];
                    }
                    particles.position[a][p] += dt * (step.transport[a][p] - grid_velocity[a]);
                  }
                  const auto rate = symmetric_part<Dim>(g);
                  for (int k = 0; k < rate_size<Dim>; ++k) step.rate[k][place] = rate[k];
                  ++place;
                });
  });
}

template void remap_velocity<2>(const Particles<2>&, const CellOrder&, const Transfer&, SlabGrid&);
template void remap_velocity<3>(const Particles<3>&, const CellOrder&, const Transfer&, SlabGrid&);
template void gather_remapped<2>(const SlabGrid&, const CellOrder&, const Transfer&,
                                 const Vector<2>&, double, Particles<2>&, StepData<2>&);
template void gather_remapped<3>(const SlabGrid&, const CellOrder&, const Transfer&,
                                 const Vector<3>&, double, Particles<3>&, StepData<3>&);

}  // namespace poreshock
