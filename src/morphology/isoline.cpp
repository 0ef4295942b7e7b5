#include "poreshock/morphology/isoline.hpp"

#include <array>
#include <cmath>

#include "poreshock/core/parallel.hpp"
#include "ranks.hpp"
#include "slab.hpp"

namespace poreshock {
namespace {

constexpr double length_unit = 1073741824.0;  // 2^30

/// Values at the centres of 2 x 2 pixels, around: low left, low right, high right, high left.
using Corners = std::array<double, 4>;

/// Place of the crossing on the side from corner k to the next, in the frame of the four centres.
std::array<double, 2> crossing(const Corners& value, std::size_t k, double threshold) {
  constexpr std::array<std::array<double, 2>, 4> corner = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  const std::size_t next = (k + 1) % 4;
  const double between = (threshold - value[k]) / (value[next] - value[k]);
  // An infinite value has no place; its crossing is taken half way.
  const double share = std::isfinite(between) ? between : 0.5;
  return {corner[k][0] + share * (corner[next][0] - corner[k][0]),
          corner[k][1] + share * (corner[next][1] - corner[k][1])};
}

double piece(const Corners& value, std::size_t a, std::size_t b, double threshold) {
  const auto p = crossing(value, a, threshold);
  const auto q = crossing(value, b, threshold);
  return std::hypot(q[0] - p[0], q[1] - p[1]);
}

/// Length of the line within the square of four centres.
double length_in(const Corners& value, double threshold) {
  std::array<std::size_t, 4> sides{};
  std::size_t crossed = 0;
  for (std::size_t k = 0; k < 4; ++k) {
    const bool here = value[k] >= threshold;
    if (here != (value[(k + 1) % 4] >= threshold)) sides[crossed++] = k;
  }
  if (crossed == 0) return 0.0;
  if (crossed == 2) return piece(value, sides[0], sides[1], threshold);
  // Four crossings: the pieces cut off the corners of the colour that does not join.
  const double mean = 0.25 * (value[0] + value[1] + value[2] + value[3]);
  const bool cut_even = (value[0] >= threshold) != (mean >= threshold);
  const std::size_t first = cut_even ? 0 : 1;
  return piece(value, (first + 3) % 4, first, threshold) +
         piece(value, first + 1, (first + 2) % 4, threshold);
}

/// Adds the lines of the squares above row z.
void add_row(const PixelField<2>& map, std::size_t field, const Slab& slab, int z,
             std::span<const std::uint32_t> ranks, std::span<const double> thresholds,
             std::vector<std::int64_t>& lengths) {
  const auto nx = static_cast<std::size_t>(slab.nx);
  const std::size_t low = static_cast<std::size_t>(z) * nx;
  const std::vector<double>& values = map.values[field];
  for (std::size_t x = 0; x + (slab.periodic_x ? 0 : 1) < nx; ++x) {
    const std::size_t next = x + 1 < nx ? x + 1 : 0;
    const std::array<std::size_t, 4> at = {low + x, low + next, low + nx + next, low + nx + x};
    std::uint32_t most = 0, least = ranks[at[0]];
    bool solid = true;
    for (const std::size_t i : at) {
      most = std::max(most, ranks[i]);
      least = std::min(least, ranks[i]);
      solid = solid && map.solid[i] != 0;
    }
    if (!solid) continue;
    const Corners corners = {values[at[0]], values[at[1]], values[at[2]], values[at[3]]};
    for (std::uint32_t j = least; j < most; ++j) {
      lengths[j] += std::llrint(length_unit * length_in(corners, thresholds[j]));
    }
  }
}

}  // namespace

std::vector<double> isoline_lengths(const PixelField<2>& map, std::size_t field,
                                    std::span<const double> thresholds, MPI_Comm communicator) {
  const RankTable table = make_rank_table(thresholds);
  const Slab slab = slab_of(map);
  const std::size_t stored = slab.stored_size();
  std::vector<std::uint32_t> ranks(stored);
  rank_row(table, std::span<const double>(map.values.at(field)).first(stored),
           std::span<const std::uint8_t>(map.solid).first(stored), ranks.data());
  std::vector<std::int64_t> lengths(thresholds.size(), 0);
  for (int z = 0; z + 1 < slab.stored; ++z)
    add_row(map, field, slab, z, ranks, thresholds, lengths);
  sum(lengths, communicator);
  std::vector<double> result;
  for (const std::int64_t length : lengths) {
    result.push_back(static_cast<double>(length) / length_unit);
  }
  return result;
}

}  // namespace poreshock
