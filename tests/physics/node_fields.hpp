#pragma once
// Fields on the nodes of a small grid, the same on any number of ranks.

#include <gtest/gtest.h>

#include <memory>

#include "poreshock/core/parallel.hpp"
#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/physics/node_ledger.hpp"
#include "poreshock/transfer/node_lanes.hpp"
#include "support/random_numbers.hpp"

namespace poreshock::test {

template <int Dim>
using NodeIndex = std::array<int, Dim>;

/// A grid of so many cells for cubic splines.
template <int Dim>
GridShape shape_of(const std::array<int, Dim>& cells) {
  GridShape shape;
  shape.dimension = Dim;
  shape.stencil = 4;
  shape.cell = 1.0e-5;
  shape.row_size = 1;
  for (int a = 0; a < Dim; ++a) {
    shape.nodes[a] = cells[a] + 3;
    if (a + 1 < Dim) shape.row_size *= shape.nodes[a];
  }
  shape.rows = shape.nodes[Dim - 1];
  return shape;
}

/// The grid cut into equal slabs over all ranks of the communicator.
inline std::unique_ptr<SlabGrid> make_grid(const GridShape& shape, MPI_Comm communicator) {
  const std::vector<double> weights(static_cast<std::size_t>(shape.rows), 1.0);
  return std::make_unique<SlabGrid>(
      shape, partition_rows(weights, size(communicator), slab_limits(shape)), communicator);
}

/// A node of a row; `index` counts along every axis. (Not auto&: that drops the alignment of
/// Lanes.)
template <int Dim>
Lanes& node_at(SlabGrid& grid, const NodeIndex<Dim>& index) {
  int lateral = index[0];
  if constexpr (Dim == 3) lateral += index[1] * grid.shape().nodes[0];
  return grid.row(index[Dim - 1])[lateral];
}

/// Calls visit(index, node) for all complete nodes of this rank.
template <int Dim, class Visitor>
void for_each_node(SlabGrid& grid, Visitor&& visit) {
  const int nx = grid.shape().nodes[0];
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    for (int i = 0; i < grid.shape().row_size; ++i) {
      NodeIndex<Dim> index;
      index[0] = i % nx;
      if constexpr (Dim == 3) index[1] = i / nx;
      index[Dim - 1] = row;
      visit(index, grid.row(row)[i]);
    }
  }
}

/// Random numbers that belong to a node, whoever holds it.
template <int Dim>
reference::Random random_at(const NodeIndex<Dim>& index, std::uint64_t seed) {
  std::uint64_t key = seed;
  for (const int i : index) key = key * 1009 + static_cast<std::uint64_t>(i);
  return {key * 0x2545f4914f6cdd1dULL};
}

/// A ledger that resolves the sums of these tests (masses of some 1e-6 kg, 1e3 m/s) to 1e-16.
inline NodeLedger fine_ledger() {
  NodeLedger ledger;
  ledger.inverse_energy_quantum = 0x1p53;
  ledger.inverse_momentum_quantum = 0x1p60;
  return ledger;
}

inline double energy(Int128 quanta, const NodeLedger& ledger) {
  return static_cast<double>(quanta) / ledger.inverse_energy_quantum;
}

inline double momentum(Int128 quanta, const NodeLedger& ledger) {
  return static_cast<double>(quanta) / ledger.inverse_momentum_quantum;
}

/// All sums of a ledger over the ranks of the communicator. Collective.
inline std::vector<Int128> totals(const NodeLedger& ledger, MPI_Comm communicator) {
  std::vector<Int128> values = {ledger.wall_heat, ledger.wall_work, ledger.body_work};
  values.insert(values.end(), ledger.body_impulse.begin(), ledger.body_impulse.end());
  values.insert(values.end(), ledger.wall_impulse.begin(), ledger.wall_impulse.end());
  sum(values, communicator);
  return values;
}

/// Both hold the same bits, and so do the sums of their ledgers. Collective.
template <int Dim>
void expect_same_nodes(SlabGrid& slabs, SlabGrid& whole) {
  for_each_node<Dim>(slabs, [&](const NodeIndex<Dim>& index, const Lanes& found) {
    const Lanes expected = node_at<Dim>(whole, index);
    for (int k = 0; k < lane_count; ++k) EXPECT_EQ(found[k], expected[k]) << "lane " << k;
  });
}

}  // namespace poreshock::test
