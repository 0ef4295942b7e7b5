#include "poreshock/morphology/isoline.hpp"

#include <array>
#include <cmath>

#include "interpolated.hpp"

namespace poreshock {
namespace {

/// Values at the centres of 2 x 2 pixels, around: low left, low right, high right, high left.
using Corners = std::array<double, 4>;

/// Place of the crossing on the side from corner k to the next, in the frame of the four centres.
std::array<double, 2> crossing(const Corners& value, std::size_t k, double threshold) {
  constexpr std::array<std::array<double, 2>, 4> corner = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};
  const std::size_t next = (k + 1) % 4;
  const double share = crossing_share(value[k], value[next], threshold);
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

}  // namespace

std::vector<double> isoline_lengths(const PixelField<2>& map, std::size_t field,
                                    std::span<const double> thresholds, MPI_Comm communicator) {
  const std::vector<std::uint32_t> ranks = ranks_of_map(map, field, thresholds);
  const Slab slab = slab_of(map);
  const auto nx = static_cast<std::size_t>(slab.nx);
  BoundarySums lengths(thresholds.size(), 0);
  for (int z = 0; z + 1 < slab.stored; ++z) {
    const std::size_t low = static_cast<std::size_t>(z) * nx;
    for (std::size_t x = 0; x + (slab.periodic_x ? 0 : 1) < nx; ++x) {
      const std::size_t next = x + 1 < nx ? x + 1 : 0;
      const std::array<std::size_t, 4> at = {low + x, low + next, low + nx + next, low + nx + x};
      add_cell(map, field, at, ranks, thresholds, length_in, lengths);
    }
  }
  return boundary_sizes(std::move(lengths), communicator);
}

}  // namespace poreshock
