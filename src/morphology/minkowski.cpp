#include "poreshock/morphology/minkowski.hpp"

#include <numbers>
#include <string>

#include "poreshock/core/error.hpp"

namespace poreshock {
namespace {

template <class Counts>
std::vector<const std::vector<std::int64_t>*> arrays_of(const Counts& counts) {
  std::vector<const std::vector<std::int64_t>*> arrays;
  for_each_count(counts, [&](std::string_view, const auto& array) { arrays.push_back(&array); });
  return arrays;
}

template <class Counts>
void add_counts(const Counts& b, Counts& a) {
  a.pixels += b.pixels;
  const auto sources = arrays_of(b);
  std::size_t next = 0;
  for_each_count(a, [&](std::string_view name, std::vector<std::int64_t>& array) {
    const std::vector<std::int64_t>& source = *sources[next++];
    if (array.empty()) array.resize(source.size(), 0);
    if (array.size() != source.size()) {
      throw InputError("counts " + std::string(name) + " for " + std::to_string(source.size()) +
                       " thresholds cannot be added to counts for " + std::to_string(array.size()) +
                       ". Use one list of thresholds for both.");
    }
    for (std::size_t j = 0; j < array.size(); ++j) array[j] += source[j];
  });
}

template <class Counts>
bool equal_counts(const Counts& a, const Counts& b) {
  const auto left = arrays_of(a);
  const auto right = arrays_of(b);
  bool equal = a.pixels == b.pixels;
  for (std::size_t i = 0; i < left.size(); ++i) equal = equal && *left[i] == *right[i];
  return equal;
}

/// One functional per pixel for every threshold; zero for a map without material.
template <class Count>
std::vector<double> per_pixel(std::int64_t pixels, std::size_t thresholds, Count count) {
  std::vector<double> result(thresholds, 0.0);
  if (pixels == 0) return result;
  for (std::size_t j = 0; j < thresholds; ++j) {
    result[j] = static_cast<double>(count(j)) / static_cast<double>(pixels);
  }
  return result;
}

}  // namespace

void add(const PixelCounts& b, PixelCounts& a) {
  add_counts(b, a);
}
void add(const VoxelCounts& b, VoxelCounts& a) {
  add_counts(b, a);
}

bool operator==(const PixelCounts& a, const PixelCounts& b) {
  return equal_counts(a, b);
}
bool operator==(const VoxelCounts& a, const VoxelCounts& b) {
  return equal_counts(a, b);
}

Minkowski functionals(const PixelCounts& counts) {
  const PixelCounts& c = counts;
  const auto mean = [&](auto count) { return per_pixel(c.pixels, c.F.size(), count); };
  Minkowski result;
  result.A = mean([&](std::size_t j) { return c.F[j]; });
  result.L = mean([&](std::size_t j) { return c.B_int[j]; });
  result.L_crofton = mean([&](std::size_t j) {
    const double diagonal = static_cast<double>(c.D_int[j]) / std::numbers::sqrt2;
    return std::numbers::pi / 8.0 * (static_cast<double>(c.B_int[j]) + diagonal);
  });
  result.chi = mean([&](std::size_t j) { return c.V[j] - c.E[j] + c.F[j]; });
  result.chi4 = mean([&](std::size_t j) { return c.E[j] - 3 * c.F[j] + c.V4[j]; });
  return result;
}

Minkowski3 functionals(const VoxelCounts& counts) {
  const VoxelCounts& c = counts;
  const auto mean = [&](auto count) { return per_pixel(c.pixels, c.C.size(), count); };
  Minkowski3 result;
  result.V = mean([&](std::size_t j) { return c.C[j]; });
  result.S = mean([&](std::size_t j) { return c.S_int[j]; });
  result.S_crofton =
      mean([&](std::size_t j) { return 2.0 / 3.0 * static_cast<double>(c.S_int[j]); });
  result.M = mean([&](std::size_t j) { return 3 * c.C[j] - 2 * c.F[j] + c.E[j]; });
  result.chi = mean([&](std::size_t j) { return c.F[j] - c.C[j] - c.E[j] + c.V[j]; });
  result.chi6 = mean([&](std::size_t j) { return c.F[j] - 5 * c.C[j] + c.E4[j] - c.V8[j]; });
  return result;
}

}  // namespace poreshock
