#pragma once
// The maps that a run measures and keeps in its snapshots.

#include <vector>

#include "poreshock/morphology/pixel_map.hpp"
#include "poreshock/output/morphology_file.hpp"
#include "poreshock/output/snapshot.hpp"
#include "poreshock/solver/simulation.hpp"

namespace poreshock {

/// What is added to places on the map, m. Not collective.
template <int Dim>
Vector<Dim> map_shift(const Simulation<Dim>& sim);

/// Pixels of the scene's morphology on so many rows of cells.
template <int Dim>
PixelLayout<Dim> map_layout(const Scene& scene, int rows);

/// The map of the fields of the scene's morphology; what was cut, held or floored for it is counted
/// as a guard. Collective.
template <int Dim>
PixelField<Dim> make_map(const PixelGrid<Dim>& pixels, Simulation<Dim>& sim);

/// What the scene's morphology measures on a map. Collective.
template <int Dim>
std::vector<MorphologyRecord> measure_fields(const PixelField<Dim>& map,
                                             const Simulation<Dim>& sim);

/// The fields of a map as a snapshot takes them; valid as long as `map` lives. Not collective.
template <int Dim>
std::vector<SnapshotMap> snapshot_maps(const PixelField<Dim>& map, const PixelGrid<Dim>& pixels,
                                       const Simulation<Dim>& sim);

}  // namespace poreshock
