#include "maps.hpp"

#include <algorithm>
#include <cmath>

#include "poreshock/core/parallel.hpp"
#include "poreshock/material/derived.hpp"
#include "poreshock/morphology/lattice_map.hpp"
#include "poreshock/run/measure.hpp"

namespace poreshock {

namespace {

bool on_sites(const Scene& scene) {
  return scene.morphology.lattice == MapLattice::lagrangian;
}

/// The map of derived columns in space. What was cut or held is counted as a guard.
template <int Dim>
PixelField<Dim> map_in_space(const std::vector<std::vector<double>>& columns, Simulation<Dim>& sim,
                             const PixelGrid<Dim>& pixels) {
  const Scene& scene = sim.scene;
  const Particles<Dim>& particles = sim.particles;
  PixelSources<Dim> sources;
  for (int a = 0; a < Dim; ++a) sources.position[a] = particles.position[a];
  sources.mass = particles.mass;
  sources.density = particles.density;
  PixelScales scales = {0.0, 2.0 * scene.domain.cell,
                        std::round(sim.window.first * scene.domain.cell / scene.morphology.pixel)};
  for (const Material& m : sim.materials) {
    scales.density = std::max(scales.density, m.eos.density);
  }
  PixelField<Dim> map = deposit<Dim>(sources, {columns.begin(), columns.end()}, scales, pixels);
  // The counts are those of all ranks.
  if (rank(sim.communicator) == 0) {
    sim.ledger.guards.pixel += map.capped + map.clamped + map.skipped;
  }
  return map;
}

}  // namespace

template <int Dim>
Vector<Dim> map_shift(const Simulation<Dim>& sim) {
  return on_sites(sim.scene) ? Vector<Dim>(Vector<Dim>::Zero()) : low_corner(sim);
}

template <int Dim>
PixelLayout<Dim> map_layout(const Scene& scene, int rows) {
  PixelLayout<Dim> layout;
  layout.pixel_size = scene.morphology.pixel;
  for (int a = 0; a < Dim; ++a) {
    const double length = a + 1 < Dim ? scene.domain.size[a] : rows * scene.domain.cell;
    layout.pixels[a] = static_cast<int>(std::lround(length / layout.pixel_size));
    if (a + 1 < Dim) layout.periodic[a] = scene.domain.periodic[a];
  }
  return layout;
}

template <int Dim>
PixelField<Dim> make_map(const PixelGrid<Dim>& pixels, Simulation<Dim>& sim) {
  const Scene& scene = sim.scene;
  const Particles<Dim>& particles = sim.particles;
  std::vector<std::vector<double>> columns(scene.morphology.fields.size());
  for (std::size_t f = 0; f < columns.size(); ++f) {
    sim.ledger.guards.temperature += derive_field<Dim>(scene.morphology.fields[f].name, particles,
                                                       sim.materials, scene.thermal, columns[f]);
  }
  return on_sites(scene)
             ? place_on_lattice<Dim>(particles.id, {columns.begin(), columns.end()}, pixels)
             : map_in_space<Dim>(columns, sim, pixels);
}

template <int Dim>
std::vector<MorphologyRecord> measure_fields(const PixelField<Dim>& map,
                                             const Simulation<Dim>& sim) {
  const Morphology& morphology = sim.scene.morphology;
  const Vector<Dim> shift = map_shift(sim);
  std::vector<MorphologyRecord> records;
  for (std::size_t f = 0; f < morphology.fields.size(); ++f) {
    const MorphologyField& field = morphology.fields[f];
    records.push_back(measure<Dim>(map, f, field, std::string(derived_unit(field.name)), morphology,
                                   shift, sim.communicator));
    if (follows_front(sim.scene)) records.back().low = shift[Dim - 1];
  }
  return records;
}

template <int Dim>
std::vector<SnapshotMap> snapshot_maps(const PixelField<Dim>& map, const PixelGrid<Dim>& pixels,
                                       const Simulation<Dim>& sim) {
  SnapshotMap common;
  for (int axis = Dim - 1; axis >= 0; --axis) {
    common.shape.push_back(static_cast<std::uint64_t>(map.layout.pixels[axis]));
  }
  common.first_row = static_cast<std::uint64_t>(pixels.first_row());
  common.pixel = map.layout.pixel_size;
  const Vector<Dim> shift = map_shift(sim);
  for (int axis = 0; axis < Dim; ++axis) common.low[axis] = shift[axis];
  std::vector<SnapshotMap> maps;
  for (std::size_t f = 0; f < map.values.size(); ++f) {
    SnapshotMap& one = maps.emplace_back(common);
    one.name = sim.scene.morphology.fields[f].name;
    one.unit = derived_unit(one.name);
    // Without the row of the neighbour above.
    one.values = std::span(map.values[f]).first(map.rows * pixels.row_size());
  }
  return maps;
}

template Vector<2> map_shift<2>(const Simulation<2>&);
template Vector<3> map_shift<3>(const Simulation<3>&);
template PixelLayout<2> map_layout<2>(const Scene&, int);
template PixelLayout<3> map_layout<3>(const Scene&, int);
template PixelField<2> make_map<2>(const PixelGrid<2>&, Simulation<2>&);
template PixelField<3> make_map<3>(const PixelGrid<3>&, Simulation<3>&);
template std::vector<MorphologyRecord> measure_fields<2>(const PixelField<2>&,
                                                         const Simulation<2>&);
template std::vector<MorphologyRecord> measure_fields<3>(const PixelField<3>&,
                                                         const Simulation<3>&);
template std::vector<SnapshotMap> snapshot_maps<2>(const PixelField<2>&, const PixelGrid<2>&,
                                                   const Simulation<2>&);
template std::vector<SnapshotMap> snapshot_maps<3>(const PixelField<3>&, const PixelGrid<3>&,
                                                   const Simulation<3>&);

}  // namespace poreshock
