#pragma once
// Every key of a scene, one function per table: the key, the member it fills, range, unit and
// prose. Defaults are those of the members. The reader and the writer both walk through these
// functions.

#include <string>
#include <vector>

#include "dataset_names.hpp"
#include "material_table.hpp"
#include "poreshock/scene/scene.hpp"
#include "probe_table.hpp"
#include "rules.hpp"
#include "sample_table.hpp"
#include "transfer_table.hpp"

namespace poreshock::scene_text {

template <typename Visitor>
void visit_domain(Visitor& visitor, Scene& scene) {
  Domain& domain = scene.domain;
  visitor.numbers("size", domain.size, scene.dimension, {2, 3},
                  {positive, "m", "width, height; in 3-D width, depth, height", Need::required});
  visitor.number("cell", domain.cell, {positive, "m", "edge of a background cell", Need::required});
  visitor.flags("periodic", domain.periodic, scene.dimension - 1,
                {"true where a lateral axis repeats itself; one value or one per axis"});
}

template <typename Visitor>
void visit_side(Visitor& visitor, Side& side) {
  choice(visitor, "kind", side.kind, names_of_sides(),
         {"a wall only pushes, a symmetry plane also holds"});
  visitor.number("velocity", side.velocity, {any_number, "m/s", "of a wall, upwards"});
  visitor.number("friction", side.friction, {not_negative, "", "of a wall, Coulomb"});
  visitor.text("behind", side.behind,
               {"name of a material that continues the sample beyond a free side: waves leave into "
                "it and do not come back"});
}

template <typename Visitor>
void visit_boundary(Visitor& visitor, Scene& scene) {
  Boundary& boundary = scene.boundary;
  visitor.table_or_text("low", "kind",
                        {"bottom of the domain, velocity in m/s along the shock axis"},
                        [&](auto& inner) { visit_side(inner, boundary.low); });
  visitor.table_or_text("high", "kind", {"top of the domain, likewise"},
                        [&](auto& inner) { visit_side(inner, boundary.high); });
  visitor.sides("lateral", boundary.lateral, scene.domain.periodic, scene.dimension - 1,
                {"both sides of a lateral axis that is not periodic"});
}

template <typename Visitor>
void visit_loading(Visitor& visitor, Scene& scene) {
  visitor.number("velocity", scene.loading.velocity,
                 {not_negative, "m/s", "impact velocity, of the material towards the low side"});
  visitor.vector("frame", scene.loading.frame, scene.dimension,
                 {any_number, "m/s", "added to everything, walls included"});
}

template <typename Visitor>
void visit_body_force(Visitor& visitor, Scene& scene) {
  visitor.vector("acceleration", scene.body_force, scene.dimension,
                 {any_number, "m/s^2", "of all material"});
}

template <typename Visitor>
void visit_viscosity(Visitor& visitor, Scene& scene) {
  Viscosity& viscosity = scene.viscosity;
  visitor.fallback(viscosity.limited, scene.transfer.shape == ShapeFunction::cubic);
  visitor.flag("limited", viscosity.limited,
               {"true where it acts only on jumps of the velocity that their neighbours do not "
                "share; cubic splines only"});
  visitor.fallback(viscosity.linear, viscosity.limited ? 1.0 : 0.6);
  visitor.number("linear", viscosity.linear,
                 {not_negative, "", "artificial viscosity, times the sound speed"});
  visitor.fallback(viscosity.quadratic, viscosity.limited ? 5.0 : 2.25);
  visitor.number("quadratic", viscosity.quadratic,
                 {not_negative, "", "artificial viscosity, times the velocity jump"});
}

template <typename Visitor>
void visit_conduction(Visitor& visitor, Conduction& conduction) {
  visitor.flag("on", conduction.on, {"true where heat flows, by material.conductivity"});
}

template <typename Visitor>
void visit_contact(Visitor& visitor, Contact& contact) {
  const Names<GapTest> tests{{"volume", GapTest::volume}, {"none", GapTest::none}};
  const Names<ContactNormal> normals{{"gradients", ContactNormal::gradients},
                                     {"regression", ContactNormal::regression}};
  visitor.number("friction", contact.friction,
                 {not_negative, "", "coefficient of Coulomb friction; 1e30 = stick"});
  choice(visitor, "gap", contact.gap, tests,
         {"contact where grains fill a node's space, or wherever they approach"});
  choice(visitor, "normal", contact.normal, normals,
         {"of two grains: from the gradients of their volumes, or of the plane that parts their "
          "particles"});
  visitor.flag("self", contact.self,
               {"true where opposite walls of voids in one grain meet as two grains do"});
}

template <typename Visitor>
void visit_time(Visitor& visitor, Scene& scene) {
  TimeControl& time = scene.time;
  visitor.number("end", time.end, {positive, "s", "of the run; impact is at 0", Need::required});
  visitor.fallback(time.cfl, scheme_of(scene.transfer.velocity).cfl);
  visitor.number("cfl", time.cfl,
                 {{.low = 0.0, .high = 1.5, .above_low = true},
                  "",
                  "share of a cell that a wave may cross in a step; up to 0.9 with pic and flip"});
  integer(visitor, "max_steps", time.max_steps, {not_negative, "", "0 = no limit"});
  visitor.flag("sleep", time.sleep, {"true where rows that no wave has reached only move"});
  const Names<Follow> follows{{"nothing", Follow::nothing}, {"front", Follow::front}};
  choice(visitor, "follow", time.follow, follows,
         {"front: the domain is a window that moves with the front through a sample that may be "
          "higher"});
}

template <typename Visitor>
void visit_output(Visitor& visitor, Scene& scene) {
  Output& output = scene.output;
  const Names<Precision> precisions{{"double", Precision::double_precision},
                                    {"single", Precision::single_precision}};
  visitor.number("beat", output.beat, {positive, "s", "steps land on its multiples"});
  visitor.number("snapshot", output.snapshot,
                 {not_negative, "s", "between snapshots, multiple of beat; 0 = first and last"});
  visitor.fallback(output.history, output.beat);
  visitor.number("history", output.history,
                 {positive, "s", "between rows of history.csv, multiple of beat"});
  const std::vector<std::string> datasets = datasets_of(scene);
  visitor.fallback(output.fields, datasets);
  visitor.names("fields", output.fields, datasets,
                {"particle datasets of a snapshot, by default all"});
  choice(visitor, "precision", output.precision, precisions, {"of the numbers in a snapshot"});
}

template <typename Visitor>
void visit_morphology(Visitor& visitor, Scene& scene) {
  Morphology& morphology = scene.morphology;
  visitor.number("every", morphology.every,
                 {not_negative, "s", "between records, multiple of output.beat; 0 = off"});
  const Names<MapLattice> lattices{{"eulerian", MapLattice::eulerian},
                                   {"lagrangian", MapLattice::lagrangian}};
  choice(visitor, "lattice", morphology.lattice, lattices,
         {"pixels in space, or the sites where the particles started"});
  const bool sites = morphology.lattice == MapLattice::lagrangian;
  visitor.fallback(morphology.pixel,
                   scene.domain.cell / (sites ? scene.sample.particles_per_cell : 1));
  visitor.number(
      "pixel", morphology.pixel,
      {positive, "m",
       "cell times 1/8 ... 16, by default the cell; lagrangian: cell/particles_per_cell"});
  const Names<MapVoids> voids{{"black", MapVoids::black},
                              {"white", MapVoids::white},
                              {"fill", MapVoids::fill},
                              {"exclude", MapVoids::exclude}};
  choice(
      visitor, "voids", morphology.voids, voids,
      {"in chi: cold, hot, like the nearest material, or left out: hot share of the pixels - edges "
       "+ vertices that touch none"});
  const Names<BoundaryLength> lengths{{"pixels", BoundaryLength::pixels},
                                      {"isoline", BoundaryLength::isoline}};
  choice(
      visitor, "length", morphology.length, lengths,
      {"of boundaries: from pixels; isoline adds the interpolated L_isoline (3-D: S_isosurface)"});
  std::vector<std::string> names;
  for (const MorphologyField& field : morphology.fields) names.push_back(field.name);
  visitor.names("fields", names, morphology_fields, {"fields to measure"});
  visitor.thresholds("thresholds", names, morphology.fields,
                     {"thresholds of each field in its unit (K, Pa, kg/m^3, m/s, Pa, 1)"});
  visitor.flag("domains", morphology.domains, {"count hot and cold domains at all thresholds"});
  visitor.hot_spots("hot_spots", morphology.fields,
                    {"thresholds at which every hot domain is listed"});
}

template <typename Visitor>
void visit_profile(Visitor& visitor, Scene& scene) {
  visitor.fallback(scene.profile.every, scene.output.snapshot);
  visitor.number("every", scene.profile.every,
                 {not_negative, "s",
                  "between records, multiple of output.beat; by default output.snapshot, 0 = off"});
}

template <typename Visitor>
void visit_checkpoint(Visitor& visitor, Checkpoint& checkpoint) {
  integer(visitor, "every_steps", checkpoint.every_steps,
          {not_negative, "", "steps between checkpoints; 0 = off"});
  visitor.number("every_time", checkpoint.every_time,
                 {not_negative, "s", "of simulated time, multiple of output.beat; 0 = off"});
  visitor.number("every_wall", checkpoint.every_wall, {not_negative, "s", "of wall time; 0 = off"});
  integer(visitor, "keep", checkpoint.keep, {{.low = 1.0}, "", "newest checkpoints kept"});
}

template <typename Visitor>
void visit_scene(Visitor& visitor, Scene& scene) {
  const Names<Thermal> thermals{{"paper", Thermal::paper}, {"conserving", Thermal::conserving}};
  visitor.text("title", scene.title, {"shown in reports"});
  choice(visitor, "thermal", scene.thermal, thermals,
         {"temperature after eqs 4-7 of the paper, or from the full energy balance"});
  visitor.table("domain", {"Block of background cells; the last axis is the shock axis."},
                [&](auto& inner) { visit_domain(inner, scene); });
  visitor.table("boundary", {"Sides of the domain."},
                [&](auto& inner) { visit_boundary(inner, scene); });
  visitor.tables("material", scene.materials, {"A material."},
                 [](auto& inner, MaterialParameters& item) { visit_material(inner, item); });
  visitor.table("sample", {"Generated block of material."},
                [&](auto& inner) { visit_sample(inner, scene); });
  visitor.tables("body", scene.bodies, {"A piece of material placed by hand."},
                 [&](auto& inner, Body& item) { visit_body(inner, item, scene); });
  visitor.tables("void", scene.voids, {"A hole placed by hand."},
                 [&](auto& inner, Region& item) { visit_region(inner, item, scene.dimension); });
  visitor.table("loading", {"Impact."}, [&](auto& inner) { visit_loading(inner, scene); });
  visitor.table("body_force", {"Body force."},
                [&](auto& inner) { visit_body_force(inner, scene); });
  visitor.table("transfer", {"Transfer between particles and grid."},
                [&](auto& inner) { visit_transfer(inner, scene); });
  visitor.table("viscosity", {"Artificial viscosity, its coefficients."},
                [&](auto& inner) { visit_viscosity(inner, scene); });
  visitor.table("conduction", {"Conduction of heat."},
                [&](auto& inner) { visit_conduction(inner, scene.conduction); });
  visitor.table("contact", {"Contact between grains."},
                [&](auto& inner) { visit_contact(inner, scene.contact); });
  visitor.table("time", {"Time."}, [&](auto& inner) { visit_time(inner, scene); });
  visitor.table("output", {"What is written and when."},
                [&](auto& inner) { visit_output(inner, scene); });
  visitor.table("morphology", {"Minkowski functionals while the run goes."},
                [&](auto& inner) { visit_morphology(inner, scene); });
  visitor.table("profile", {"Averages over rows of cells along the shock axis, and the front."},
                [&](auto& inner) { visit_profile(inner, scene); });
  visitor.tables("probe", scene.probes, {"A trace of velocity, pressure and temperature."},
                 [&](auto& inner, Probe& item) { visit_probe(inner, item, scene); });
  visitor.table("checkpoint", {"Checkpoints."},
                [&](auto& inner) { visit_checkpoint(inner, scene.checkpoint); });
}

}  // namespace poreshock::scene_text
