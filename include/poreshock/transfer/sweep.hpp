#pragma once
// Walking particles row by row, run by run: the frame that all transfer kernels share.

#include <algorithm>
#include <vector>

#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/particles/cell_order.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/scene/transfer_scheme.hpp"

namespace poreshock {

/// Weights of a particle along all axes.
template <int Dim, class Spline>
struct Stencil {
  std::array<AxisWeights<Spline::width>, Dim> axis;
};

/// Weight of stencil node n.
template <int Dim, class Spline>
inline double node_weight(const Stencil<Dim, Spline>& s, int n) {
  constexpr int w = Spline::width;
  if constexpr (Dim == 2) {
    return s.axis[0].value[n % w] * s.axis[1].value[n / w];
  } else {
    return s.axis[0].value[n % w] * s.axis[1].value[(n / w) % w] * s.axis[2].value[n / (w * w)];
  }
}

/// Slope of the weight of stencil node n along axis k, per cell.
template <int Dim, class Spline>
inline double node_slope(const Stencil<Dim, Spline>& s, int n, int k) {
  constexpr int w = Spline::width;
  const int index[3] = {n % w, Dim == 3 ? (n / w) % w : n / w, n / (w * w)};
  double slope = 1.0;
  for (int a = 0; a < Dim; ++a) {
    slope *= a == k ? s.axis[a].slope[index[a]] : s.axis[a].value[index[a]];
  }
  return slope;
}

/// Number of nodes of a stencil.
template <int Dim, class Spline>
inline constexpr int stencil_nodes =
    Dim == 2 ? Spline::width* Spline::width : Spline::width* Spline::width* Spline::width;

/// Lowest node of the stencil cell along every axis, from row and lateral index.
template <int Dim>
inline std::array<int, Dim> cell_index(const GridShape& shape, int row, int lateral) {
  if constexpr (Dim == 2) {
    return {lateral, row};
  } else {
    return {lateral % shape.nodes[0], lateral / shape.nodes[0], row};
  }
}

template <int Dim, class Spline>
inline Stencil<Dim, Spline> stencil_at(const Spline& spline, const Particles<Dim>& particles,
                                       std::uint32_t p, const std::array<int, Dim>& base,
                                       double inverse_cell) {
  Stencil<Dim, Spline> result;
  for (int a = 0; a < Dim; ++a) {
    result.axis[a] = axis_weights(spline, particles.position[a][p] * inverse_cell, base[a]);
  }
  return result;
}

/// Calls store(weights, first place) for the axes of a particle, two at a time, four places an
/// axis.
template <int Dim, class Spline, class Store>
inline void for_each_axis_pair(const Spline& spline, const Particles<Dim>& particles,
                               std::uint32_t p, const std::array<int, Dim>& base,
                               double inverse_cell, Store&& store) {
  const auto local = [&](int a) {
    return local_place<Spline>(particles.position[a][p] * inverse_cell, base[a]);
  };
  store(weights_of_two(spline, local(0), local(1)), 0);
  if constexpr (Dim == 3) store(weights_of_two(spline, local(2), local(2)), lane_count);
}

/// Offset of stencil node n in a block of node rows that starts at the cell's lateral index.
/// Stencil nodes are numbered x fastest, shock axis slowest.
template <int Dim, class Spline>
inline std::ptrdiff_t node_offset(const GridShape& shape, int n) {
  constexpr int w = Spline::width;
  if constexpr (Dim == 2) {
    return static_cast<std::ptrdiff_t>(n / w) * shape.row_size + n % w;
  } else {
    return static_cast<std::ptrdiff_t>(n / (w * w)) * shape.row_size +
           static_cast<std::ptrdiff_t>((n / w) % w) * shape.nodes[0] + n % w;
  }
}

/// All rows of stencil cells of a slab.
inline RowRange all_rows(const SlabGrid& grid) {
  return {grid.first_row(), grid.last_row()};
}

/// The rows of a slab that are awake.
inline RowRange awake_rows(const CellOrder& cells, const SlabGrid& grid) {
  const int first = std::clamp(cells.awake.first, grid.first_row(), grid.last_row());
  return {first, std::clamp(cells.awake.last, first, grid.last_row())};
}

/// Place in the canonical order of the first particle of a row; of the end for last_row().
inline std::uint32_t first_place(const CellOrder& cells, const SlabGrid& grid, int row) {
  return cells.start[static_cast<std::size_t>(row - grid.first_row()) * grid.shape().row_size];
}

/// Part of each particle as stored.
template <int Dim>
const std::int32_t* parts_of(const Particles<Dim>& particles, const CellOrder& cells) {
  return cells.part.empty() ? particles.grain.data() : cells.part.data();
}

/// Velocity field of a grid to which the particles of a run belong, p being one of them.
template <int Dim>
int field_of(const Particles<Dim>& particles, const CellOrder& cells, std::uint32_t p,
             const SlabGrid& grid) {
  if (grid.fields() == 1) return 0;
  return cells.field[static_cast<std::size_t>(parts_of(particles, cells)[p])];
}

/// Calls run(row, lateral, first, last) for every run of particles of one cell and one part in the
/// rows of a range, rows in order, and row_end(row) after each row that has particles.
template <int Dim, class Run, class RowEnd>
void for_each_run(const Particles<Dim>& particles, const CellOrder& cells, const SlabGrid& grid,
                  RowRange rows, Run&& run, RowEnd&& row_end) {
  const int width = grid.shape().row_size;
  const std::int32_t* const part = parts_of(particles, cells);
  for (int row = rows.first; row < rows.last; ++row) {
    const std::size_t row_cell = static_cast<std::size_t>(row - grid.first_row()) * width;
    if (cells.start[row_cell] == cells.start[row_cell + width]) continue;
    for (int lateral = 0; lateral < width; ++lateral) {
      const std::uint32_t* first = cells.order.data() + cells.start[row_cell + lateral];
      const std::uint32_t* const end = cells.order.data() + cells.start[row_cell + lateral + 1];
      while (first != end) {
        const std::uint32_t* last = first + 1;
        while (last != end && part[*last] == part[*first]) ++last;
        run(row, lateral, first, last);
        first = last;
      }
    }
    row_end(row);
  }
}

/// At most eight particles of one run.
template <int Dim>
struct Batch {
  const std::uint32_t* first;
  std::ptrdiff_t count;
  std::array<int, Dim> base;  ///< lowest node of their stencil
};

/// Calls visit(batch, weights of its particles) for all of a run; prepare(p, base, weights) makes
/// them for the whole batch first, so that they do not wait for each other, and in place: a copy
/// would wait for its stores.
template <int Dim, class Weights, class Prepare, class Visit>
inline void for_each_batch(const std::uint32_t* first, const std::uint32_t* last,
                           const std::array<int, Dim>& base, Prepare&& prepare, Visit&& visit) {
  Weights prepared[lane_count];
  while (first != last) {
    const Batch<Dim> batch = {first, std::min<std::ptrdiff_t>(lane_count, last - first), base};
    for (std::ptrdiff_t n = 0; n < batch.count; ++n) prepare(first[n], base, prepared[n]);
    visit(batch, prepared);
    first += batch.count;
  }
}

/// Scatters to nodes: accumulate(p, stencil, sums) adds one particle to the sums of its stencil
/// nodes; sums of a run start at +0 and are added to the row buffer, that to the grid. Not
/// collective.
template <int Dim, class Spline, class Accumulate>
void scatter(const Spline& spline, const Particles<Dim>& particles, const CellOrder& cells,
             Accumulate&& accumulate, SlabGrid& grid) {
  const GridShape& shape = grid.shape();
  const double inverse_cell = 1.0 / shape.cell;
  const std::size_t block = static_cast<std::size_t>(Spline::width) * shape.row_size;
  std::vector<Lanes> buffer(block, Lanes{});
  grid.clear();
  for_each_run(
      particles, cells, grid, awake_rows(cells, grid),
      [&](int row, int lateral, const std::uint32_t* first, const std::uint32_t* last) {
        const auto base = cell_index<Dim>(shape, row, lateral);
        alignas(64) Lanes sums[stencil_nodes<Dim, Spline>] = {};
        for (; first != last; ++first) {
          const auto stencil = stencil_at<Dim>(spline, particles, *first, base, inverse_cell);
          accumulate(*first, stencil, sums);
        }
        Lanes* target = buffer.data() + lateral;
        for (int n = 0; n < stencil_nodes<Dim, Spline>; ++n) {
          target[node_offset<Dim, Spline>(shape, n)] += sums[n];
        }
      },
      [&](int row) {
        grid.add_row(row, buffer.data());
        std::fill(buffer.begin(), buffer.end(), Lanes{});
      });
}

/// Gathers from nodes: visit(p, weights, nodes) sees the stencil nodes of each particle and what
/// prepare(p, base, weights) made, base being the lowest node. Nodes must be complete, periodic
/// images filled. Not collective.
template <int Dim, class Spline, class Weights, class Prepare, class Visit>
void gather_with(Prepare&& prepare, const Particles<Dim>& particles, const CellOrder& cells,
                 const SlabGrid& grid, RowRange rows, Visit&& visit) {
  const GridShape& shape = grid.shape();
  for_each_run(
      particles, cells, grid, rows,
      [&](int row, int lateral, const std::uint32_t* first, const std::uint32_t* last) {
        const auto base = cell_index<Dim>(shape, row, lateral);
        const int field = field_of(particles, cells, *first, grid);
        alignas(64) Lanes nodes[stencil_nodes<Dim, Spline>];
        for (int n = 0; n < stencil_nodes<Dim, Spline>; n += Spline::width) {
          const int line = n / Spline::width, k = Dim == 2 ? line : line / Spline::width;
          const int across = Dim == 2 ? 0 : line % Spline::width * shape.nodes[0];
          const Lanes* source = grid.line(field, row + k, lateral + across);
          for (int i = 0; i < Spline::width; ++i) nodes[n + i] = source[i];
        }
        for_each_batch<Dim, Weights>(first, last, base, prepare,
                                     [&](const Batch<Dim>& batch, const Weights* w) {
                                       for (std::ptrdiff_t n = 0; n < batch.count; ++n)
                                         visit(batch.first[n], w[n], nodes);
                                     });
      },
      [](int) {});
}

/// Gathers from nodes with the stencil of each particle: visit(p, stencil, nodes).
template <int Dim, class Spline, class Visit>
void gather(const Spline& spline, const Particles<Dim>& particles, const CellOrder& cells,
            const SlabGrid& grid, Visit&& visit) {
  const double inverse_cell = 1.0 / grid.shape().cell;
  using Weights = Stencil<Dim, Spline>;
  gather_with<Dim, Spline, Weights>(
      [&](std::uint32_t p, const std::array<int, Dim>& base, Weights& stencil) {
        stencil = stencil_at<Dim>(spline, particles, p, base, inverse_cell);
      },
      particles, cells, grid, awake_rows(cells, grid), visit);
}

}  // namespace poreshock
