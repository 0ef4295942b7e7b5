#pragma once
// Voids that keep their distance: random sequential addition, and where that ends, relaxation of
// soft voids followed by random moves. Also in relax.cpp.

#include <cstdint>
#include <vector>

#include "block.hpp"

namespace poreshock {

/// Voids of given radii in a block and the distances they have to keep.
struct Packing {
  Block block;
  double ligament = 0.0;  ///< m, least gap between two voids
  double keep_out = 0.0;  ///< m, least gap between a void and a side that is not periodic
  std::uint64_t seed = 1;
  std::vector<Void> voids;  ///< radii given; the functions below set the centres
};

/// Distance of the centres at which the gap of two voids equals the ligament, m.
inline double contact_distance(const Packing& packing, const Void& a, const Void& b) {
  return a.radius + b.radius + packing.ligament;
}

/// Largest distance at which two voids can be in contact, m.
double largest_contact(const Packing& packing);

/// Share of the space open to voids that they take with half the ligament around each. Random
/// arrangements of equal discs end near 0.84 and of balls near 0.64.
double crowding(const Packing& packing);

/// Uniform random centre allowed for void `index`; `draw` numbers the trials.
Triple random_centre(const Packing& packing, std::size_t index, std::uint32_t draw);

/// Random sequential addition: each void goes to the first of its random trials that is free. Voids
/// that find no place within the budget of trials stay at their last one. Returns whether all of
/// them found a free place.
bool add_in_sequence(Packing& packing);

/// Moves overlapping voids apart (FIRE on soft voids, with cell lists), trying for spare distance
/// first. Returns whether all distances are kept.
bool relax(Packing& packing);

/// Random moves that keep all distances (hard-disc Monte Carlo): removes the traces of relaxation.
void shake(Packing& packing);

/// Common factor on all radii at which the present centres would just keep all distances; 0 when
/// none does.
double fitting_scale(const Packing& packing);

/// Lists of the voids near each void.
struct Neighbours {
  std::vector<std::size_t> start;  ///< voids near i: item[start[i]] ... item[start[i + 1] - 1]
  std::vector<int> item;
  std::vector<Triple> reference;  ///< centres at which the lists were made
  double skin = 0.0;              ///< m; lists hold while no void has moved skin / 2
};

/// All pairs closer than stretch * contact distance + skin.
Neighbours find_neighbours(const Packing& packing, double stretch, double skin);

}  // namespace poreshock
