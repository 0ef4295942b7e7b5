#include "overlapping.hpp"

#include <algorithm>
#include <cmath>

#include "poreshock/core/error.hpp"
#include "random.hpp"
#include "text.hpp"

namespace poreshock {
namespace {

constexpr double truncation = 2.5;  // standard deviations of ln(radius)

/// The random numbers of a Boolean sample; its voids are a smooth function of `scale`.
struct Draw {
  Packing packing;  // radii as drawn
  std::vector<Void> voids(std::size_t count, double scale) const {
    Packing scaled = packing;
    scaled.voids.resize(count);
    for (std::size_t i = 0; i < count; ++i) {
      scaled.voids[i].radius *= scale;
      scaled.voids[i].center = random_centre(scaled, i, 0);
    }
    return scaled.voids;
  }
};

Draw draw(const Sample& sample, const Block& block, std::size_t count) {
  Draw result;
  result.packing.block = block;
  result.packing.keep_out = sample.keep_out;
  result.packing.seed = sample.seed;
  for (const double radius : draw_radii(sample, count)) {
    result.packing.voids.push_back({.center = {}, .radius = radius});
  }
  return result;
}

double fraction(const Draw& drawn, std::size_t count, double scale) {
  return void_fraction(drawn.voids(count, scale), drawn.packing.block);
}

[[noreturn]] void throw_no_room(const Sample& sample, std::size_t count, double reached) {
  throw InputError(
      "sample.porosity = " + significant<4>(sample.porosity) +
      " cannot be reached with overlapping voids: " + std::to_string(count) + " voids of radius " +
      length_text(sample.void_radius) + " fill " + significant<4>(reached) +
      " of the block, because sample.keep_out = " + length_text(sample.keep_out) +
      " and the whole radius keep them away from its sides. Allowed is less. Lower "
      "sample.porosity, sample.keep_out or sample.void_radius, or raise sample.height.");
}

/// Number of voids whose union comes near the target. For a Boolean model -ln(1 - fraction) grows
/// in proportion to the number of voids, which makes the search short.
std::size_t find_count(const Sample& sample, const Block& block) {
  const double wanted = -std::log1p(-sample.porosity);
  const double each = ball_measure(sample.void_radius, block.dimension) / block_measure(block);
  std::size_t count =
      std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(wanted / each)));
  const std::size_t most = 30 * count + 100;
  for (int round = 0; round < 20; ++round) {
    const double reached = fraction(draw(sample, block, count), count, 1.0);
    const double next = static_cast<double>(count) * (wanted / -std::log1p(-reached));
    if (!(next < static_cast<double>(most))) throw_no_room(sample, count, reached);
    const std::size_t rounded =
        std::max<std::size_t>(1, static_cast<std::size_t>(std::llround(next)));
    const double change =
        std::fabs(static_cast<double>(rounded) / static_cast<double>(count) - 1.0);
    count = rounded;
    // The common factor on the radii does what is left.
    if (change < 2e-3) break;
  }
  return count;
}

/// Largest factor at which the largest void still fits into the block.
double largest_scale(const Draw& drawn, double keep_out) {
  double radius = 0.0;
  for (const Void& v : drawn.packing.voids) radius = std::max(radius, v.radius);
  double room = INFINITY;
  for (int axis = 0; axis < drawn.packing.block.dimension; ++axis) {
    const bool periodic = drawn.packing.block.periodic[axis];
    room = std::min(room, drawn.packing.block.size[axis] - (periodic ? 0.0 : 2.0 * keep_out));
  }
  return room / (2.0 * radius);
}

/// Factors around 1 at which the fraction is below and above the target, and by how much.
struct Bracket {
  double low = 1.0, high = 1.0;
  double miss_low = 0.0, miss_high = 0.0;
};

Bracket find_bracket(const Draw& drawn, const Sample& sample) {
  const std::size_t count = drawn.packing.voids.size();
  const auto miss = [&](double s) { return fraction(drawn, count, s) - sample.porosity; };
  // Radii far from those asked for would be another sample.
  const double limit = std::min(1.5, largest_scale(drawn, sample.keep_out));
  Bracket b;
  b.miss_low = b.miss_high = miss(1.0);
  for (double step = 0.01; b.miss_low > 0.0; step *= 2.0) {
    b.low = 1.0 / (1.0 + step);
    b.miss_low = miss(b.low);
  }
  for (double step = 0.01; b.miss_high < 0.0; step *= 2.0) {
    if (b.high >= limit) throw_no_room(sample, count, b.miss_high + sample.porosity);
    b.high = std::min(1.0 + step, limit);
    b.miss_high = miss(b.high);
  }
  return b;
}

/// Root of fraction - target by false position with the Illinois weights, which cannot lose it.
double find_scale(const Draw& drawn, const Sample& sample) {
  const double enough = drawn.packing.block.dimension == 2 ? 1e-13 : 1e-6;
  Bracket b = find_bracket(drawn, sample);
  double best = -b.miss_low < b.miss_high ? b.low : b.high;
  double least = std::min(-b.miss_low, b.miss_high);
  for (int round = 0; round < 100 && least > enough; ++round) {
    const double s = (b.low * b.miss_high - b.high * b.miss_low) / (b.miss_high - b.miss_low);
    if (!(s > b.low && s < b.high)) break;
    const double here = fraction(drawn, drawn.packing.voids.size(), s) - sample.porosity;
    // An end that stays for the second time counts half, so that it moves at last.
    if (here < 0.0) {
      if (best == b.low) b.miss_high *= 0.5;
      b.low = s;
      b.miss_low = here;
    } else {
      if (best == b.high) b.miss_low *= 0.5;
      b.high = s;
      b.miss_high = here;
    }
    best = s;
    least = std::fabs(here);
  }
  return best;
}

}  // namespace

std::vector<double> draw_radii(const Sample& sample, std::size_t count) {
  std::vector<double> radii(count, sample.void_radius);
  if (sample.void_spread <= 0.0) return radii;
  for (std::size_t i = 0; i < count; ++i) {
    const double z = truncated_normal(sample.seed, RandomStream::radius, i, truncation);
    radii[i] *= std::exp(sample.void_spread * z);
  }
  return radii;
}

std::vector<Void> place_overlapping(const Sample& sample, const Block& block) {
  const Draw drawn = draw(sample, block, find_count(sample, block));
  const double scale = find_scale(drawn, sample);
  return drawn.voids(drawn.packing.voids.size(), scale);
}

}  // namespace poreshock
