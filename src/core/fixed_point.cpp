#include "poreshock/core/fixed_point.hpp"

#include "poreshock/core/parallel.hpp"

namespace poreshock {

double power_of_two_below(double value) {
  int exponent = 0;
  std::frexp(value, &exponent);
  return std::ldexp(1.0, exponent - 1);
}

void sum(std::vector<Int128>& values, MPI_Comm communicator) {
  // Split into a signed high part and a 40-bit low part: sums over up to 2^23 ranks cannot
  // overflow.
  std::vector<std::int64_t> parts;
  for (const Int128 value : values) {
    parts.push_back(static_cast<std::int64_t>(value >> 40));
    parts.push_back(static_cast<std::int64_t>(value & ((Int128{1} << 40) - 1)));
  }
  sum(parts, communicator);
  for (std::size_t k = 0; k < values.size(); ++k) {
    values[k] = Int128{parts[2 * k]} * (Int128{1} << 40) + parts[2 * k + 1];
  }
}

std::vector<std::int64_t> to_words(const std::vector<Int128>& values) {
  std::vector<std::int64_t> words;
  for (const Int128 value : values) {
    words.push_back(static_cast<std::int64_t>(value >> 64));
    words.push_back(static_cast<std::int64_t>(static_cast<std::uint64_t>(value)));
  }
  return words;
}

std::vector<Int128> from_words(const std::vector<std::int64_t>& words) {
  std::vector<Int128> values;
  for (std::size_t k = 0; k + 1 < words.size(); k += 2) {
    values.push_back(Int128{words[k]} * (Int128{1} << 64) +
                     static_cast<std::uint64_t>(words[k + 1]));
  }
  return values;
}

}  // namespace poreshock
