#include "poreshock/run/trace.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace poreshock {

namespace {

constexpr double least_fall = 0.05, rebound = 0.1, top = 0.95, arrived = 0.4;

struct Sample {
  double time, change;
};

/// Changes since the first sample, the largest one positive.
std::vector<Sample> changes(std::span<const double> time, std::span<const double> velocity) {
  std::vector<Sample> samples;
  double largest = 0.0, first = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < time.size(); ++k) {
    if (std::isnan(velocity[k])) continue;
    if (samples.empty()) first = velocity[k];
    const double change = velocity[k] - first;
    samples.push_back({time[k], change});
    largest = std::abs(change) > std::abs(largest) ? change : largest;
  }
  if (largest < 0.0) {
    for (Sample& s : samples) s.change = -s.change;
  }
  return samples;
}

/// Least sample of the first pull-back; the end where there is none.
std::size_t first_pull_back(const std::vector<Sample>& samples, double largest) {
  std::size_t greatest = 0, least = 0;
  for (std::size_t k = 0; k < samples.size(); ++k) {
    const double u = samples[k].change;
    if (u > samples[greatest].change) greatest = least = k;
    if (u < samples[least].change) least = k;
    const double fall = samples[greatest].change - samples[least].change;
    if (fall >= least_fall * largest && u - samples[least].change >= rebound * fall) return least;
  }
  return samples.size();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

double crossing(const std::vector<Sample>& samples, double level) {
  for (std::size_t k = 1; k < samples.size(); ++k) {
    const Sample &a = samples[k - 1], &b = samples[k];
    if (b.change < level) continue;
    return a.time + (level - a.change) / (b.change - a.change) * (b.time - a.time);
  }
  return std::numeric_limits<double>::quiet_NaN();
}

}  // namespace

TraceFigures read_figures(std::span<const double> time, std::span<const double> velocity,
                          double impedance) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  TraceFigures figures{none, none, none, none, none};
  const std::vector<Sample> samples = changes(time, velocity);
  double largest = 0.0;
  for (const Sample& s : samples) largest = std::max(largest, s.change);
  if (!(largest > 0.0)) return figures;
  const std::size_t least = first_pull_back(samples, largest);
  double greatest = 0.0;
  for (std::size_t k = 0; k < std::min(least, samples.size()); ++k) {
    greatest = std::max(greatest, samples[k].change);
  }
  std::vector<double> plateau;
  for (std::size_t k = 0; k < std::min(least, samples.size()); ++k) {
    if (samples[k].change >= top * greatest) plateau.push_back(samples[k].change);
  }
  figures.jump_off = median(std::move(plateau));
  figures.arrival = crossing(samples, arrived * figures.jump_off);
  if (least == samples.size()) return figures;
  figures.pull_back = figures.jump_off - samples[least].change;
  figures.pull_back_time = samples[least].time;
  figures.spall_strength = 0.5 * impedance * figures.pull_back;
  return figures;
}

}  // namespace poreshock
