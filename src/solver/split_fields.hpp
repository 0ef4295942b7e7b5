#pragma once
// Private to solver: the particles of a step divided into velocity fields.

#include "poreshock/solver/simulation.hpp"

namespace poreshock {

/// Fields for so many parts: the first takes the grids of the run. Grids once made stay for later
/// steps.
template <int Dim>
void make_fields(int parts, Simulation<Dim>& sim) {
  GrainFields& all = sim.grain_fields;
  all.fields.clear();
  if (parts == 1) return;
  std::size_t used = 0;
  const auto new_grid = [&] {
    if (used == all.grids.size()) {
      all.grids.push_back(
          std::make_unique<SlabGrid>(sim.grid->shape(), sim.grid->starts(), sim.communicator));
    }
    return all.grids[used++].get();
  };
  for (int c = 0; c < parts; ++c) {
    VelocityField& field = all.fields.emplace_back();
    field.grid = c == 0 ? sim.grid.get() : new_grid();
    field.surfaces = new_grid();
  }
}

/// Gives every particle of all cells to the field number part(p), in the same order.
template <class Part>
void split(const CellOrder& cells, Part&& part, GrainFields& all) {
  for (VelocityField& field : all.fields) {
    field.cells.order.clear();
    field.cells.awake = cells.awake;
    field.cells.start.resize(cells.start.size());
  }
  for (std::size_t c = 0; c + 1 < cells.start.size(); ++c) {
    for (VelocityField& field : all.fields) {
      field.cells.start[c] = static_cast<std::uint32_t>(field.cells.order.size());
    }
    for (std::uint32_t k = cells.start[c]; k < cells.start[c + 1]; ++k) {
      const std::uint32_t p = cells.order[k];
      all.fields[static_cast<std::size_t>(part(p))].cells.order.push_back(p);
    }
  }
  for (VelocityField& field : all.fields) {
    field.cells.start.back() = static_cast<std::uint32_t>(field.cells.order.size());
  }
}

/// One grid of every field.
inline std::vector<SlabGrid*> grids_of(const GrainFields& all, SlabGrid* VelocityField::*which) {
  std::vector<SlabGrid*> grids;
  for (const VelocityField& field : all.fields) grids.push_back(field.*which);
  return grids;
}

/// Divides the particles by the quarter they face, and every node into its sides. Collective.
template <int Dim>
void split_by_facing(Simulation<Dim>& sim);

}  // namespace poreshock
