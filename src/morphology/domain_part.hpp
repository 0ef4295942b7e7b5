#pragma once
// What is known of a connected domain or of a part of it, gathered run by run. Private to the
// layer.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

#include "label_runs.hpp"

namespace poreshock {

/// No finite value of a map has more quanta; 2^31 pixels of so many fit 64 bits.
inline constexpr double most_quanta = 0x1p32;

/// What is known of a domain or of a part of it. Coordinates run on across periodic sides, so that
/// they may lie outside the map; sums are exact integers.
struct DomainPart {
  std::int64_t pixels = 0;
  std::int64_t value_sum = 0;  ///< in quanta
  double peak = -std::numeric_limits<double>::infinity();
  std::array<std::int64_t, 3> sum{};  ///< of twice the pixel centres
  std::array<std::int64_t, 3> low{};
  std::array<std::int64_t, 3> high{};
  std::array<std::uint8_t, 2> winds{};
  std::int64_t first = std::numeric_limits<std::int64_t>::max();
};

/// Sizes of the whole map: nx, ny, and the first layer of this slab.
struct MapFrame {
  std::int64_t nx = 0;
  std::int64_t ny = 0;
  std::int64_t first_layer = 0;
};

/// Adds `part`, displaced by whole maps, to `domain`.
inline void add(const DomainPart& part, Crossings at, const MapFrame& frame, DomainPart& domain) {
  domain.winds[0] |= part.winds[0];
  domain.winds[1] |= part.winds[1];
  if (part.pixels == 0) return;
  const std::array<std::int64_t, 3> shift = {at.x * frame.nx, at.y * frame.ny, 0};
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const std::int64_t low = part.low[axis] + shift[axis];
    const std::int64_t high = part.high[axis] + shift[axis];
    domain.low[axis] = domain.pixels == 0 ? low : std::min(domain.low[axis], low);
    domain.high[axis] = domain.pixels == 0 ? high : std::max(domain.high[axis], high);
    domain.sum[axis] += part.sum[axis] + 2 * shift[axis] * part.pixels;
  }
  domain.pixels += part.pixels;
  domain.value_sum += part.value_sum;
  domain.peak = part.peak > domain.peak ? part.peak : domain.peak;
  domain.first = std::min(domain.first, part.first);
}

/// Adds a run to the part of its label; the runs of a part come in the order of their rows.
inline void add_run(const Run& run, std::int64_t y, std::int64_t z, const double* values,
                    double inverse_quantum, const MapFrame& frame, DomainPart& part) {
  const auto quanta = [&](std::int32_t x) {
    // An infinite value counts as twice the largest finite one.
    const double exact = values[x] * inverse_quantum;
    const double below = exact < most_quanta ? exact : most_quanta;
    return std::llrint(below > -most_quanta ? below : -most_quanta);
  };
  const auto higher = [](double a, double b) { return a > b ? a : b; };
  // Both ends first: a loop over the one or two pixels of most runs of a noise ends unforeseen.
  const std::int64_t of_last = quanta(run.last);
  std::int64_t value_sum = quanta(run.first) + (run.last > run.first ? of_last : 0);
  double peak = higher(higher(values[run.first], values[run.last]), part.peak);
  for (std::int32_t x = run.first + 1; x < run.last; ++x) {
    value_sum += quanta(x);
    peak = higher(values[x], peak);
  }
  part.peak = peak;
  part.value_sum += value_sum;
  if (part.pixels == 0) {
    part.low = part.high = {run.first, y, z};
    part.first = (z * frame.ny + y) * frame.nx + run.first;
  }
  const std::int64_t pixels = run.last - run.first + 1;
  part.pixels += pixels;
  part.low[0] = std::min<std::int64_t>(part.low[0], run.first);
  part.high[0] = std::max<std::int64_t>(part.high[0], run.last);
  part.low[1] = std::min(part.low[1], y);
  part.high[1] = std::max(part.high[1], y);
  part.high[2] = z;
  part.sum[0] += pixels * (std::int64_t{run.first} + run.last + 1);
  part.sum[1] += pixels * (2 * y + 1);
  part.sum[2] += pixels * (2 * z + 1);
}

}  // namespace poreshock
