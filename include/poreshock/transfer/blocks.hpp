#pragma once
// Sweeps with a node a lane. Nodes of a stencil are taken in blocks of eight: two neighbouring
// lines of four nodes along the first axis. Rows of nodes are planar here: all values of one
// quantity lie side by side. A particle's weight, slope or velocity at eight nodes is then one
// vector, and a sum over particles is one fused operation per block and quantity.

#include <array>
#include <vector>

#include "poreshock/transfer/sweep.hpp"

namespace poreshock {

/// Pairs of lines of a plane of a stencil, the last one half empty where the width is odd.
template <class Spline>
inline constexpr int line_pairs = (Spline::width + 1) / 2;

/// Planes of a stencil: 1 in 2-D.
template <int Dim, class Spline>
inline constexpr int stencil_planes = Dim == 2 ? 1 : Spline::width;

template <int Dim, class Spline>
inline constexpr int stencil_blocks = line_pairs<Spline>* stencil_planes<Dim, Spline>;

/// One number at every node of a stencil; block b holds the lines 2 (b % line_pairs) and the next
/// of plane b / line_pairs.
template <int Dim, class Spline>
using BlockLanes = std::array<Lanes, stencil_blocks<Dim, Spline>>;

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

/// Lines of nodes of one stencil row: line j of plane k of quantity q starts, for the lateral index
/// 0, at line(q, j, k).
template <int Dim, class Spline, int Quantities>
struct PlanarRows {
  static constexpr int width = Spline::width;
  std::array<std::array<double*, width>, Quantities> rows;  ///< node rows of the stencil row
  std::ptrdiff_t line_size = 0;                             ///< 3-D: nodes of one line

  double* line(int q, int j, int k) const {
    if constexpr (Dim == 2) {
      return rows[q][j];
    } else {
      return rows[q][k] + j * line_size;
    }
  }

  Lanes load(int q, int b, int lateral) const {
    const int j = 2 * (b % line_pairs<Spline>), k = b / line_pairs<Spline>;
    const double* low = line(q, j, k) + lateral;
    // The line that an odd width lacks has no weight; the one before stands in for it.
    const double* high = j + 1 < width ? line(q, j + 1, k) + lateral : low;
    return join(*reinterpret_cast<const HalfLanes*>(low),
                *reinterpret_cast<const HalfLanes*>(high));
  }

  void add(const Lanes& value, int q, int b, int lateral) const {
    const int j = 2 * (b % line_pairs<Spline>), k = b / line_pairs<Spline>;
    *reinterpret_cast<HalfLanes*>(line(q, j, k) + lateral) += low_half(value);
    if (j + 1 < width) {
      *reinterpret_cast<HalfLanes*>(line(q, j + 1, k) + lateral) += high_half(value);
    }
  }
};

/// Doubles of one planar node row: a stencil may reach beyond its end with lanes of no weight.
inline std::ptrdiff_t planar_pitch(const GridShape& shape) {
  return (shape.row_size + 2 * lane_count - 1) / lane_count * lane_count;
}

/// Planar copies of the node rows that a stencil row sees, of chosen lanes of the nodes.
template <int Dim, class Spline, int Quantities>
class PlanarWindow {
 public:
  /// lanes: which lane of a node becomes which quantity.
  PlanarWindow(const SlabGrid& grid, const std::array<int, Quantities>& lanes)
      : grid_(grid),
        lanes_(lanes),
        pitch_(planar_pitch(grid.shape())),
        values_(static_cast<std::size_t>(Spline::width * Quantities * pitch_), 0.0),
        next_(grid.first_row()) {}

  /// Lines for a stencil row; rows come in ascending order.
  PlanarRows<Dim, Spline, Quantities> at(int row) {
    next_ = std::max(next_, row);
    for (; next_ < row + Spline::width; ++next_) copy(next_);
    PlanarRows<Dim, Spline, Quantities> result;
    result.line_size = grid_.shape().nodes[0];
    for (int q = 0; q < Quantities; ++q) {
      for (int k = 0; k < Spline::width; ++k) result.rows[q][k] = target(q, row + k);
    }
    return result;
  }

 private:
  double* target(int q, int row) {
    return values_.data() + ((row % Spline::width) * Quantities + q) * pitch_;
  }

  void copy(int row) {
    const Lanes* nodes = grid_.row(row);
    const int count = grid_.shape().row_size;
    double* targets[Quantities];
    for (int q = 0; q < Quantities; ++q) targets[q] = target(q, row);
    int i = 0;
    for (; i + lane_count <= count; i += lane_count) {
      Lanes block[lane_count];
      for (int k = 0; k < lane_count; ++k) block[k] = nodes[i + k];
      transpose(block);
      for (int q = 0; q < Quantities; ++q) {
        *reinterpret_cast<Lanes*>(targets[q] + i) = block[lanes_[q]];
      }
    }
    for (; i < count; ++i) {
      for (int q = 0; q < Quantities; ++q) targets[q][i] = nodes[i][lanes_[q]];
    }
  }

  const SlabGrid& grid_;
  std::array<int, Quantities> lanes_;
  std::ptrdiff_t pitch_;
  std::vector<double> values_;
  int next_;
};

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

/// Row buffer of planar sums; quantity q becomes lane q of the nodes.
template <int Dim, class Spline, int Quantities>
class PlanarBuffer {
 public:
  explicit PlanarBuffer(const GridShape& shape)
      : row_size_(shape.row_size),
        pitch_(planar_pitch(shape)),
        values_(static_cast<std::size_t>(Spline::width * Quantities * pitch_), 0.0),
        nodes_(static_cast<std::size_t>(Spline::width * row_size_ + lane_count)) {
    rows.line_size = shape.nodes[0];
    for (int q = 0; q < Quantities; ++q) {
      for (int k = 0; k < Spline::width; ++k) {
        rows.rows[q][k] = values_.data() + (q * Spline::width + k) * pitch_;
      }
    }
  }
  PlanarBuffer(const PlanarBuffer&) = delete;
  PlanarBuffer& operator=(const PlanarBuffer&) = delete;

  /// Adds the sums to the grid as those of one row and clears them.
  void flush(int row, SlabGrid& grid) {
    for (int k = 0; k < Spline::width; ++k) {
      Lanes* target = nodes_.data() + k * row_size_;
      // The last block may write beyond the row, where the next row comes afterwards.
      for (std::ptrdiff_t i = 0; i < row_size_; i += lane_count) {
        Lanes block[lane_count] = {};
        for (int q = 0; q < Quantities; ++q) {
          block[q] = *reinterpret_cast<const Lanes*>(rows.rows[q][k] + i);
        }
        transpose(block);
        for (int n = 0; n < lane_count; ++n) target[i + n] = block[n];
      }
    }
    grid.add_row(row, nodes_.data());
    std::fill(values_.begin(), values_.end(), 0.0);
  }

  PlanarRows<Dim, Spline, Quantities> rows;

 private:
  std::ptrdiff_t row_size_, pitch_;
  std::vector<double> values_;
  std::vector<Lanes> nodes_;
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
