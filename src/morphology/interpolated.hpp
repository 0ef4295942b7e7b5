#pragma once
// What interpolated isolines and isosurfaces share: the cells between pixel centres, and exact sums
// over them. Private to the layer.

#include <mpi.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "poreshock/core/parallel.hpp"
#include "poreshock/morphology/pixel_map.hpp"
#include "ranks.hpp"
#include "slab.hpp"

namespace poreshock {

/// Share of the way from a to b at which the interpolated value is the threshold.
inline double crossing_share(double a, double b, double threshold) {
  const double share = (threshold - a) / (b - a);
  // An infinite value has no place; its crossing is taken half way.
  return std::isfinite(share) ? share : 0.5;
}

/// Ranks of all stored pixels.
template <int Dim>
std::vector<std::uint32_t> ranks_of_map(const PixelField<Dim>& map, std::size_t field,
                                        std::span<const double> thresholds) {
  const RankTable table = make_rank_table(thresholds);
  const std::size_t stored = slab_of(map).stored_size();
  std::vector<std::uint32_t> ranks(stored);
  rank_row(table, std::span<const double>(map.values.at(field)).first(stored),
           std::span<const std::uint8_t>(map.solid).first(stored), ranks.data());
  return ranks;
}

/// Sizes of boundaries at every threshold, in multiples of 2^-30.
using BoundarySums = std::vector<std::int64_t>;
inline constexpr double boundary_unit = 1073741824.0;  // 2^30

/// Adds the boundaries in the cell between the pixels `at`, if all are material:
/// size_in(values there, threshold) is what one threshold has in it.
template <int Dim, std::size_t Corners, class SizeIn>
void add_cell(const PixelField<Dim>& map, std::size_t field,
              const std::array<std::size_t, Corners>& at, std::span<const std::uint32_t> ranks,
              std::span<const double> thresholds, SizeIn&& size_in, BoundarySums& sums) {
  std::uint32_t most = 0, least = ranks[at[0]];
  bool solid = true;
  for (const std::size_t i : at) {
    most = std::max(most, ranks[i]);
    least = std::min(least, ranks[i]);
    solid = solid && map.solid[i] != 0;
  }
  if (!solid || least == most) return;
  std::array<double, Corners> corners;
  for (std::size_t c = 0; c < Corners; ++c) corners[c] = map.values[field][at[c]];
  for (std::uint32_t j = least; j < most; ++j) {
    sums[j] += std::llrint(boundary_unit * size_in(corners, thresholds[j]));
  }
}

/// The sums of all ranks as numbers. Collective.
inline std::vector<double> boundary_sizes(BoundarySums sums, MPI_Comm communicator) {
  sum(sums, communicator);
  std::vector<double> sizes;
  for (const std::int64_t size : sums) sizes.push_back(static_cast<double>(size) / boundary_unit);
  return sizes;
}

}  // namespace poreshock
