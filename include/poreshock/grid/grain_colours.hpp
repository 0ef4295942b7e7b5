#pragma once
// Colours of grains: grains of one colour share a velocity field, so two that can share a node must
// not have the same one.

#include <mpi.h>

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "poreshock/grid/slab_grid.hpp"

namespace poreshock {

/// Most colours, and with it the most grains that may share a node.
inline constexpr int most_colours = 12;

/// A stencil cell that holds particles of a grain.
struct GrainCell {
  std::int32_t row = 0;
  std::int32_t lateral = 0;
  std::int32_t grain = 0;
  // NOLINTNEXTLINE(modernize-use-nullptr): version 14 takes the comparison for a null pointer.
  auto operator<=>(const GrainCell&) const = default;
};

/// Neighbouring stencil cells along x that hold particles of a grain.
struct CellRun {
  std::int32_t row, y, first, last, grain;
};

/// Runs of the cells of this rank, line after line, and of those of other ranks within `reach` rows
/// of its slab. `cells`: those of this rank, ascending. Each rank sends what lies within `reach`
/// rows of its slab's ends to all. Collective.
std::vector<CellRun> cell_runs(std::span<const GrainCell> cells, int reach, const SlabGrid& grid);

/// Two grains, the smaller number first.
using GrainPair = std::pair<std::int32_t, std::int32_t>;

/// Pairs of different grains with stencil cells at most `reach` apart along every axis, periodic
/// sides respected; ascending, each once, the same on every rank. `runs`: all of cell_runs with the
/// same reach. Work grows with the lines of cells that cross a grain times reach^(Dim-1).
/// Collective.
std::vector<GrainPair> near_grains(std::vector<CellRun> runs, int reach, const SlabGrid& grid);

/// A colour for each grain 0 ... grains - 1, 0 for those without a neighbour: smallest degree last,
/// then each takes the lowest colour that no neighbour has. A planar map of grains needs at most
/// six. Throws StateError that names two grains when more than most_colours are needed. Not
/// collective; the same result on every rank.
std::vector<std::int8_t> colour_grains(std::int32_t grains, const std::vector<GrainPair>& pairs);

}  // namespace poreshock
