#pragma once
// Velocity fields of grains: one for each colour, so that grains that meet can slide and part. With
// self-contact of a single grain: one for each quarter of the plane that its particles face.
// Also in facing_fields.cpp.

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

/// What contact needs besides the velocity fields of the grid. Not part of the state: nodal sums of
/// a grain do not depend on its colour.
struct GrainFields {
  std::int32_t grains = 0;             ///< largest number of a grain + 1; 0 where all are one grain
  std::vector<std::int8_t> colours;    ///< per grain
  std::unique_ptr<SlabGrid> surfaces;  ///< the nodes of the grid, once there are several fields
  std::optional<FaceTable> faces;
  std::vector<NodePlace> shared;  ///< nodes where two grains met in this step
  std::vector<NodeSides> sides;   ///< of every node, only with self-contact
  ContactSummary summary;         ///< of the last step, this rank; nothing before it
};

template <int Dim>
struct Simulation;

/// Counts the grains of all ranks; with one the fields stay unused. Throws InputError for
/// self-contact of several. Collective.
template <int Dim>
void find_grains(Simulation<Dim>& sim);

/// After the sort: colours the grains by their cells, and gives the grid the nodes of each colour
/// where its particles are awake. Throws StateError, before the first step InputError, when a place
/// needs too many colours. Nothing with a single grain. Collective (four gathers of what is small).
template <int Dim>
void split_by_colour(Simulation<Dim>& sim);

/// Between the momentum update and the boundaries: surfaces of the grains at shared nodes, and
/// their collisions. Nothing with a single colour. Collective (one exchange).
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

/// With self-contact: divides every node into its sides by the quarters that the particles face.
/// Collective.
template <int Dim>
void split_by_facing(Simulation<Dim>& sim);

/// Contact of the last step over all ranks, for the history. Collective.
template <int Dim>
ContactRow contact_row(const Simulation<Dim>& sim);

/// Gives the nodes back, before the slabs change.
void release_fields(GrainFields& fields);

/// Moves the nodes of all velocity fields: momentum(), collisions with an exchange of surfaces,
/// boundaries(). With self-contact the fields that move are the two sides of each node. Collective.
template <int Dim, class Momentum, class Boundaries>
void move_nodes(double dt, Momentum&& momentum, Boundaries&& boundaries, Simulation<Dim>& sim) {
  const std::vector<NodeSides>& sides = sim.grain_fields.sides;
  timed(sim.phases, PhaseName::grid_update, [&] {
    if (!sides.empty()) join_sides(sides, *sim.grid);
    momentum();
  });
  timed(sim.phases, PhaseName::contact, [&] { collide(dt, sim); });
  timed(sim.phases, PhaseName::grid_update, [&] {
    boundaries();
    finish_contact(sim);
    if (!sides.empty()) spread_sides(sides, *sim.grid);
  });
}

}  // namespace poreshock
