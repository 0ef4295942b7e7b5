#pragma once
// Averages over the rows of cells along the shock axis, and the shock front they show.

#include <vector>

#include "poreshock/output/profile_file.hpp"
#include "poreshock/solver/simulation.hpp"

namespace poreshock {

/// Averages over each row of cells of the grid (Profile says how they are weighted), with the
/// front. Each particle counts in the rows it overlaps: it fills evenly the length m / (rho d^(Dim
/// - 1)) around its position, at most a cell, with d the spacing of the lattice; compression along
/// the shock axis so leaves no gaps. Sets `floored` to the number of temperatures of this rank that
/// were set to the floor of 1 K. Memory: a few numbers per row and particle. The same bits on any
/// number of ranks. Collective.
template <int Dim>
Profile measure_profile(const Simulation<Dim>& sim, std::int64_t& floored);

/// Place and width of a shock front, m; NaN where there is none.
struct Front {
  double position = 0.0;
  double width = 0.0;
};

/// Front of the shock that runs upwards through material at velocity `ahead` and leaves it at
/// `behind`, m/s, from the mean velocities of rows at `height`. With u = (v - ahead) / (behind -
/// ahead), the position is where u first reaches 0.5 coming down from the top, linear between rows;
/// the width is the distance from there, likewise, of u = 0.1 and u = 0.9. Rows without material
/// (NaN) are skipped. No front: behind <= ahead, u >= 0.1 in the highest row with material (the
/// front has left), or a level that no row reaches. Not collective.
Front find_front(const std::vector<double>& height, const std::vector<double>& velocity,
                 double ahead, double behind);

}  // namespace poreshock
