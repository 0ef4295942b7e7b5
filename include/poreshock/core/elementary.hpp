#pragma once
// Logarithm and exponential whose bits depend on nothing but the argument: no mathematics library,
// no look-up, only + - * / and the bits of a double, so that scalar and vector loops of any
// instruction set agree. Errors: a few units in the last place.

#include <bit>
#include <cstdint>

namespace poreshock {

/// ln x of a positive normal number.
inline double natural_logarithm(double x) {
  // x = 2^e m with m in [1/sqrt 2, sqrt 2): the difference of the bits from those of 1/sqrt 2 has
  // e above the fraction.
  constexpr std::uint64_t root_half = 0x3fe6a09e667f3bcd;
  constexpr std::uint64_t fraction = 0x000fffffffffffff;
  const std::uint64_t shifted = std::bit_cast<std::uint64_t>(x) - root_half;
  const double m = std::bit_cast<double>((shifted & fraction) + root_half);
  // The exponent as a double without a conversion of integers, which not every vector unit has.
  const std::uint64_t biased = (shifted + 0x4000000000000000) >> 52;  // e + 1024
  const double e = std::bit_cast<double>(biased | 0x4330000000000000) - (0x1p52 + 1024.0);
  // ln m = 2 artanh(s), |s| < 0.1716; the first term left out is 2e-18 of the sum.
  const double s = (m - 1.0) / (m + 1.0);
  const double s2 = s * s;
  double series = 1.0 / 21.0;
  for (int k = 19; k > 0; k -= 2) series = 1.0 / k + s2 * series;
  constexpr double ln2_high = 0x1.62e42fefa38p-1;  // with so few bits that e times it is exact
  constexpr double ln2_low = 0x1.ef35793c7673p-45;
  return e * ln2_high + (2.0 * s * series + e * ln2_low);
}

/// e^x, for |x| > 700 that of 700 or -700.
inline double exponential(double x) {
  const double below = x < 700.0 ? x : 700.0;
  const double held = below > -700.0 ? below : -700.0;
  constexpr double shift = 0x1.8p52;  // adding it rounds to a whole number, in the lowest bits
  const double rounded = held * 0x1.71547652b82fep0 + shift;
  const double k = rounded - shift;
  const double r = (held - k * 0x1.62e42fefa38p-1) - k * 0x1.ef35793c7673p-45;
  // |r| < 0.347: the first term left out is 4e-18.
  constexpr double inverse_factorial[] = {1.0,
                                          1.0,
                                          1.0 / 2.0,
                                          1.0 / 6.0,
                                          1.0 / 24.0,
                                          1.0 / 120.0,
                                          1.0 / 720.0,
                                          1.0 / 5040.0,
                                          1.0 / 40320.0,
                                          1.0 / 362880.0,
                                          1.0 / 3628800.0,
                                          1.0 / 39916800.0,
                                          1.0 / 479001600.0,
                                          1.0 / 6227020800.0};
  double series = inverse_factorial[13];
  for (int n = 12; n >= 0; --n) series = inverse_factorial[n] + r * series;
  const std::uint64_t power = std::bit_cast<std::uint64_t>(rounded) + 1023;
  return series * std::bit_cast<double>(power << 52);
}

/// x^n of x > 0, and 0 for x <= 0.
inline double positive_power(double x, double n) {
  return x > 0.0 ? exponential(n * natural_logarithm(x)) : 0.0;
}

}  // namespace poreshock
