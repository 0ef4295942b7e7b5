#pragma once
// Velocity fields of grains: one for each colour, so that grains that meet can slide and part. With
// self-contact of a single grain: one for each quarter of the plane that its particles face.

#include <memory>
#include <optional>
#include <vector>

#include "poreshock/grid/grain_colours.hpp"
#include "poreshock/output/history.hpp"
#include "poreshock/particles/cell_order.hpp"
#include "poreshock/physics/grain_contact.hpp"
#include "poreshock/physics/self_contact.hpp"

namespace poreshock {

/// The grains of one colour: their particles, and grids that belong to somebody else.
struct VelocityField {
  CellOrder cells;
  SlabGrid* grid = nullptr;
  SlabGrid* surfaces = nullptr;  ///< scratch of the contact step
};

/// All fields of a run. Not part of its state: nodal sums of a grain do not depend on its colour.
struct GrainFields {
  std::int32_t grains = 0;            ///< largest number of a grain + 1; 0 where all are one grain
  std::vector<std::int8_t> colours;   ///< per grain
  std::vector<VelocityField> fields;  ///< empty with a single colour
  std::vector<std::unique_ptr<SlabGrid>> grids;  ///< those of the colours after the first
  std::optional<FaceTable> faces;
  std::vector<bool> shared;      ///< nodes where two grains met in this step
  std::vector<NodeSides> sides;  ///< of every node, only with self-contact
  ContactSummary summary;        ///< of the last step, this rank; nothing before it
};

template <int Dim>
struct Simulation;

/// Counts the grains of all ranks; with one the fields stay unused. Throws InputError for
/// self-contact of several. Collective.
template <int Dim>
void find_grains(Simulation<Dim>& sim);

/// After the sort: colours the grains by their cells and splits the particles by colour. Throws
/// StateError, before the first step InputError, when a place needs too many colours. Nothing with
/// a single grain. Collective (four gathers of what is small).
template <int Dim>
void split_by_colour(Simulation<Dim>& sim);

/// Between the momentum update and the boundaries: surfaces of the grains at shared nodes, and
/// their collisions. Nothing with a single colour. Collective (one exchange per field).
template <int Dim>
void collide(double dt, Simulation<Dim>& sim);

/// After the boundaries: settles the heat of contact. Nothing with a single colour. Not collective.
template <int Dim>
void finish_contact(Simulation<Dim>& sim);

/// True when the sample has several grains, whether or not they meet, or self-contact.
template <int Dim>
bool has_contact(const Simulation<Dim>& sim) {
  return sim.grain_fields.grains > 0 || sim.scene.contact.self;
}

/// Velocity field of every particle in the last step, before the first one at its start; empty in
/// scenes without contact.
template <int Dim>
std::vector<std::int32_t> particle_colours(const Simulation<Dim>& sim);

/// At the start of a run with self-contact: which way each particle faces. Before: particles
/// sorted. Collective.
template <int Dim>
void mark_surfaces(Simulation<Dim>& sim);

/// With self-contact: puts the nodal sums of all fields on the two of for_each_side, and back.
template <int Dim>
void join_fields(Simulation<Dim>& sim);
template <int Dim>
void spread_fields(Simulation<Dim>& sim);

/// Contact of the last step over all ranks, for the history. Collective.
template <int Dim>
ContactRow contact_row(const Simulation<Dim>& sim);

/// Gives the grids of all fields back, before the slabs change.
void release_fields(GrainFields& fields);

/// Calls visit(cells, grid) for every velocity field.
template <int Dim, class Visit>
void for_each_field(Simulation<Dim>& sim, Visit&& visit) {
  if (sim.grain_fields.fields.empty()) return visit(sim.cells, *sim.grid);
  for (VelocityField& field : sim.grain_fields.fields) {
    visit(field.cells, *field.grid);
  }
}

/// Calls visit(cells, grid) for every velocity field that moves by itself: all of them,
/// or the two sides of self-contact.
template <int Dim, class Visit>
void for_each_side(Simulation<Dim>& sim, Visit&& visit) {
  if (!sim.scene.contact.self) return for_each_field(sim, visit);
  for (int side = 0; side < 2; ++side) {
    const VelocityField& field = sim.grain_fields.fields[static_cast<std::size_t>(side)];
    visit(field.cells, *field.grid);
  }
}

}  // namespace poreshock
