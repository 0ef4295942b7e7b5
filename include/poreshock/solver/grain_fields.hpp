#pragma once
// Velocity fields of grains: one for each colour, so that grains that meet can slide and part. With
// self-contact of a single grain: one for each quarter of the plane that its particles face.

#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "poreshock/core/phase.hpp"
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

/// A velocity field as the sweeps of a step see it: its particles and its nodes.
struct FieldView {
  const CellOrder* cells = nullptr;
  SlabGrid* grid = nullptr;
};

/// The velocity fields of a step: that of all particles, or one for each colour or quarter.
std::vector<FieldView> velocity_fields(const CellOrder& cells, SlabGrid& grid,
                                       const GrainFields& fields);

/// Nodes of the last split at which grains met in the last step, on this rank.
std::int64_t contact_nodes(const GrainFields& fields);

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

/// With self-contact: puts the nodal sums of all fields on the first two, and back.
void join_fields(const GrainFields& fields);
void spread_fields(const GrainFields& fields);

/// Contact of the last step over all ranks, for the history. Collective.
template <int Dim>
ContactRow contact_row(const Simulation<Dim>& sim);

/// Gives the grids of all fields back, before the slabs change.
void release_fields(GrainFields& fields);

/// Moves the nodes of all velocity fields: momentum(grid), collisions with an exchange of surfaces,
/// boundaries(grid). Fields that move by themselves are all, or the two sides of self-contact.
/// Collective.
template <int Dim, class Momentum, class Boundaries>
void move_nodes(double dt, std::span<const FieldView> fields, Momentum&& momentum,
                Boundaries&& boundaries, Simulation<Dim>& sim) {
  if (!sim.grain_fields.sides.empty()) fields = fields.first(2);
  timed(sim.phases, PhaseName::grid_update, [&] {
    join_fields(sim.grain_fields);
    for (const FieldView& field : fields) momentum(*field.grid);
  });
  timed(sim.phases, PhaseName::contact, [&] { collide(dt, sim); });
  timed(sim.phases, PhaseName::grid_update, [&] {
    for (const FieldView& field : fields) boundaries(*field.grid);
    finish_contact(sim);
    spread_fields(sim.grain_fields);
  });
}

}  // namespace poreshock
