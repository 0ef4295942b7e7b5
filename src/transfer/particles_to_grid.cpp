#include "poreshock/transfer/particles_to_grid.hpp"

#include "point_sources.hpp"
#include "poreshock/transfer/blocks.hpp"
#include "poreshock/transfer/node_lanes.hpp"

namespace poreshock {

namespace {

/// Velocity component a of a particle at the nodes of block b.
template <Modes M, class Spline>
inline Lanes velocity_in(const PointSource<2, M, double>& source, const BlockWeights<2, Spline>& w,
                         int a, int b) {
  const Lanes constant = source.velocity[a] - Lanes{};
  if constexpr (M == Modes::constant) return constant;
  const Lanes x = along_lines(w.offset), y = across_lines<Spline>(w.offset, b);
  const auto& mode = source.mode[a];
  if constexpr (M == Modes::affine) return fused(mode[1], y, fused(mode[0], x, constant));
  if constexpr (M == Modes::quadratic) {
    const Lanes along = fused(mode[2], x, fused(mode[4], y, mode[0] - Lanes{}));
    const Lanes across = fused(mode[3], y, mode[1] - Lanes{});
    return fused(x, along, fused(y, across, constant));
  }
}

template <Modes M, class Spline, class Sums>
inline void accumulate(const PointSource<2, M, double>& source, const BlockWeights<2, Spline>& w,
                       Sums& sums) {
  using Lane = SumLane<2>;
  for (int b = 0; b < stencil_blocks<2, Spline>; ++b) {
    const Lanes mass = source.mass * value_in<2, Spline>(w, b);
    sums[Lane::mass][b] += mass;
    for (int a = 0; a < 2; ++a) {
      const Lanes v = velocity_in<M, Spline>(source, w, a, b);
      sums[Lane::momentum + a][b] = fused(mass, v, sums[Lane::momentum + a][b]);
    }
    for (int k = 0; k < 2; ++k) {
      const Lanes slope = slope_in<2, Spline>(w, k, b);
      for (int a = 0; a < 2; ++a) {
        sums[Lane::force + a][b] = fused(source.force[a][k], slope, sums[Lane::force + a][b]);
      }
    }
  }
}

/// What a particle gives to a pair of lines of every plane of its stencil: `momentum` times a power
/// of the distance along the third axis, `force` times the weight there or its slope.
template <Modes M>
struct LinePair {
  static constexpr std::size_t powers = M == Modes::quadratic ? 3 : (M == Modes::affine ? 2 : 1);
  Lanes mass;
  std::array<std::array<Lanes, 3>, powers> momentum;  ///< [power][component]
  std::array<std::array<Lanes, 3>, 2> force;          ///< [weight, slope][component]
};

template <Modes M, class Spline>
inline LinePair<M> line_pair(const PointSource<3, M, double>& source,
                             const BlockWeights<3, Spline>& w, int pair) {
  const Lanes along = along_lines(w.value), across = across_lines<Spline>(w.value, pair);
  const Lanes x = along_lines(w.offset), y = across_lines<Spline>(w.offset, pair);
  const Lanes value = along * across;
  const Lanes slope_x = along_lines(w.slope) * across;
  const Lanes slope_y = along * across_lines<Spline>(w.slope, pair);
  LinePair<M> line;
  line.mass = source.mass * value;
  for (int a = 0; a < 3; ++a) {
    line.force[0][a] = fused(source.force[a][1], slope_y, source.force[a][0] * slope_x);
    line.force[1][a] = source.force[a][2] * value;
    const auto& mode = source.mode[a];
    Lanes v = source.velocity[a] - Lanes{};
    if constexpr (M == Modes::affine) {
      v = fused(mode[1], y, fused(mode[0], x, v));
      line.momentum[1][a] = mode[2] * line.mass;
    }
    if constexpr (M == Modes::quadratic) {
      // xx yy zz xy yz zx
      const Lanes in_x = fused(mode[3], x, fused(mode[6], y, mode[0] - Lanes{}));
      const Lanes in_y = fused(mode[4], y, mode[1] - Lanes{});
      v = fused(x, in_x, fused(y, in_y, v));
      line.momentum[1][a] = line.mass * fused(mode[8], x, fused(mode[7], y, mode[2] - Lanes{}));
      line.momentum[2][a] = mode[5] * line.mass;
    }
    line.momentum[0][a] = line.mass * v;
  }
  return line;
}

/// Weights of one particle along the third axis: slopes, and values times powers of the distance.
template <Modes M>
struct PlaneWeights {
  HalfLanes slope;
  std::array<HalfLanes, LinePair<M>::powers> value;
};

template <Modes M, class Spline>
inline PlaneWeights<M> plane_weights(const BlockWeights<3, Spline>& w) {
  const auto third = [](const auto& axes) {
    return *reinterpret_cast<const HalfLanes*>(axes.data() + lane_count);
  };
  PlaneWeights<M> planes;
  planes.slope = third(w.slope);
  planes.value[0] = third(w.value);
  for (std::size_t p = 1; p < planes.value.size(); ++p) {
    planes.value[p] = planes.value[p - 1] * third(w.offset);
  }
  return planes;
}

/// Adds what particles give to a pair of lines to the sums of the planes First and, where there is
/// one, the next: as many sums as stay in registers.
template <Modes M, class Spline, int First, class Sums>
inline void add_planes(const LinePair<M>* lines, const PlaneWeights<M>* weights,
                       std::ptrdiff_t count, int pair, Sums& sums) {
  using Lane = SumLane<3>;
  constexpr int planes = std::min(2, Spline::width - First);
  std::array<std::array<Lanes, Lane::count>, planes> local;
  const auto each_sum = [&](auto&& visit) {
#pragma GCC unroll 2
    for (int k = 0; k < planes; ++k) {
#pragma GCC unroll 7
      for (int q = 0; q < Lane::count; ++q) {
        visit(local[k][q], sums[q][(First + k) * line_pairs<Spline> + pair]);
      }
    }
  };
  each_sum([](Lanes& here, const Lanes& sum) { here = sum; });
  for (std::ptrdiff_t n = 0; n < count; ++n) {
    const LinePair<M>& line = lines[n];
    const PlaneWeights<M>& w = weights[n];
#pragma GCC unroll 2
    for (int k = 0; k < planes; ++k) {
      auto& sum = local[k];
      sum[Lane::mass] = fused(w.value[0][First + k], line.mass, sum[Lane::mass]);
#pragma GCC unroll 3
      for (int a = 0; a < 3; ++a) {
        Lanes &force = sum[Lane::force + a], &momentum = sum[Lane::momentum + a];
        force = fused(w.value[0][First + k], line.force[0][a], force);
        force = fused(w.slope[First + k], line.force[1][a], force);
#pragma GCC unroll 3
        for (std::size_t p = 0; p < w.value.size(); ++p) {
          momentum = fused(w.value[p][First + k], line.momentum[p][a], momentum);
        }
      }
    }
  }
  each_sum([](const Lanes& here, Lanes& sum) { sum = here; });
}

/// Adds the first `count` of eight particles to the sums of their nodes.
template <Modes M, class Spline, class Sums>
inline void accumulate(const PointSource<3, M, Lanes>& eight, std::ptrdiff_t count,
                       const BlockWeights<3, Spline>* weights, Sums& sums) {
  PlaneWeights<M> planes[lane_count];
  LinePair<M> lines[lane_count];
  for (std::ptrdiff_t n = 0; n < count; ++n) planes[n] = plane_weights<M>(weights[n]);
  for (int pair = 0; pair < line_pairs<Spline>; ++pair) {
    for (int n = 0; n < count; ++n) {
      lines[n] = line_pair<M, Spline>(source_of(eight, n), weights[n], pair);
    }
    add_planes<M, Spline, 0>(lines, planes, count, pair, sums);
    if constexpr (Spline::width > 2) {
      add_planes<M, Spline, 2>(lines, planes, count, pair, sums);
    }
  }
}

/// In the plane batches are short and their particles are taken one by one.
template <Modes M, class Spline, class Sums>
inline void add_batch(const Particles<2>& particles, const Batch<2>& batch, double cell,
                      const BlockWeights<2, Spline>* weights, Sums& sums) {
  for (std::ptrdiff_t n = 0; n < batch.count; ++n) {
    PointSource<2, M, double> source;
    load_sources<2, M, Spline>(particles, batch.first[n], batch.base, cell, source);
    accumulate<M, Spline>(source, weights[n], sums);
  }
}

template <Modes M, class Spline, class Sums>
inline void add_batch(const Particles<3>& particles, const Batch<3>& batch, double cell,
                      const BlockWeights<3, Spline>* weights, Sums& sums) {
  PointSource<3, M, Lanes> eight;
  const LaneParticles lanes = lane_particles(batch.first, batch.count, particles.size());
  load_sources<3, M, Spline>(particles, lanes, batch.base, cell, eight);
  accumulate<M, Spline>(eight, batch.count, weights, sums);
}

template <int Dim, Modes M, class Spline>
void sweep(const Spline& spline, const Particles<Dim>& particles, const CellOrder& cells,
           SlabGrid& grid) {
  scatter_blocks<Dim, SumLane<Dim>::count>(
      spline, particles, cells,
      [&](const Batch<Dim>& batch, const BlockWeights<Dim, Spline>* weights, auto& sums) {
        add_batch<M, Spline>(particles, batch, grid.shape().cell, weights, sums);
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
