#include "poreshock/transfer/node_points.hpp"

#include <algorithm>

#include "poreshock/core/parallel.hpp"
#include "poreshock/transfer/sweep.hpp"

namespace poreshock {

namespace {

/// Calls visit(number of the node, its indices) for every chosen node that a point reaches;
/// `numbers`: of all nodes of the slab, row after row, -1 for those that are not chosen.
template <int Dim, class Visit>
void for_each_node(const CellPoint<Dim>& point, const std::vector<std::int32_t>& numbers,
                   const SlabGrid& grid, Visit&& visit) {
  const GridShape& shape = grid.shape();
  const std::array<int, Dim> base = cell_index<Dim>(shape, point.row, point.lateral);
  const int w = shape.stencil, planes = Dim == 3 ? w : 1;
  for (int k = 0; k < w; ++k) {
    const int row = point.row + k;
    if (row < grid.first_row() || row >= grid.node_end()) continue;
    const std::size_t at = static_cast<std::size_t>(row - grid.first_row()) * shape.row_size;
    for (int j = 0; j < planes; ++j) {
      for (int l = 0; l < w; ++l) {
        const std::int32_t number =
            numbers[at + original_node(shape, point.lateral + j * shape.nodes[0] + l)];
        if (number < 0) continue;
        std::array<int, Dim> index;
        index[0] = base[0] + l;
        if constexpr (Dim == 3) index[1] = base[1] + j;
        index[Dim - 1] = row;
        visit(static_cast<std::size_t>(number), index);
      }
    }
  }
}

}  // namespace

int original_node(const GridShape& shape, int i) {
  const auto original = [](int k, int nodes, bool periodic) {
    if (!periodic) return k;
    if (k == 0) return nodes - 3;
    return k >= nodes - 2 ? k - (nodes - 3) : k;
  };
  const int x = original(i % shape.nodes[0], shape.nodes[0], shape.periodic[0]);
  if (shape.dimension == 2) return x;
  return original(i / shape.nodes[0], shape.nodes[1], shape.periodic[1]) * shape.nodes[0] + x;
}

ChosenCells cells_at(const std::vector<NodePlace>& nodes, const SlabGrid& grid) {
  const GridShape& shape = grid.shape();
  const std::ptrdiff_t width = shape.row_size, rows = grid.last_row() - grid.first_row();
  const int w = shape.stencil, planes = shape.dimension == 3 ? w : 1;
  std::vector<int> original;
  for (int i = 0; i < width; ++i) original.push_back(original_node(shape, i));
  ChosenCells cells(static_cast<std::size_t>(rows * width), 0);
  // One row of nodes, and its cells; behind its end come those that a stencil there would reach.
  ChosenCells line(static_cast<std::size_t>(width + planes * shape.nodes[0] + w), 0);
  ChosenCells across(static_cast<std::size_t>(width + planes * shape.nodes[0]), 0);
  ChosenCells marks(static_cast<std::size_t>(width), 0);
  for (std::size_t first = 0, last = 0; first < nodes.size(); first = last) {
    const int row = nodes[first].row;
    std::ranges::fill(marks, 0);
    for (; last < nodes.size() && nodes[last].row == row; ++last) {
      marks[static_cast<std::size_t>(nodes[last].lateral)] = 1;
    }
    for (std::ptrdiff_t i = 0; i < width; ++i) line[i] = marks[original[i]];
    for (std::ptrdiff_t i = 0; i < std::ssize(across); ++i) {
      across[i] = line[i];
      for (int l = 1; l < w; ++l) across[i] |= line[i + l];
    }
    for (int k = 0; k < w; ++k) {
      const std::ptrdiff_t cell_row = row - k - grid.first_row();
      if (cell_row < 0 || cell_row >= rows) continue;
      for (int j = 0; j < planes; ++j) {
        const std::uint8_t* const from = across.data() + std::ptrdiff_t{j} * shape.nodes[0];
        std::uint8_t* const to = cells.data() + cell_row * width;
        for (std::ptrdiff_t i = 0; i < width; ++i) to[i] |= from[i];
      }
    }
  }
  return cells;
}

template <int Dim>
std::vector<CellPoint<Dim>> collect_points(const Particles<Dim>& particles, const CellOrder& cells,
                                           const ChosenCells& chosen, const SlabGrid& grid) {
  std::vector<CellPoint<Dim>> points;
  const double inverse_cell = 1.0 / grid.shape().cell;
  for_each_run(
      particles, cells, grid, awake_rows(cells, grid),
      [&](int row, int lateral, const std::uint32_t* first, const std::uint32_t* last) {
        if (!is_chosen(chosen, row, lateral, grid)) return;
        const int field = field_of(particles, cells, *first, grid);
        for (; first != last; ++first) {
          const std::uint32_t p = *first;
          CellPoint<Dim> point;
          point.row = row, point.lateral = lateral;
          point.field = field;
          point.volume = particles.mass[p] / particles.density[p];
          for (int a = 0; a < Dim; ++a) {
            point.volume *= inverse_cell;
            point.place[a] = particles.position[a][p] * inverse_cell;
          }
          points.push_back(point);
        }
      },
      [](int) {});
  return points;
}

template <int Dim>
void exchange_points(const SlabGrid& grid, std::vector<CellPoint<Dim>>& points) {
  const MPI_Comm communicator = grid.communicator();
  if (size(communicator) == 1) return;
  const int depth = grid.shape().stencil - 1;
  constexpr int tag = 40;
  std::vector<CellPoint<Dim>> lowest, highest;
  for (const CellPoint<Dim>& point : points) {
    if (point.row < grid.first_row() + depth) lowest.push_back(point);
    if (point.row >= grid.last_row() - depth) highest.push_back(point);
  }
  const auto from = swap_with_neighbours(lowest, highest, 1, tag, communicator);
  points.insert(points.begin(), from.below.begin(), from.below.end());
  points.insert(points.end(), from.above.begin(), from.above.end());
}

template <int Dim>
NodePoints<Dim> points_at_nodes(const std::vector<CellPoint<Dim>>& points,
                                const std::vector<NodePlace>& nodes, const SlabGrid& grid) {
  const std::size_t width = static_cast<std::size_t>(grid.shape().row_size);
  std::vector<std::int32_t> numbers((grid.node_end() - grid.first_row()) * width, -1);
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    numbers[(nodes[n].row - grid.first_row()) * width + nodes[n].lateral] =
        static_cast<std::int32_t>(n);
  }
  NodePoints<Dim> result;
  result.start.assign(nodes.size() + 1, 0);
  for (const CellPoint<Dim>& point : points) {
    for_each_node<Dim>(point, numbers, grid,
                       [&](std::size_t node, const auto&) { ++result.start[node + 1]; });
  }
  for (std::size_t n = 1; n < result.start.size(); ++n) result.start[n] += result.start[n - 1];
  std::vector<std::uint32_t> next(result.start.begin(), result.start.end() - 1);
  result.points.resize(result.start.back());
  for (const CellPoint<Dim>& point : points) {
    for_each_node<Dim>(point, numbers, grid,
                       [&](std::size_t node, const std::array<int, Dim>& index) {
                         NodePoint<Dim>& seen = result.points[next[node]++];
                         seen.volume = point.volume;
                         seen.field = point.field;
                         // Node i lies at (i - 1) cells.
                         for (int a = 0; a < Dim; ++a) {
                           seen.offset[a] = point.place[a] - (index[a] - 1);
                         }
                       });
  }
  return result;
}

template std::vector<CellPoint<2>> collect_points<2>(const Particles<2>&, const CellOrder&,
                                                     const ChosenCells&, const SlabGrid&);
template std::vector<CellPoint<3>> collect_points<3>(const Particles<3>&, const CellOrder&,
                                                     const ChosenCells&, const SlabGrid&);
template void exchange_points<2>(const SlabGrid&, std::vector<CellPoint<2>>&);
template void exchange_points<3>(const SlabGrid&, std::vector<CellPoint<3>>&);
template NodePoints<2> points_at_nodes<2>(const std::vector<CellPoint<2>>&,
                                          const std::vector<NodePlace>&, const SlabGrid&);
template NodePoints<3> points_at_nodes<3>(const std::vector<CellPoint<3>>&,
                                          const std::vector<NodePlace>&, const SlabGrid&);

}  // namespace poreshock
