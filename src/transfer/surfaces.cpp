#include "poreshock/transfer/surfaces.hpp"

#include "poreshock/transfer/blocks.hpp"
#include "poreshock/transfer/node_lanes.hpp"

namespace poreshock {

namespace {

/// Lanes that a scene needs: those of facing come last.
template <int Dim>
constexpr int plain_lanes = SurfaceLane<Dim>::strain + 1;

/// SurfaceLane of one particle. `volume` is divided by scale^Dim.
template <int Dim, int Count, class Spline>
inline void add_surface(const Particles<Dim>& particles, std::uint32_t p, double volume,
                        double cell, const BlockWeights<Dim, Spline>& w,
                        Lanes (&sums)[Count][stencil_blocks<Dim, Spline>]) {
  using Surface = SurfaceLane<Dim>;
  const double per_cell = volume / cell, strain = particles.plastic_strain[p];
  for (int b = 0; b < stencil_blocks<Dim, Spline>; ++b) {
    const Lanes share = volume * value_in<Dim, Spline>(w, b);
    sums[Surface::volume][b] += share;
    sums[Surface::strain][b] = fused(strain, share, sums[Surface::strain][b]);
    const Lanes way = -cell * share;
    sums[Surface::place][b] += way * along_lines(w.offset);
    sums[Surface::place + 1][b] += way * across_lines<Spline>(w.offset, b);
    if constexpr (Dim == 3) {
      sums[Surface::place + 2][b] += way * across_planes<Spline>(w.offset, b);
    }
    for (int a = 0; a < Dim; ++a) {
      sums[Surface::gradient + a][b] =
          fused(per_cell, slope_in<Dim, Spline>(w, a, b), sums[Surface::gradient + a][b]);
    }
    if constexpr (Count > plain_lanes<Dim>) {
      for (int a = 0; a < Dim; ++a) {
        sums[Surface::facing + a][b] =
            fused(particles.facing[a][p], share, sums[Surface::facing + a][b]);
      }
    }
  }
}

template <int Dim, int Count, class Spline>
void scatter_lanes(const Spline& spline, const Particles<Dim>& particles, const CellOrder& cells,
                   const ChosenCells& chosen, SlabGrid& surfaces) {
  const double cell = surfaces.shape().cell;
  scatter_blocks<Dim, Count>(
      spline, particles, cells,
      [&](const Batch<Dim>& batch, const BlockWeights<Dim, Spline>* w, auto& sums) {
        for (std::ptrdiff_t n = 0; n < batch.count; ++n) {
          const std::uint32_t p = batch.first[n];
          const double volume = unscaled<Dim, Spline>(particles.mass[p] / particles.density[p]);
          add_surface<Dim, Count, Spline>(particles, p, volume, cell, w[n], sums);
        }
      },
      surfaces, [&](int row, int lateral) { return is_chosen(chosen, row, lateral, surfaces); });
}

}  // namespace

template <int Dim>
void scatter_surfaces(const Particles<Dim>& particles, const CellOrder& cells,
                      const ChosenCells& chosen, const Transfer& transfer, SlabGrid& surfaces) {
  with_shape(transfer, [&](const auto& spline) {
    if (Dim == 2 && particles.options.facing) {
      constexpr int all = Dim == 2 ? SurfaceLane<2>::facing + 2 : plain_lanes<Dim>;
      scatter_lanes<Dim, all>(spline, particles, cells, chosen, surfaces);
    } else {
      scatter_lanes<Dim, plain_lanes<Dim>>(spline, particles, cells, chosen, surfaces);
    }
  });
}

template void scatter_surfaces<2>(const Particles<2>&, const CellOrder&, const ChosenCells&,
                                  const Transfer&, SlabGrid&);
template void scatter_surfaces<3>(const Particles<3>&, const CellOrder&, const ChosenCells&,
                                  const Transfer&, SlabGrid&);

}  // namespace poreshock
