#include "poreshock/transfer/particles_to_grid.hpp"

#include <optional>

#include "poreshock/transfer/blocks.hpp"
#include "poreshock/transfer/node_lanes.hpp"

namespace poreshock {

namespace {

/// Which kinetic energy of its particles a node sums: FLIP loses none on the way, PIC that
/// of v_p, APIC that of v_p + C_p d.
enum class KineticEnergy { none, plain, affine };

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
template <int Dim>
struct PointSource {
  double mass;
  std::array<double, Dim> velocity;
  std::array<std::array<double, Dim>, Dim> affine;  ///< m/s per cell, [component][direction]
  std::array<std::array<double, Dim>, Dim> force;   ///< - V stress per cell: a slope gives N, eq 14
};

template <int Dim, KineticEnergy Kinetic, class Spline>
inline PointSource<Dim> point_source(const Particles<Dim>& particles, std::uint32_t p,
                                     double pressure, double cell) {
  PointSource<Dim> s;
  const double m = particles.mass[p];
  s.mass = unscaled<Dim, Spline>(m);
  const double volume_per_cell = unscaled<Dim, Spline>(m / (particles.density[p] * cell));
  for (int a = 0; a < Dim; ++a) {
    s.velocity[a] = particles.velocity[a][p];
    for (int k = 0; k < Dim; ++k) {
      double stress = particles.deviator[symmetric_index<Dim>(a, k)][p];
      if (a == k) stress -= pressure;
      s.force[a][k] = -volume_per_cell * stress;
      if constexpr (Kinetic == KineticEnergy::affine) {
        s.affine[a][k] = particles.affine[a * Dim + k][p] * cell;
      }
    }
  }
  return s;
}

/// Velocity component a of the particle at the nodes of block b.
template <int Dim, KineticEnergy Kinetic, class Spline>
inline Lanes velocity_in(const PointSource<Dim>& source, const BlockWeights<Dim, Spline>& w, int a,
                         int b) {
  if constexpr (Kinetic != KineticEnergy::affine) {
    return source.velocity[a] - Lanes{};
  } else {
    Lanes v = fused(source.affine[a][0], along_lines(w.offset), source.velocity[a] - Lanes{});
    v = fused(source.affine[a][1], across_lines<Spline>(w.offset, b), v);
    if constexpr (Dim == 3) v += source.affine[a][2] * across_planes<Spline>(w.offset, b);
    return v;
  }
}

template <int Dim, KineticEnergy Kinetic, class Spline, class Sums>
inline void accumulate(const PointSource<Dim>& source, const BlockWeights<Dim, Spline>& w,
                       Sums& sums) {
  using Lane = SumLane<Dim>;
  for (int b = 0; b < stencil_blocks<Dim, Spline>; ++b) {
    const Lanes mass = source.mass * value_in<Dim, Spline>(w, b);
    sums[Lane::mass][b] += mass;
    Lanes square{};
    for (int a = 0; a < Dim; ++a) {
      const Lanes v = velocity_in<Dim, Kinetic, Spline>(source, w, a, b);
      sums[Lane::momentum + a][b] = fused(mass, v, sums[Lane::momentum + a][b]);
      if constexpr (Kinetic != KineticEnergy::none) square = fused(v, v, square);
    }
    if constexpr (Kinetic != KineticEnergy::none) {
      sums[Lane::kinetic][b] = fused(0.5 * mass, square, sums[Lane::kinetic][b]);
    }
    for (int k = 0; k < Dim; ++k) {
      const Lanes slope = slope_in<Dim, Spline>(w, k, b);
      for (int a = 0; a < Dim; ++a) {
        sums[Lane::force + a][b] = fused(source.force[a][k], slope, sums[Lane::force + a][b]);
      }
    }
  }
}

template <int Dim, KineticEnergy Kinetic, class Spline>
void sweep(const Spline& spline, const Particles<Dim>& particles, const CellOrder& cells,
           const SlabGrid* averages, double share, SlabGrid& grid) {
  constexpr int quantities = SumLane<Dim>::kinetic + (Kinetic != KineticEnergy::none ? 1 : 0);
  const double cell = grid.shape().cell;
  std::optional<BlockReader<Dim, Spline, 1>> reader;
  if (averages != nullptr) reader.emplace(*averages, std::array{AverageLane::pressure});
  scatter_blocks<Dim, quantities>(
      spline, particles, cells,
      [&](int row, int lateral) {
        if (reader) reader->load(row, lateral);
      },
      [&](std::uint32_t p, const BlockWeights<Dim, Spline>& w, auto& sums) {
        double pressure = particles.pressure[p] + particles.viscous_pressure[p];
        if (reader) {
          pressure =
              (1.0 - share) * pressure + share * interpolate<Dim, Spline>(w, reader->nodes[0]);
        }
        accumulate<Dim, Kinetic>(point_source<Dim, Kinetic, Spline>(particles, p, pressure, cell),
                                 w, sums);
      },
      grid);
}

}  // namespace

template <int Dim>
void particles_to_grid(const Particles<Dim>& particles, const CellOrder& cells,
                       const Transfer& transfer, const SlabGrid* averages, SlabGrid& grid) {
  const double share = transfer.averaging;
  with_shape(transfer, [&]<class Spline>(const Spline& spline) {
    if constexpr (is_spline<Spline>) {
      if (transfer.velocity == VelocityTransfer::apic) {
        return sweep<Dim, KineticEnergy::affine>(spline, particles, cells, averages, share, grid);
      }
      if (transfer.velocity == VelocityTransfer::pic) {
        return sweep<Dim, KineticEnergy::plain>(spline, particles, cells, averages, share, grid);
      }
    }
    sweep<Dim, KineticEnergy::none>(spline, particles, cells, averages, share, grid);
  });
}

template void particles_to_grid<2>(const Particles<2>&, const CellOrder&, const Transfer&,
                                   const SlabGrid*, SlabGrid&);
template void particles_to_grid<3>(const Particles<3>&, const CellOrder&, const Transfer&,
                                   const SlabGrid*, SlabGrid&);

}  // namespace poreshock
