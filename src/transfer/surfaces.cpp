#include "poreshock/transfer/surfaces.hpp"

#include "poreshock/transfer/node_lanes.hpp"
#include "poreshock/transfer/sweep.hpp"

namespace poreshock {

template <int Dim>
void scatter_surfaces(const Particles<Dim>& particles, const CellOrder& cells,
                      const Transfer& transfer, SlabGrid& surfaces) {
  using Lane = SurfaceLane<Dim>;
  const double cell = surfaces.shape().cell;
  with_shape(transfer, [&]<class Spline>(const Spline& spline) {
    constexpr int w = Spline::width;
    scatter<Dim>(
        spline, particles, cells,
        [&](std::uint32_t p, const Stencil<Dim, Spline>& stencil, Lanes* sums) {
          const double volume = particles.mass[p] / particles.density[p];
          for (int n = 0; n < stencil_nodes<Dim, Spline>; ++n) {
            const double share = volume * node_weight<Dim, Spline>(stencil, n);
            const int index[3] = {n % w, Dim == 3 ? (n / w) % w : n / w, n / (w * w)};
            Lanes surface{share};
            for (int a = 0; a < Dim; ++a) {
              surface[Lane::gradient + a] = volume / cell * node_slope<Dim, Spline>(stencil, n, a);
              surface[Lane::place + a] = -share * stencil.axis[a].offset[index[a]] * cell;
            }
            sums[n] += surface;
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
