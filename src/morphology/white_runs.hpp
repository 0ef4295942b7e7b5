#pragma once
// Runs of white pixels in the rows of a slab. Private to the layer.

#include <bit>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <vector>

#include "slab.hpp"

namespace poreshock {

/// White pixels first ... last of one row.
struct Run {
  std::int32_t first;
  std::int32_t last;
};

/// Runs of all stored rows; row r (y + ny z) has runs starts[r] ... starts[r + 1] - 1.
struct Runs {
  std::vector<Run> runs;
  std::vector<std::uint32_t> starts;

  std::span<const Run> row(std::size_t r) const {
    return std::span(runs).subspan(starts[r], starts[r + 1] - starts[r]);
  }
};

/// The bits of 64 pixels: 1 where material reaches the threshold. `flags` is 64 bytes of scratch.
inline std::uint64_t white_bits(const double* values, const std::uint8_t* solid, double threshold,
                                std::size_t count, std::uint8_t* flags) {
  for (std::size_t i = 0; i < count; ++i) {
    flags[i] =
        static_cast<std::uint8_t>((values[i] >= threshold ? 1 : 0) & (solid[i] != 0 ? 1 : 0));
  }
  for (std::size_t i = count; i < 64; ++i) flags[i] = 0;
  std::uint64_t bits = 0;
  for (std::size_t k = 0; k < 8; ++k) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, flags + 8 * k, sizeof(eight));
    // Each byte is 0 or 1; the product moves the lowest bit of byte i to bit 56 + i.
    bits |= ((eight * 0x0102040810204080U) >> 56) << (8 * k);
  }
  return bits;
}

/// Appends the runs of a row.
inline void append_runs(std::span<const double> values, std::span<const std::uint8_t> solid,
                        double threshold, std::vector<Run>& runs) {
  std::uint8_t flags[64];
  bool open = false;
  for (std::size_t at = 0; at < values.size(); at += 64) {
    const std::size_t count = std::min<std::size_t>(64, values.size() - at);
    const std::uint64_t bits = white_bits(&values[at], &solid[at], threshold, count, flags);
    // A bit of `flips` is set where the colour differs from that of the pixel before.
    std::uint64_t flips = bits ^ ((bits << 1) | (open ? 1 : 0));
    for (; flips != 0; flips &= flips - 1) {
      const auto x = static_cast<std::int32_t>(at) + std::countr_zero(flips);
      if (open) {
        runs.back().last = x - 1;
      } else {
        runs.push_back({x, x});
      }
      open = !open;
    }
  }
  if (open) runs.back().last = static_cast<std::int32_t>(values.size()) - 1;
}

/// All runs of a slab.
inline Runs find_runs(const Slab& slab, std::span<const double> values,
                      std::span<const std::uint8_t> solid, double threshold) {
  Runs result;
  const auto width = static_cast<std::size_t>(slab.nx);
  const std::size_t rows = slab.stored_size() / width;
  result.starts.push_back(0);
  for (std::size_t r = 0; r < rows; ++r) {
    append_runs(values.subspan(r * width, width), solid.subspan(r * width, width), threshold,
                result.runs);
    result.starts.push_back(static_cast<std::uint32_t>(result.runs.size()));
  }
  return result;
}

}  // namespace poreshock
