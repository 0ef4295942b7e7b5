#pragma once
// Counter-based random numbers (Philox4x32-10, Salmon et al., SC 2011): a pure function of seed,
// stream and counter, so that every rank and every order of calls sees the same numbers.

#include <array>
#include <cmath>
#include <cstdint>

namespace poreshock {

/// What a random number is used for; numbers of different streams are independent.
enum class RandomStream : std::uint32_t {
  radius = 1,
  position = 2,
  shake = 3,
  material = 4,
  sites = 5
};

/// One block of four random 32-bit words: ten rounds of Philox4x32.
inline std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter,
                                           std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = std::uint64_t{0xD2511F53U} * counter[0];
    const std::uint64_t b = std::uint64_t{0xCD9E8D57U} * counter[2];
    counter = {
        static_cast<std::uint32_t>(b >> 32) ^ counter[1] ^ key[0], static_cast<std::uint32_t>(b),
        static_cast<std::uint32_t>(a >> 32) ^ counter[3] ^ key[1], static_cast<std::uint32_t>(a)};
    key[0] += 0x9E3779B9U;
    key[1] += 0xBB67AE85U;
  }
  return counter;
}

/// Four uniform numbers in the open interval (0, 1), multiples of 2^-33.
inline std::array<double, 4> uniforms(std::uint64_t seed, RandomStream stream, std::uint64_t index,
                                      std::uint32_t draw) {
  const std::array<std::uint32_t, 4> words =
      philox({static_cast<std::uint32_t>(index), static_cast<std::uint32_t>(index >> 32), draw,
              static_cast<std::uint32_t>(stream)},
             {static_cast<std::uint32_t>(seed), static_cast<std::uint32_t>(seed >> 32)});
  std::array<double, 4> result{};
  for (std::size_t i = 0; i < 4; ++i) {
    result[i] = (static_cast<double>(words[i]) + 0.5) * 0x1p-32;
  }
  return result;
}

/// One standard normal number, redrawn until its absolute value is at most `cut` (Box-Muller).
inline double truncated_normal(std::uint64_t seed, RandomStream stream, std::uint64_t index,
                               double cut) {
  constexpr double two_pi = 6.283185307179586476925287;
  for (std::uint32_t draw = 0;; ++draw) {
    const std::array<double, 4> u = uniforms(seed, stream, index, draw);
    for (const std::size_t k : {std::size_t{0}, std::size_t{2}}) {
      const double z = std::sqrt(-2.0 * std::log(u[k])) * std::cos(two_pi * u[k + 1]);
      if (std::fabs(z) <= cut) return z;
    }
  }
}

}  // namespace poreshock
