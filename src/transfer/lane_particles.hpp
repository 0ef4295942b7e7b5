#pragma once
// Columns of eight particles, a particle a lane.

#include <array>
#include <cstdint>
#include <vector>

#include "poreshock/core/lanes.hpp"

namespace poreshock {

/// Eight particles.
struct LaneParticles {
  std::array<std::uint32_t, lane_count> index;
  bool adjacent;  ///< their columns are
};

/// Of one particle.
inline double load(const std::vector<double>& column, std::uint32_t p) {
  return column[p];
}

inline Lanes load(const std::vector<double>& column, const LaneParticles& particles) {
  if (particles.adjacent) {
    return *reinterpret_cast<const Lanes*>(column.data() + particles.index[0]);
  }
  double values[lane_count];
  for (int n = 0; n < lane_count; ++n) values[n] = column[particles.index[n]];
  return *reinterpret_cast<const Lanes*>(values);
}

inline void store(const Lanes& lanes, const LaneParticles& particles, std::vector<double>& column) {
  if (particles.adjacent) {
    *reinterpret_cast<Lanes*>(column.data() + particles.index[0]) = lanes;
    return;
  }
  double values[lane_count];
  *reinterpret_cast<Lanes*>(values) = lanes;
  double* const target = column.data();
  for (int n = 0; n < lane_count; ++n) target[particles.index[n]] = values[n];
}

}  // namespace poreshock
