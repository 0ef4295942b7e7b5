#pragma once
// Particles whose every number follows from their id, so that any mix-up shows.

#include <bit>
#include <limits>
#include <string>
#include <type_traits>

#include "poreshock/particles/particles.hpp"
#include "support/random_numbers.hpp"

namespace poreshock::test {

/// What column number `column` holds for particle `id`: any bit pattern, NaNs and -0 among them.
template <class Value>
Value expected_value(std::int64_t id, int column) {
  reference::Random random{static_cast<std::uint64_t>(id) * 1000 +
                           static_cast<std::uint64_t>(column)};
  if constexpr (std::is_same_v<Value, double>) {
    const int special = random.below(20);
    if (special == 0) return -0.0;
    if (special == 1) return std::numeric_limits<double>::quiet_NaN();
    return std::bit_cast<double>(random.bits());
  } else {
    return static_cast<Value>(random.bits());
  }
}

/// Fills the columns of particles with the given ids.
template <int Dim>
Particles<Dim> numbered_particles(ParticleOptions options, const std::vector<std::int64_t>& ids) {
  Particles<Dim> particles;
  particles.options = options;
  resize(particles, ids.size());
  int number = 0;
  for_each_column(particles, [&](std::string_view name, int, auto& column) {
    using Value = typename std::remove_reference_t<decltype(column)>::value_type;
    for (std::size_t p = 0; p < ids.size(); ++p) {
      column[p] = name == "id" ? static_cast<Value>(ids[p]) : expected_value<Value>(ids[p], number);
    }
    ++number;
  });
  return particles;
}

/// True when both hold the same bits.
template <class Value>
bool same_bits(const Value& a, const Value& b) {
  if constexpr (std::is_same_v<Value, double>) {
    return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b);
  } else {
    return a == b;
  }
}

/// First number that is not what the particle's id asks for, "" when all are.
template <int Dim>
std::string first_wrong_number(const Particles<Dim>& particles) {
  std::string wrong;
  int number = 0;
  for_each_column(particles, [&](std::string_view name, int component, const auto& column) {
    using Value = typename std::remove_reference_t<decltype(column)>::value_type;
    if (column.size() != particles.size()) wrong = "length of " + std::string(name);
    for (std::size_t p = 0; p < column.size() && wrong.empty() && name != "id"; ++p) {
      if (!same_bits(column[p], expected_value<Value>(particles.id[p], number))) {
        wrong = std::string(name) + " " + std::to_string(component) + " of particle " +
                std::to_string(particles.id[p]);
      }
    }
    ++number;
  });
  return wrong;
}

}  // namespace poreshock::test
