#pragma once
// Private to physics: the fields that share a node.

#include <array>
#include <bit>

#include "poreshock/physics/grain_contact.hpp"
#include "poreshock/physics/parting_plane.hpp"
#include "poreshock/transfer/node_lanes.hpp"

namespace poreshock {

/// A field with mass at a node.
struct Entry {
  Lanes* motion;
  Lanes* surface;
  std::int8_t field;
};

using Entries = std::array<Entry, most_grains_at_node>;

template <int Dim>
void read_grain(const Lanes& motion, const Lanes& surface, NodeGrain<Dim>& grain) {
  using Motion = MotionLane<Dim>;
  using Surface = SurfaceLane<Dim>;
  grain.mass = motion[Motion::mass];
  grain.volume = surface[Surface::volume];
  grain.strain = grain.volume > 0.0 ? surface[Surface::strain] / grain.volume : 0.0;
  for (int a = 0; a < Dim; ++a) {
    grain.start[a] = motion[Motion::start_velocity + a];
    grain.end[a] = motion[Motion::end_velocity + a];
    grain.gradient[a] = surface[Surface::gradient + a];
    grain.place[a] = grain.volume > 0.0 ? surface[Surface::place + a] / grain.volume : 0.0;
  }
}

/// Order that does not know the numbers of the fields.
template <int Dim>
bool comes_before(const Entry& first, const Entry& second) {
  const double masses[2] = {(*first.motion)[MotionLane<Dim>::mass],
                            (*second.motion)[MotionLane<Dim>::mass]};
  if (masses[0] != masses[1]) return masses[0] > masses[1];
  NodeGrain<Dim> a, b;
  read_grain<Dim>(*first.motion, *first.surface, a);
  read_grain<Dim>(*second.motion, *second.surface, b);
  for (int k = 0; k < Dim; ++k) {
    if (a.end[k] != b.end[k]) return a.end[k] < b.end[k];
  }
  for (int k = 0; k < Dim; ++k) {
    if (a.place[k] != b.place[k]) return a.place[k] < b.place[k];
  }
  return false;
}

/// Fields with mass at a node, in their order.
template <int Dim>
std::span<const Entry> read_entries(const ContactGrids& grids, const NodePlace& node,
                                    Entries& entries) {
  std::size_t count = 0;
  for (std::uint32_t left = node.fields; left != 0; left &= left - 1) {
    const int f = std::countr_zero(left);
    const Entry entry{grids.motion.line(f, node.row, node.lateral),
                      grids.surfaces.line(f, node.row, node.lateral), static_cast<std::int8_t>(f)};
    std::size_t place = count++;
    for (; place > 0 && comes_before<Dim>(entry, entries[place - 1]); --place) {
      entries[place] = entries[place - 1];
    }
    entries[place] = entry;
  }
  return {entries.data(), count};
}

/// Normal from the first to the second of two fields at a node, from the points there; null where
/// it is to come from the gradients.
template <int Dim>
const Vector<Dim>* parting(std::span<const NodePoint<Dim>> points, std::span<const Entry> entries,
                           Vector<Dim>& normal) {
  if (entries.size() != 2 || points.empty()) return nullptr;
  normal = parting_normal<Dim>(points, entries[0].field, entries[1].field);
  return normal.squaredNorm() > 0.0 ? &normal : nullptr;
}

}  // namespace poreshock
