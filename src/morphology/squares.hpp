#pragma once
// Particle squares and cubes in units of the map: sides in pixels, values as integers. Private to
// the layer.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "poreshock/morphology/pixel_map.hpp"

namespace poreshock {

inline constexpr double weight_unit = 262144.0;      // 2^18
inline constexpr double value_unit = 1048576.0;      // 2^20
inline constexpr double value_limit = 2147483648.0;  // 2^31
inline constexpr double density_limit = 64.0;

/// What was held, cut or left out, on this rank.
struct Counters {
  std::int64_t capped = 0;
  std::int64_t clamped = 0;
  std::int64_t skipped = 0;
};

/// A particle square along one axis, in pixels.
struct Interval {
  double low = 0.0;
  double high = 0.0;
};

/// A particle in pixels and typical densities.
template <int Dim>
struct Square {
  std::array<Interval, Dim> sides;
  double density = 0.0;
};

enum class SquareKind { usable, skipped };

/// The square of particle i. The arithmetic knows neither rank nor row, so that all ranks agree.
template <int Dim>
SquareKind make_square(const PixelSources<Dim>& particles, std::size_t i, const PixelScales& scales,
                       double pixel_size, Square<Dim>& square, Counters& counters) {
  const double volume = particles.mass[i] / particles.density[i];
  // cbrt of the library may differ by one unit in the last place between systems; within one
  // system it is a pure function, which is all that equal bits on any number of ranks need.
  const double natural_side = Dim == 2 ? std::sqrt(volume) : std::cbrt(volume);
  const double ratio = particles.density[i] / scales.density;
  bool usable = natural_side > 0.0 && std::isfinite(natural_side) && ratio > 0.0;
  const double half = 0.5 * (std::min(natural_side, scales.max_side) / pixel_size);
  for (std::size_t axis = 0; axis < Dim; ++axis) {
    const double centre = particles.position[axis][i] / pixel_size;
    // Keeps the numbers of the pixels far inside 64 bits.
    usable = usable && std::abs(centre) < value_limit;
    square.sides[axis] = {centre - half, centre + half};
  }
  if (!usable) {
    ++counters.skipped;
    return SquareKind::skipped;
  }
  if (natural_side > scales.max_side) ++counters.capped;
  if (ratio > density_limit) ++counters.clamped;
  square.density = std::min(ratio, density_limit);
  return SquareKind::usable;
}

/// Overlap of a square with the pixels along one axis: lengths in pixels and the pixels' numbers,
/// in the first `count` entries.
struct Overlaps {
  std::size_t count = 0;
  std::vector<int> pixel;
  std::vector<double> length;
};

/// Room for the overlaps of a square of this side in pixels.
inline Overlaps make_overlaps(double side) {
  const auto most = static_cast<std::size_t>(side) + 3;
  return {0, std::vector<int>(most), std::vector<double>(most)};
}

inline void find_overlaps(const Interval& side, int pixels, bool periodic, Overlaps& overlaps) {
  auto begin = static_cast<std::int64_t>(std::floor(side.low));
  auto end = static_cast<std::int64_t>(std::ceil(side.high));
  if (!periodic) {
    begin = std::max<std::int64_t>(begin, 0);
    end = std::min<std::int64_t>(end, pixels);
  }
  std::size_t count = 0;
  for (std::int64_t i = begin; i < end; ++i) {
    const auto at = static_cast<double>(i);
    // A division takes longer than all the rest; most pixels need none.
    const bool inside = i >= 0 && i < pixels;
    const std::int64_t wrapped = inside ? i : ((i % pixels) + pixels) % pixels;
    overlaps.pixel[count] = static_cast<int>(wrapped);
    overlaps.length[count] = std::min(side.high, at + 1.0) - std::max(side.low, at);
    ++count;
  }
  overlaps.count = count;
}

/// Rounds the values of particle i to integers.
inline void round_values(std::span<const PixelValues> values, std::size_t i, std::int64_t* rounded,
                         Counters& counters) {
  for (std::size_t k = 0; k < values.size(); ++k) {
    const double scaled = values[k].value[i] / values[k].scale * value_unit;
    const bool inside = std::abs(scaled) <= value_limit;
    if (!inside) ++counters.clamped;
    // NaN fails every comparison and becomes 0.
    const double held =
        inside ? scaled : (scaled > 0.0 ? value_limit : (scaled < 0.0 ? -value_limit : 0.0));
    rounded[k] = std::llrint(held);
  }
}

}  // namespace poreshock
