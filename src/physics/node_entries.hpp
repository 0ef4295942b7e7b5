#pragma once
// Private to physics: the fields that share a node.

#include <array>

#include "poreshock/physics/grain_contact.hpp"
#include "poreshock/physics/parting_plane.hpp"
#include "poreshock/transfer/node_lanes.hpp"

namespace poreshock {

/// A field at a node and where its results go.
template <int Dim>
struct Entry {
  NodeGrain<Dim> grain;
  Lanes* motion = nullptr;
  Lanes* surface = nullptr;
  std::int8_t field = 0;
};

template <int Dim>
using Entries = std::array<Entry<Dim>, most_grains_at_node>;

/// Order that does not know the numbers of the fields.
template <int Dim>
bool comes_before(const Entry<Dim>& a, const Entry<Dim>& b) {
  if (a.grain.mass != b.grain.mass) return a.grain.mass > b.grain.mass;
  for (int k = 0; k < Dim; ++k) {
    if (a.grain.end[k] != b.grain.end[k]) return a.grain.end[k] < b.grain.end[k];
  }
  for (int k = 0; k < Dim; ++k) {
    if (a.grain.place[k] != b.grain.place[k]) return a.grain.place[k] < b.grain.place[k];
  }
  return false;
}

template <int Dim>
NodeGrain<Dim> read_grain(const Lanes& motion, const Lanes& surface) {
  using Motion = MotionLane<Dim>;
  using Surface = SurfaceLane<Dim>;
  NodeGrain<Dim> grain;
  grain.mass = motion[Motion::mass];
  grain.volume = surface[Surface::volume];
  grain.strain = grain.volume > 0.0 ? surface[Surface::strain] / grain.volume : 0.0;
  for (int a = 0; a < Dim; ++a) {
    grain.start[a] = motion[Motion::start_velocity + a];
    grain.end[a] = motion[Motion::end_velocity + a];
    grain.gradient[a] = surface[Surface::gradient + a];
    grain.place[a] = grain.volume > 0.0 ? surface[Surface::place + a] / grain.volume : 0.0;
  }
  return grain;
}

/// Fields with mass at a node, in their order; returns how many.
template <int Dim>
int read_entries(const ContactGrids& grids, const NodePlace& node, Entries<Dim>& entries) {
  int count = 0;
  for (int f = 0; f < grids.motion.fields(); ++f) {
    Lanes* const motion = grids.motion.find(f, node.row, node.lateral);
    if (motion == nullptr || !((*motion)[MotionLane<Dim>::mass] > 0.0)) continue;
    Lanes* const surface = grids.surfaces.line(f, node.row, node.lateral);
    const Entry<Dim> entry{read_grain<Dim>(*motion, *surface), motion, surface,
                           static_cast<std::int8_t>(f)};
    int place = count++;
    for (; place > 0 && comes_before<Dim>(entry, entries[place - 1]); --place) {
      entries[place] = entries[place - 1];
    }
    entries[place] = entry;
  }
  return count;
}

/// Normal from the first to the second of two fields at a node, from the points there; null where
/// it is to come from the gradients.
template <int Dim>
const Vector<Dim>* parting(std::span<const NodePoint<Dim>> points, const Entries<Dim>& entries,
                           int count, Vector<Dim>& normal) {
  if (count != 2 || points.empty()) return nullptr;
  normal = parting_normal<Dim>(points, entries[0].field, entries[1].field);
  return normal.squaredNorm() > 0.0 ? &normal : nullptr;
}

}  // namespace poreshock
