#pragma once
// Sweeps with a node a lane. Nodes of a stencil are taken in blocks of eight: two neighbouring
// lines of four nodes along the first axis. Rows of nodes are planar here: all values of one
// quantity lie side by side. A particle's weight, slope or velocity at eight nodes is then one
// vector, and a sum over particles is one fused operation per block and quantity.

#include <array>

#include "poreshock/transfer/planar_rows.hpp"
#include "poreshock/transfer/sweep.hpp"

namespace poreshock {

/// Weights of a particle in blocks, times scale^Dim; slopes are per cell, offsets in cells.
template <int Dim, class Spline>
struct BlockWeights {
  AxisLanes x;
  std::array<AxisLanes, line_pairs<Spline>> y;
  std::array<double, Spline::width> z_value, z_slope, z_offset;  ///< 3-D only
};

template <int Dim, class Spline>
inline BlockWeights<Dim, Spline> block_weights(const Spline& spline,
                                               const Particles<Dim>& particles, std::uint32_t p,
                                               const std::array<int, Dim>& base,
                                               double inverse_cell) {
  const auto local = [&](int a) {
    return Spline::local(particles.position[a][p] * inverse_cell, base[a]);
  };
  BlockWeights<Dim, Spline> w;
  w.x = spline.template lanes<AlongLine>(local(0));
  w.y[0] = spline.template lanes<AcrossLines<0>>(local(1));
  if constexpr (Spline::width > 2) {
    w.y[1] = spline.template lanes<AcrossLines<2>>(local(1));
  }
  if constexpr (Dim == 3) {
    const AxisLanes z = spline.template lanes<AlongLine>(local(2));
    for (int k = 0; k < Spline::width; ++k) {
      w.z_value[k] = z.value[k];
      w.z_slope[k] = z.slope[k];
      w.z_offset[k] = z.offset[k];
    }
  }
  return w;
}

/// Weights at the nodes of block b.
template <int Dim, class Spline>
inline Lanes value_in(const BlockWeights<Dim, Spline>& w, int b) {
  const Lanes plane = w.x.value * w.y[b % line_pairs<Spline>].value;
  if constexpr (Dim == 2) {
    return plane;
  } else {
    return w.z_value[b / line_pairs<Spline>] * plane;
  }
}

/// Slopes along axis a at the nodes of block b, per cell.
template <int Dim, class Spline>
inline Lanes slope_in(const BlockWeights<Dim, Spline>& w, int a, int b) {
  const AxisLanes& y = w.y[b % line_pairs<Spline>];
  const Lanes plane = (a == 0 ? w.x.slope : w.x.value) * (a == 1 ? y.slope : y.value);
  if constexpr (Dim == 2) {
    return plane;
  } else {
    const int k = b / line_pairs<Spline>;
    return (a == 2 ? w.z_slope[k] : w.z_value[k]) * plane;
  }
}

/// The nodes of one stencil in blocks, of chosen lanes, loaded run by run in row order.
template <int Dim, class Spline, int Quantities>
struct BlockReader {
  PlanarWindow<Dim, Spline, Quantities> window;
  PlanarRows<Dim, Spline, Quantities> rows{};
  std::array<BlockLanes<Dim, Spline>, Quantities> nodes;
  int row = -1;

  BlockReader(const SlabGrid& grid, const std::array<int, Quantities>& lanes)
      : window(grid, lanes) {}

  void load(int stencil_row, int lateral) {
    if (stencil_row != row) rows = window.at(row = stencil_row);
    for (int q = 0; q < Quantities; ++q) {
      for (int b = 0; b < stencil_blocks<Dim, Spline>; ++b) nodes[q][b] = rows.load(q, b, lateral);
    }
  }
};

/// Scatters in blocks: accumulate(p, weights, sums) adds one particle to sums[quantity][block].
/// begin_run(row, lateral) comes before each run. Sums of a run start at +0 and are added to the
/// row buffer, that to the grid. Not collective.
template <int Dim, int Quantities, class Spline, class BeginRun, class Accumulate>
void scatter_blocks(const Spline& spline, const Particles<Dim>& particles, const CellOrder& cells,
                    BeginRun&& begin_run, Accumulate&& accumulate, SlabGrid& grid) {
  constexpr int blocks = stencil_blocks<Dim, Spline>;
  const GridShape& shape = grid.shape();
  const double inverse_cell = 1.0 / shape.cell;
  PlanarBuffer<Dim, Spline, Quantities> buffer(shape);
  grid.clear();
  for_each_run(
      particles, cells, grid, awake_rows(cells, grid),
      [&](int row, int lateral, const std::uint32_t* first, const std::uint32_t* last) {
        const auto base = cell_index<Dim>(shape, row, lateral);
        alignas(64) Lanes sums[Quantities][blocks] = {};
        begin_run(row, lateral);
        for (; first != last; ++first) {
          accumulate(*first, block_weights<Dim>(spline, particles, *first, base, inverse_cell),
                     sums);
        }
        for (int q = 0; q < Quantities; ++q) {
          for (int b = 0; b < blocks; ++b) buffer.rows.add(sums[q][b], q, b, lateral);
        }
      },
      [&](int row) { buffer.flush(row, grid); });
}

/// Adds weight times value to the sums of every quantity.
template <int Dim, class Spline, std::size_t Quantities, class Sums>
inline void add_values(const BlockWeights<Dim, Spline>& w,
                       const std::array<double, Quantities>& values, Sums& sums) {
  for (int b = 0; b < stencil_blocks<Dim, Spline>; ++b) {
    const Lanes weight = value_in<Dim, Spline>(w, b);
    for (std::size_t q = 0; q < Quantities; ++q) {
      sums[q][b] = fused(values[q], weight, sums[q][b]);
    }
  }
}

/// Scatters per-particle numbers: values(p) is an array that each node gets times the weight.
template <int Dim, int Quantities, class Spline, class Values>
void scatter_values(const Spline& spline, const Particles<Dim>& particles, const CellOrder& cells,
                    Values&& values, SlabGrid& grid) {
  scatter_blocks<Dim, Quantities>(
      spline, particles, cells, [](int, int) {},
      [&](std::uint32_t p, const BlockWeights<Dim, Spline>& w, auto& sums) {
        std::array<double, Quantities> value = values(p);
        for (double& x : value) x = unscaled<Dim, Spline>(x);
        add_values(w, value, sums);
      },
      grid);
}

/// Sum of weight times value over the nodes of a stencil.
template <int Dim, class Spline>
inline double interpolate(const BlockWeights<Dim, Spline>& w,
                          const BlockLanes<Dim, Spline>& nodes) {
  Lanes sum{};
  for (int b = 0; b < stencil_blocks<Dim, Spline>; ++b) {
    sum = fused(value_in<Dim, Spline>(w, b), nodes[b], sum);
  }
  return unscaled<Dim, Spline>(sum_of_lanes(sum));
}

}  // namespace poreshock
