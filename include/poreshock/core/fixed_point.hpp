#pragma once
// Sums that do not depend on the order of their terms: multiples of a power-of-two quantum, added
// as 128-bit integers.

#include <mpi.h>

#include <cmath>
#include <cstdint>
#include <vector>

#include "poreshock/core/lanes.hpp"

namespace poreshock {

__extension__ typedef __int128 Int128;

/// Multiples of `quantum` nearest to `value`, saturated at +-2^62.
inline std::int64_t quantise(double value, double inverse_quantum) {
  constexpr double limit = 4.611686018427388e18;
  const double scaled = value * inverse_quantum;
  const double clamped = scaled > limit ? limit : (scaled < -limit ? -limit : scaled);
  return std::llrint(clamped);
}

/// The same of the first `count` lanes, summed.
inline Int128 sum_of_quanta(const Lanes& values, int count, double inverse_quantum) {
  constexpr double small = 0x1p49, rounder = 0x1.8p52;
  const Lanes zero{}, scaled = values * inverse_quantum;
  const unsigned fit = bits_less(scaled, small - zero) & bits_less((-small) - zero, scaled);
  if ((fit & first_bits(count)) == first_bits(lane_count)) {
    // Whole numbers whose sum is below 2^53: exact in any order.
    const Lanes whole = (scaled + (rounder - zero)) - rounder;
    const HalfLanes half = low_half(whole) + high_half(whole);
    return static_cast<std::int64_t>((half[0] + half[1]) + (half[2] + half[3]));
  }
  Int128 sum = 0;
  for (int k = 0; k < count; ++k) sum += quantise(values[k], inverse_quantum);
  return sum;
}

/// Power of two not above `value` (> 0).
double power_of_two_below(double value);

/// Sum of each entry over all ranks, exact. Collective.
void sum(std::vector<Int128>& values, MPI_Comm communicator);

/// Two 64-bit words of each entry, for files.
std::vector<std::int64_t> to_words(const std::vector<Int128>& values);
std::vector<Int128> from_words(const std::vector<std::int64_t>& words);

}  // namespace poreshock
