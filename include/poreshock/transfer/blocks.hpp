#pragma once
// Sweeps with a node a lane. Nodes of a stencil are taken in blocks of eight: two neighbouring
// lines of four nodes along the first axis. Rows of nodes are planar here: all values of one
// quantity lie side by side. A particle's weight, slope or velocity at eight nodes is then one
// vector, and a sum over particles is one fused operation per block and quantity.

#include <array>

#include "poreshock/transfer/planar_rows.hpp"
#include "poreshock/transfer/sweep.hpp"

namespace poreshock {

/// What a sweep needs of the weights.
enum class WeightParts { values, all };

/// Weights of a particle along its axes, four nodes an axis, times `scale` each: value, slope per
/// cell, and offset in cells. In memory, where one number is spread over lanes as it loads.
template <int Dim, class Spline, WeightParts Parts = WeightParts::all>
struct BlockWeights {
  static constexpr std::size_t size = Dim == 2 ? lane_count : 2 * lane_count;
  static constexpr std::size_t others = Parts == WeightParts::values ? 0 : size;
  alignas(64) std::array<double, size> value;
  std::array<double, others> slope, offset;
};

template <int Dim, class Spline, WeightParts Parts>
inline void set_block_weights(const Spline& spline, const Particles<Dim>& particles,
                              std::uint32_t p, const std::array<int, Dim>& base,
                              double inverse_cell, BlockWeights<Dim, Spline, Parts>& w) {
  const auto store = [&w](const AxisLanes& lanes, int first) {
    *reinterpret_cast<Lanes*>(w.value.data() + first) = lanes.value;
    if constexpr (Parts != WeightParts::values) {
      *reinterpret_cast<Lanes*>(w.slope.data() + first) = lanes.slope;
      *reinterpret_cast<Lanes*>(w.offset.data() + first) = lanes.offset;
    }
  };
  for_each_axis_pair<Dim>(spline, particles, p, base, inverse_cell, store);
}

/// One number of the first axis at the nodes of any block.
template <std::size_t Size>
inline Lanes along_lines(const std::array<double, Size>& axes) {
  const HalfLanes line = *reinterpret_cast<const HalfLanes*>(axes.data());
  return join(line, line);
}

/// One number of the second axis at the nodes of block b.
template <class Spline, std::size_t Size>
inline Lanes across_lines(const std::array<double, Size>& axes, int b) {
  const double* const pair = axes.data() + 4 + 2 * (b % line_pairs<Spline>);
  return join(pair[0] - HalfLanes{}, pair[1] - HalfLanes{});
}

/// One number of the third axis at all nodes of block b.
template <class Spline, std::size_t Size>
inline double across_planes(const std::array<double, Size>& axes, int b) {
  return axes.data()[lane_count + b / line_pairs<Spline>];
}

/// Weights at the nodes of block b.
template <int Dim, class Spline, WeightParts Parts>
inline Lanes value_in(const BlockWeights<Dim, Spline, Parts>& w, int b) {
  const Lanes plane = along_lines(w.value) * across_lines<Spline>(w.value, b);
  if constexpr (Dim == 2) {
    return plane;
  } else {
    return across_planes<Spline>(w.value, b) * plane;
  }
}

/// Slopes along axis a at the nodes of block b, per cell.
template <int Dim, class Spline, WeightParts Parts>
inline Lanes slope_in(const BlockWeights<Dim, Spline, Parts>& w, int a, int b) {
  const Lanes plane =
      along_lines(a == 0 ? w.slope : w.value) * across_lines<Spline>(a == 1 ? w.slope : w.value, b);
  if constexpr (Dim == 2) {
    return plane;
  } else {
    return across_planes<Spline>(a == 2 ? w.slope : w.value, b) * plane;
  }
}

/// All cells of a sweep.
inline constexpr auto every_cell = [](int, int) { return true; };

/// Scatters in blocks: accumulate(batch, weights of its particles, sums) adds them to
/// sums[quantity][block], for cells with takes(row, lateral). Sums of a run start at +0 and are
/// added to the row buffer of its velocity field, that to the grid. Not collective.
template <int Dim, int Quantities, WeightParts Parts = WeightParts::all, class Spline,
          class Accumulate, class Takes = decltype(every_cell)>
void scatter_blocks(const Spline& spline, const Particles<Dim>& particles, const CellOrder& cells,
                    Accumulate&& accumulate, SlabGrid& grid, const Takes& takes = every_cell) {
  constexpr int blocks = stencil_blocks<Dim, Spline>;
  const GridShape& shape = grid.shape();
  const double inverse_cell = 1.0 / shape.cell;
  PlanarBuffer<Dim, Spline, Quantities> buffer(shape, grid.fields());
  grid.clear();
  using Weights = BlockWeights<Dim, Spline, Parts>;
  const auto prepare = [&](std::uint32_t p, const std::array<int, Dim>& base, Weights& w) {
    set_block_weights<Dim>(spline, particles, p, base, inverse_cell, w);
  };
  for_each_run(
      particles, cells, grid, awake_rows(cells, grid),
      [&](int row, int lateral, const std::uint32_t* first, const std::uint32_t* last) {
        if (!takes(row, lateral)) return;
        alignas(64) Lanes sums[Quantities][blocks] = {};
        for_each_batch<Dim, Weights>(
            first, last, cell_index<Dim>(shape, row, lateral), prepare,
            [&](const Batch<Dim>& batch, const Weights* w) { accumulate(batch, w, sums); });
        const std::ptrdiff_t at =
            buffer.start_of(field_of(particles, cells, *first, grid)) + lateral;
        for (int q = 0; q < Quantities; ++q) {
          for (int b = 0; b < blocks; ++b) buffer.rows.add(sums[q][b], q, b, at);
        }
      },
      [&](int row) { buffer.flush(row, grid); });
}

/// Adds weight times value to the sums of every quantity.
template <int Dim, class Spline, WeightParts Parts, std::size_t Quantities, class Sums>
inline void add_values(const BlockWeights<Dim, Spline, Parts>& w,
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
  constexpr WeightParts parts = WeightParts::values;
  scatter_blocks<Dim, Quantities, parts>(
      spline, particles, cells,
      [&](const Batch<Dim>& batch, const BlockWeights<Dim, Spline, parts>* w, auto& sums) {
        for (std::ptrdiff_t n = 0; n < batch.count; ++n) {
          std::array<double, Quantities> value = values(batch.first[n]);
          for (double& x : value) x = unscaled<Dim, Spline>(x);
          add_values(w[n], value, sums);
        }
      },
      grid);
}

}  // namespace poreshock
