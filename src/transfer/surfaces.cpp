#include "poreshock/transfer/surfaces.hpp"

#include "poreshock/transfer/node_lanes.hpp"
#include "poreshock/transfer/sweep.hpp"

namespace poreshock {

namespace {

/// SurfaceLane of one particle at one node. Built at once: writing single lanes would go through
/// memory.
template <int Dim>
inline Lanes surface_lanes(double volume, const std::array<double, Dim>& slope,
                           const std::array<double, Dim>& place, double strain,
                           const std::array<double, Dim>& facing) {
  if constexpr (Dim == 2) {
    return Lanes{volume,   slope[0], slope[1],           place[0],
                 place[1], strain,   volume * facing[0], volume * facing[1]};
  } else {
    return Lanes{volume, slope[0], slope[1], slope[2], place[0], place[1], place[2], strain};
  }
}

}  // namespace

template <int Dim>
void scatter_surfaces(const Particles<Dim>& particles, const CellOrder& cells,
                      const Transfer& transfer, SlabGrid& surfaces) {
  const double cell = surfaces.shape().cell;
  const bool faces = particles.options.facing;
  with_shape(transfer, [&]<class Spline>(const Spline& spline) {
    constexpr int w = Spline::width;
    scatter<Dim>(
        spline, particles, cells,
        [&](std::uint32_t p, const Stencil<Dim, Spline>& stencil, Lanes* sums) {
          const double volume = particles.mass[p] / particles.density[p];
          const double per_cell = volume / cell;
          const double strain = particles.plastic_strain[p];
          std::array<double, Dim> facing{};
          for (int a = 0; a < Dim; ++a) facing[a] = faces ? particles.facing[a][p] : 0.0;
          for (int n = 0; n < stencil_nodes<Dim, Spline>; ++n) {
            const double share = volume * node_weight<Dim, Spline>(stencil, n);
            const int index[3] = {n % w, Dim == 3 ? (n / w) % w : n / w, n / (w * w)};
            std::array<double, Dim> slope, place;
            for (int a = 0; a < Dim; ++a) {
              slope[a] = per_cell * node_slope<Dim, Spline>(stencil, n, a);
              place[a] = -share * stencil.axis[a].offset[index[a]] * cell;
            }
            sums[n] += surface_lanes<Dim>(share, slope, place, share * strain, facing);
          }
        },
        surfaces);
  });
}

template void scatter_surfaces<2>(const Particles<2>&, const CellOrder&, const Transfer&,
                                  SlabGrid&);
template void scatter_surfaces<3>(const Particles<3>&, const CellOrder&, const Transfer&,
                                  SlabGrid&);

}  // namespace poreshock
