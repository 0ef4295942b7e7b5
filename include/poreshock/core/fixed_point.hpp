#pragma once
// Sums that do not depend on the order of their terms: multiples of a power-of-two quantum, added
// as 128-bit integers.

#include <mpi.h>

#include <cmath>
#include <cstdint>
#include <vector>

namespace poreshock {

__extension__ typedef __int128 Int128;

/// Multiples of `quantum` nearest to `value`, saturated at +-2^62.
inline std::int64_t quantise(double value, double inverse_quantum) {
  constexpr double limit = 4.611686018427388e18;
  const double scaled = value * inverse_quantum;
  const double clamped = scaled > limit ? limit : (scaled < -limit ? -limit : scaled);
  return std::llrint(clamped);
}

/// Power of two not above `value` (> 0).
double power_of_two_below(double value);

/// Sum of each entry over all ranks, exact. Collective.
void sum(std::vector<Int128>& values, MPI_Comm communicator);

/// Two 64-bit words of each entry, for files.
std::vector<std::int64_t> to_words(const std::vector<Int128>& values);
std::vector<Int128> from_words(const std::vector<std::int64_t>& words);

}  // namespace poreshock
