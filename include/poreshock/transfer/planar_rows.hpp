#pragma once
// Rows of nodes whose values of one quantity lie side by side, and the blocks of eight nodes that a
// stencil is taken in: two neighbouring lines of four nodes along the first axis.

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

  void add(const Lanes& value, int q, int b, std::ptrdiff_t lateral) const {
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

/// Row buffer of planar sums of several velocity fields; quantity q becomes lane q of the nodes.
template <int Dim, class Spline, int Quantities>
class PlanarBuffer {
 public:
  PlanarBuffer(const GridShape& shape, int fields)
      : pitch_(planar_pitch(shape)),
        values_(static_cast<std::size_t>(fields * field_size()), 0.0),
        used_(static_cast<std::size_t>(fields), 0) {
    rows.line_size = shape.nodes[0];
    for (int q = 0; q < Quantities; ++q) {
      for (int k = 0; k < Spline::width; ++k) {
        rows.rows[q][k] = values_.data() + (q * Spline::width + k) * pitch_;
      }
    }
  }
  PlanarBuffer(const PlanarBuffer&) = delete;
  PlanarBuffer& operator=(const PlanarBuffer&) = delete;

  /// Where the lateral index 0 of a field lies in `rows`, which is about to be added to.
  std::ptrdiff_t start_of(int field) {
    used_[static_cast<std::size_t>(field)] = 1;
    return field * field_size();
  }

  /// Adds the sums to the grid as those of one row and clears them.
  void flush(int row, SlabGrid& grid) {
    for (int field = 0; field < static_cast<int>(used_.size()); ++field) {
      if (used_[static_cast<std::size_t>(field)] == 0) continue;
      used_[static_cast<std::size_t>(field)] = 0;
      for (int k = 0; k < Spline::width; ++k) {
        for (const NodeRun& run : runs_of(grid.layout(), field, row + k)) {
          turn(run, field, k, grid.target(row, row + k, field, run));
        }
      }
    }
  }

  PlanarRows<Dim, Spline, Quantities> rows;

 private:
  std::ptrdiff_t field_size() const { return Spline::width * Quantities * pitch_; }

  /// Takes node row k of a field along a run out of the sums, and adds it to the nodes.
  void turn(const NodeRun& run, int field, int k, Lanes* nodes) {
    for (std::ptrdiff_t i = run.first; i < run.last; i += lane_count) {
      // The last block may go beyond the run, by less nodes than the field lacks there: it takes
      // nothing from other runs.
      Lanes block[lane_count] = {};
      for (int q = 0; q < Quantities; ++q) {
        Lanes& sums = *reinterpret_cast<Lanes*>(rows.rows[q][k] + field * field_size() + i);
        block[q] = sums;
        sums = Lanes{};
      }
      transpose(block);
      if (run.last - i >= lane_count) {
        for (int n = 0; n < lane_count; ++n) nodes[i + n] += block[n];
      } else {
        for (int n = 0; n < run.last - i; ++n) nodes[i + n] += block[n];
      }
    }
  }

  std::ptrdiff_t pitch_;
  std::vector<double> values_;
  std::vector<std::int8_t> used_;
};

}  // namespace poreshock
