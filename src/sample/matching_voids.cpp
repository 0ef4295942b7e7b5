#include <algorithm>
#include <cmath>

#include "overlapping.hpp"
#include "poreshock/core/error.hpp"
#include "text.hpp"

namespace poreshock {
namespace {

[[noreturn]] void throw_too_few(const Sample& sample, const Block& block) {
  const double each = ball_measure(sample.void_radius, block.dimension);
  throw InputError("sample.porosity = " + significant<4>(sample.porosity) +
                   " asks for less than half a void: one void of radius " +
                   length_text(sample.void_radius) + " makes " +
                   significant<4>(each / block_measure(block)) +
                   " of the block. Lower sample.void_radius, raise sample.porosity, or place the "
                   "void with [[void]].");
}

/// Number of the first `radii` whose measures sum up to nearest the target.
std::size_t nearest_count(const std::vector<double>& radii, double target, int dimension) {
  double sum = 0.0;
  std::size_t count = 0;
  while (count < radii.size()) {
    const double next = ball_measure(radii[count], dimension);
    if (sum + 0.5 * next > target) break;
    sum += next;
    ++count;
  }
  return count;
}

}  // namespace

std::vector<Void> matching_voids(const Sample& sample, const Block& block) {
  const double target = sample.porosity * block_measure(block);
  const double expected = target / ball_measure(sample.void_radius, block.dimension);
  // No radius is smaller than exp(-2.5 spread) times the median: so many are enough.
  const double most = expected * std::exp(2.5 * sample.void_spread * block.dimension) + 1.0;
  const std::vector<double> radii = draw_radii(sample, static_cast<std::size_t>(most));
  const std::size_t count = nearest_count(radii, target, block.dimension);
  if (count == 0) throw_too_few(sample, block);
  std::vector<Void> voids;
  for (std::size_t i = 0; i < count; ++i) voids.push_back({.center = {}, .radius = radii[i]});
  const double ratio = target / summed_measure(voids, block.dimension);
  const double factor = block.dimension == 2 ? std::sqrt(ratio) : std::cbrt(ratio);
  for (Void& v : voids) v.radius *= factor;
  // Large voids are placed first: they would find no place between small ones.
  std::stable_sort(voids.begin(), voids.end(),
                   [](const Void& a, const Void& b) { return a.radius > b.radius; });
  return voids;
}

}  // namespace poreshock
