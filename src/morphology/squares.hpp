#pragma once
// Particle squares and cubes in units of the map: sides in pixels, values as integers. Private to
// the layer.

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <limits>
#include <span>
#include <vector>

#include "poreshock/morphology/pixel_map.hpp"

namespace poreshock {

inline constexpr double weight_unit = 262144.0;      // 2^18
inline constexpr double place_limit = 2147483648.0;  // 2^31 pixels from the origin
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

/// Squares of a stretch of particles, as columns, so that their arithmetic vectorises.
template <int Dim>
struct Squares {
  static constexpr std::size_t stretch = 256;
  std::array<std::array<double, stretch>, Dim> low, high;  ///< pixels
  std::array<double, stretch> density;                     ///< typical densities
  std::array<std::uint8_t, stretch> usable;
};

/// Makes the squares of particles first ... first + count - 1, at most a stretch. The arithmetic
/// knows neither rank nor row, so that all ranks agree.
template <int Dim>
void make_squares(const PixelSources<Dim>& particles, std::size_t first, std::size_t count,
                  const PixelScales& scales, double pixel_size, Squares<Dim>& squares,
                  Counters& counters) {
  const double* mass = particles.mass.data() + first;
  const double* density = particles.density.data() + first;
  std::array<double, Squares<Dim>::stretch> sides, half, ratios;
  std::int64_t capped = 0, clamped = 0, skipped = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const double volume = mass[i] / density[i];
    // cbrt of the library may differ by one unit in the last place between systems; within one
    // system it is a pure function, which is all that equal bits on any number of ranks need.
    const double side = Dim == 2 ? std::sqrt(volume) : std::cbrt(volume);
    const double ratio = density[i] / scales.density;
    ratios[i] = ratio;
    sides[i] = side;
    half[i] = 0.5 * ((side < scales.max_side ? side : scales.max_side) / pixel_size);
    squares.density[i] = ratio < density_limit ? ratio : density_limit;
    const bool usable = (side > 0.0) & (side <= std::numeric_limits<double>::max()) & (ratio > 0.0);
    squares.usable[i] = usable ? 1 : 0;
  }
  for (std::size_t axis = 0; axis < Dim; ++axis) {
    const double* position = particles.position[axis].data() + first;
    // Whole pixels less are exact: a higher map has the same bits where both have pixels.
    const double low = axis + 1 < Dim ? 0.0 : scales.low;
    for (std::size_t i = 0; i < count; ++i) {
      const double centre = position[i] / pixel_size;
      // Keeps the numbers of the pixels far inside 64 bits.
      const bool near = std::abs(centre) < place_limit;
      squares.usable[i] = static_cast<std::uint8_t>(squares.usable[i] & (near ? 1 : 0));
      squares.low[axis][i] = (centre - half[i]) - low;
      squares.high[axis][i] = (centre + half[i]) - low;
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    const bool counted = squares.usable[i] != 0;
    capped += counted && sides[i] > scales.max_side ? 1 : 0;
    clamped += counted && ratios[i] > density_limit ? 1 : 0;
    skipped += counted ? 0 : 1;
  }
  counters.capped += capped;
  counters.clamped += clamped;
  counters.skipped += skipped;
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

/// A value as a map adds it up.
struct Addend {
  std::int64_t multiple = 0;  ///< of the quantum of its field, rounded down; |multiple| <= 2^31
  std::uint64_t key = 0;      ///< the value itself, by descending_key
};

/// The bits of a value as a number that falls where the value rises; only NaN can give 0.
inline std::uint64_t descending_key(double value) {
  constexpr std::uint64_t sign = std::uint64_t{1} << 63;
  const auto bits = std::bit_cast<std::uint64_t>(value);
  return ~((bits & sign) != 0 ? ~bits : bits | sign);
}

inline double value_of_key(std::uint64_t key) {
  constexpr std::uint64_t sign = std::uint64_t{1} << 63;
  const std::uint64_t bits = ~key;
  return std::bit_cast<double>((bits & sign) != 0 ? bits & ~sign : ~bits);
}

/// Rounding of the values of a field.
struct ValueRounding {
  double largest = 0.0;  ///< of all finite values by size
  double quantum = 1.0;  ///< a power of two
  double inverse_quantum = 1.0;
};

/// The rounding of values of at most this size: to 2^-31 of the power of two above it.
inline ValueRounding rounding_of(double largest) {
  int exponent = 0;
  std::frexp(largest, &exponent);
  // Far below, the inverse would leave the doubles.
  exponent = std::max(exponent, -960) - 31;
  return {largest, std::ldexp(1.0, exponent), std::ldexp(1.0, -exponent)};
}

/// Rounds one value of a stretch of particles; returns how many were not finite and are held.
inline std::int64_t round_values(std::span<const double> values, const ValueRounding& rounding,
                                 const std::uint8_t* usable, Addend* addends) {
  std::int64_t held_back = 0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double value = values[i];
    const bool finite = std::abs(value) <= rounding.largest;
    held_back += !finite && usable[i] != 0 ? 1 : 0;
    // NaN fails every comparison and becomes 0.
    const double held =
        finite ? value : (value > 0.0 ? rounding.largest : (value < 0.0 ? -rounding.largest : 0.0));
    addends[i].multiple = static_cast<std::int64_t>(std::floor(held * rounding.inverse_quantum));
    addends[i].key = descending_key(held);
  }
  return held_back;
}

}  // namespace poreshock
