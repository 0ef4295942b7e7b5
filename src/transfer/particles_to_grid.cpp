#include "poreshock/transfer/particles_to_grid.hpp"

#include <cmath>

#include "poreshock/transfer/blocks.hpp"
#include "poreshock/transfer/node_lanes.hpp"

namespace poreshock {

namespace {

template <int Dim>
inline int symmetric_index(int a, int b) {
  constexpr int plane[2][2] = {{0, 3}, {3, 1}};
  constexpr int space[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
  if constexpr (Dim == 2) {
    return plane[a][b];
  } else {
    return space[a][b];
  }
}

/// Numbers of one particle that its nodes see, divided by scale^Dim where weights multiply them.
template <int Dim, Modes M>
struct PointSource {
  double mass;
  std::array<double, Dim> velocity;
  /// m/s of the higher modes, [component][mode]: r_a, then r_a^2 - D, then r_a r_b
  std::array<std::array<double, higher_modes<Dim, M>>, Dim> mode;
  std::array<std::array<double, Dim>, Dim> force;  ///< - V stress per cell: a slope gives N, eq 14
};

/// Amplitudes of the second order become coefficients; their constant parts join the velocity.
template <int Dim, class Spline>
inline void add_second_modes(const Particles<Dim>& particles, std::uint32_t p,
                             const BlockWeights<Dim, Spline, WeightParts::modes>& w,
                             PointSource<Dim, Modes::quadratic>& s) {
  constexpr double inertia = 1.0 / Spline::inverse_inertia;
  for (int a = 0; a < Dim; ++a) {
    double constant = 0.0;
    for (int k = 0; k < second_modes<Dim>; ++k) {
      const double amplitude = particles.quadratic[a * second_modes<Dim> + k][p];
      const double c =
          k < Dim ? w.inverse_norm[k] * amplitude : Spline::inverse_inertia * amplitude;
      s.mode[a][Dim + k] = c;
      if (k < Dim) constant += c;
    }
    s.velocity[a] -= inertia * constant;
  }
}

/// The weights that a transfer needs.
template <int Dim, Modes M, class Spline>
using SourceWeights =
    BlockWeights<Dim, Spline, M == Modes::quadratic ? WeightParts::modes : WeightParts::all>;

template <int Dim, Modes M, class Spline>
inline PointSource<Dim, M> point_source(const Particles<Dim>& particles, std::uint32_t p,
                                        double cell, const SourceWeights<Dim, M, Spline>& w) {
  PointSource<Dim, M> s;
  const double m = particles.mass[p];
  s.mass = unscaled<Dim, Spline>(m);
  const double pressure = particles.pressure[p] + particles.viscous_pressure[p];
  const double volume_per_cell = unscaled<Dim, Spline>(m / (particles.density[p] * cell));
  for (int a = 0; a < Dim; ++a) {
    s.velocity[a] = particles.velocity[a][p];
    for (int k = 0; k < Dim; ++k) {
      double stress = particles.deviator[symmetric_index<Dim>(a, k)][p];
      if (a == k) stress -= pressure;
      s.force[a][k] = -volume_per_cell * stress;
      if constexpr (M != Modes::constant) {
        s.mode[a][k] = particles.affine[a * Dim + k][p] * cell;
      }
    }
  }
  if constexpr (M == Modes::quadratic) add_second_modes<Dim, Spline>(particles, p, w, s);
  return s;
}

/// Velocity component a of the particle at the nodes of block b.
template <int Dim, Modes M, class Spline>
inline Lanes velocity_in(const PointSource<Dim, M>& source, const SourceWeights<Dim, M, Spline>& w,
                         int a, int b) {
  if constexpr (M == Modes::constant) {
    return source.velocity[a] - Lanes{};
  } else {
    const Lanes x = along_lines(w.offset), y = across_lines<Spline>(w.offset, b);
    const auto& mode = source.mode[a];
    if constexpr (M == Modes::affine) {
      Lanes v = fused(mode[0], x, source.velocity[a] - Lanes{});
      v = fused(mode[1], y, v);
      if constexpr (Dim == 3) v += mode[2] * across_planes<Spline>(w.offset, b);
      return v;
    } else if constexpr (Dim == 2) {
      const Lanes along = fused(mode[2], x, fused(mode[4], y, mode[0] - Lanes{}));
      const Lanes across = fused(mode[3], y, mode[1] - Lanes{});
      return fused(x, along, fused(y, across, source.velocity[a] - Lanes{}));
    } else {
      // xx yy zz xy yz zx
      const double z = across_planes<Spline>(w.offset, b);
      const double constant = source.velocity[a] + z * (mode[2] + mode[5] * z);
      const Lanes along = fused(mode[3], x, fused(mode[6], y, (mode[0] + mode[8] * z) - Lanes{}));
      const Lanes across = fused(mode[4], y, (mode[1] + mode[7] * z) - Lanes{});
      return fused(x, along, fused(y, across, constant - Lanes{}));
    }
  }
}

template <int Dim, Modes M, class Spline, class Sums>
inline void accumulate(const PointSource<Dim, M>& source, const SourceWeights<Dim, M, Spline>& w,
                       Sums& sums) {
  using Lane = SumLane<Dim>;
  for (int b = 0; b < stencil_blocks<Dim, Spline>; ++b) {
    const Lanes mass = source.mass * value_in<Dim, Spline>(w, b);
    sums[Lane::mass][b] += mass;
    for (int a = 0; a < Dim; ++a) {
      const Lanes v = velocity_in<Dim, M, Spline>(source, w, a, b);
      sums[Lane::momentum + a][b] = fused(mass, v, sums[Lane::momentum + a][b]);
    }
    for (int k = 0; k < Dim; ++k) {
      const Lanes slope = slope_in<Dim, Spline>(w, k, b);
      for (int a = 0; a < Dim; ++a) {
        sums[Lane::force + a][b] = fused(source.force[a][k], slope, sums[Lane::force + a][b]);
      }
    }
  }
}

template <int Dim, Modes M, class Spline>
void sweep(const Spline& spline, const Particles<Dim>& particles, const CellOrder& cells,
           SlabGrid& grid) {
  const double cell = grid.shape().cell;
  constexpr WeightParts parts = M == Modes::quadratic ? WeightParts::modes : WeightParts::all;
  scatter_blocks<Dim, SumLane<Dim>::count, parts>(
      spline, particles, cells,
      [&](std::uint32_t p, const SourceWeights<Dim, M, Spline>& w, auto& sums) {
        accumulate<Dim, M, Spline>(point_source<Dim, M, Spline>(particles, p, cell, w), w, sums);
      },
      grid);
}

}  // namespace

template <int Dim>
void particles_to_grid(const Particles<Dim>& particles, const CellOrder& cells,
                       const Transfer& transfer, SlabGrid& grid) {
  with_scheme(transfer, [&]<Modes M, Keeps, class Spline>(const Spline& spline) {
    sweep<Dim, M>(spline, particles, cells, grid);
  });
}

template void particles_to_grid<2>(const Particles<2>&, const CellOrder&, const Transfer&,
                                   SlabGrid&);
template void particles_to_grid<3>(const Particles<3>&, const CellOrder&, const Transfer&,
                                   SlabGrid&);

}  // namespace poreshock
