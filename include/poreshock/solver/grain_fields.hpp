#pragma once
// Velocity fields of grains: one for each colour, so that grains that meet can slide and part.

#include <memory>
#include <optional>
#include <vector>

#include "poreshock/grid/grain_colours.hpp"
#include "poreshock/output/history.hpp"
#include "poreshock/particles/cell_order.hpp"
#include "poreshock/physics/grain_contact.hpp"

namespace poreshock {

/// The grains of one colour: their particles, and grids that belong to somebody else.
struct VelocityField {
  CellOrder cells;
  SlabGrid* grid = nullptr;
  SlabGrid* averages = nullptr;  ///< only with averaged dilatation
  SlabGrid* surfaces = nullptr;  ///< scratch of the contact step, the averages where there are some
};

/// All fields of a run. Not part of its state: nodal sums of a grain do not depend on its colour.
struct GrainFields {
  std::int32_t grains = 0;            ///< largest number of a grain + 1; 0 where all are one grain
  std::vector<std::int8_t> colours;   ///< per grain
  std::vector<VelocityField> fields;  ///< empty with a single colour
  std::vector<std::unique_ptr<SlabGrid>> grids;  ///< those of the colours after the first
  std::optional<FaceTable> faces;
  std::vector<bool> shared;  ///< nodes where two grains met in this step
  ContactSummary summary;    ///< of the last step, this rank; nothing before it
};

template <int Dim>
struct Simulation;

/// Counts the grains of all ranks; with one the fields stay unused. Throws InputError for schemes
/// that cannot have grains. Collective.
template <int Dim>
void find_grains(Simulation<Dim>& sim);

/// After the sort: colours the grains by their cells and splits the particles by colour. Throws
/// StateError when a place needs too many colours. Nothing with a single grain. Collective (four
/// gathers of what is small).
template <int Dim>
void split_by_colour(Simulation<Dim>& sim);

/// Between the momentum update and the boundaries: surfaces of the grains at shared nodes, and
/// their collisions. Nothing with a single colour. Collective (one exchange per field).
template <int Dim>
void collide(double dt, Simulation<Dim>& sim);

/// After the boundaries: settles the heat of contact. Nothing with a single colour. Not collective.
template <int Dim>
void finish_contact(Simulation<Dim>& sim);

/// True when the sample has several grains, whether or not they meet.
template <int Dim>
bool has_grains(const Simulation<Dim>& sim) {
  return sim.grain_fields.grains > 0;
}

/// Contact of the last step over all ranks, for the history. Collective.
template <int Dim>
ContactRow contact_row(const Simulation<Dim>& sim);

/// Gives the grids of all fields back, before the slabs change.
void release_fields(GrainFields& fields);

/// Calls visit(cells, grid, averages) for every velocity field.
template <int Dim, class Visit>
void for_each_field(Simulation<Dim>& sim, Visit&& visit) {
  if (sim.grain_fields.fields.empty()) return visit(sim.cells, *sim.grid, sim.averages.get());
  for (VelocityField& field : sim.grain_fields.fields) {
    visit(field.cells, *field.grid, field.averages);
  }
}

}  // namespace poreshock
