#include "poreshock/morphology/similarity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "poreshock/core/error.hpp"

namespace poreshock {
namespace {

/// Linear interpolation that gives the end points themselves at 0 and 1.
double between(double low, double high, double share) {
  return (1.0 - share) * low + share * high;
}

/// Interval of ascending numbers that contains a value, and the place in it.
struct Place {
  std::size_t low = 0;
  std::size_t high = 0;
  double share = 0.0;
};

Place find_place(std::span<const double> numbers, double value) {
  const auto above = std::upper_bound(numbers.begin(), numbers.end(), value);
  if (above == numbers.begin()) return {};
  const auto low = static_cast<std::size_t>(above - numbers.begin()) - 1;
  if (above == numbers.end()) return {low, low, 0.0};
  return {low, low + 1, (value - numbers[low]) / (numbers[low + 1] - numbers[low])};
}

std::vector<double> point_at(const Path& path, double time) {
  const Place place = find_place(path.time, time);
  std::vector<double> point = path.points[place.low];
  for (std::size_t k = 0; k < point.size(); ++k) {
    point[k] = between(point[k], path.points[place.high][k], place.share);
  }
  return point;
}

std::string seconds(double value) {
  return std::to_string(value * 1e9) + " ns";
}

void check_window(const Path& path, Window window) {
  if (window.begin < window.end && path.time.front() <= window.begin &&
      window.end <= path.time.back()) {
    return;
  }
  throw InputError("the time window from " + seconds(window.begin) + " to " + seconds(window.end) +
                   " is empty or leaves the records, which go from " + seconds(path.time.front()) +
                   " to " + seconds(path.time.back()));
}

/// Record times of both paths inside the window, and its ends.
std::vector<double> times_of_both(const Path& a, const Path& b, Window window) {
  std::vector<double> times = {window.begin, window.end};
  for (const Path* path : {&a, &b}) {
    for (const double time : path->time) {
      if (window.begin < time && time < window.end) times.push_back(time);
    }
  }
  std::sort(times.begin(), times.end());
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

/// The path as it would be if only these times and its own ends had been recorded.
Path thinned(const Path& path, std::span<const double> times) {
  Path result{{path.time.front()}, {path.points.front()}};
  for (const double time : times) {
    if (!(result.time.back() < time && time < path.time.back())) continue;
    result.time.push_back(time);
    result.points.push_back(point_at(path, time));
  }
  if (path.time.size() == 1) return result;
  result.time.push_back(path.time.back());
  result.points.push_back(path.points.back());
  return result;
}

/// Integral of the area fraction over the thresholds at one record.
double mean_above(const Process& process, std::size_t record) {
  const std::size_t count = process.threshold.size();
  const double* area = &process.functionals[0][record * count];
  const bool by_share = !process.level.empty();
  const double* at = by_share ? &process.level[record * count] : process.threshold.data();
  if (count == 1 && !by_share) return area[0];
  double integral = by_share ? at[0] * area[0] : 0.0;
  for (std::size_t k = 0; k + 1 < count; ++k) {
    integral += 0.5 * (area[k] + area[k + 1]) * (at[k + 1] - at[k]);
  }
  return integral;
}

}  // namespace

double distance(std::span<const double> a, std::span<const double> b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) sum += (b[k] - a[k]) * (b[k] - a[k]);
  return std::sqrt(sum);
}

double similarity(double distance) {
  return distance > 0.0 ? 1.0 / distance : std::numeric_limits<double>::infinity();
}

Path path_at(const Process& process, double threshold) {
  const std::vector<double>& all = process.threshold;
  if (!(all.front() <= threshold && threshold <= all.back())) {
    throw InputError("threshold " + std::to_string(threshold) +
                     " lies outside the measured ones, " + std::to_string(all.front()) + " to " +
                     std::to_string(all.back()));
  }
  const Place place = find_place(all, threshold);
  Path path;
  path.time = process.time;
  for (std::size_t t = 0; t < process.time.size(); ++t) {
    std::vector<double>& point = path.points.emplace_back();
    for (const std::vector<double>& values : process.functionals) {
      const double* row = &values[t * all.size()];
      point.push_back(between(row[place.low], row[place.high], place.share));
    }
  }
  return path;
}

double end_of_loading(const Process& process) {
  std::size_t best = 0;
  double most = mean_above(process, 0);
  for (std::size_t t = 1; t < process.time.size(); ++t) {
    const double mean = mean_above(process, t);
    if (!(mean > most)) continue;
    most = mean;
    best = t;
  }
  return process.time[best];
}

Window loading_window(const Process& a, const Process& b, Until until) {
  const double begin = std::max(a.time.front(), b.time.front());
  const double last = std::min(a.time.back(), b.time.back());
  const double loaded_a = end_of_loading(a);
  const double loaded_b = end_of_loading(b);
  const double loaded =
      until == Until::slower ? std::max(loaded_a, loaded_b) : std::min(loaded_a, loaded_b);
  const double end = std::min(last, loaded);
  if (begin < end) return {begin, end};
  throw InputError("the runs share no time span: records go from " + seconds(a.time.front()) +
                   " to " + seconds(a.time.back()) + " and from " + seconds(b.time.front()) +
                   " to " + seconds(b.time.back()) + "; loading ends at " + seconds(loaded));
}

Path distances(const Path& a, const Path& b, Window window) {
  check_window(a, window);
  check_window(b, window);
  Path result;
  result.time = times_of_both(a, b, window);
  for (const double time : result.time) {
    result.points.push_back({distance(point_at(a, time), point_at(b, time))});
  }
  return result;
}

double process_distance(const Path& a, const Path& b, Window window) {
  const Path d = distances(a, b, window);
  double integral = 0.0;
  for (std::size_t t = 0; t + 1 < d.time.size(); ++t) {
    integral += 0.5 * (d.points[t][0] + d.points[t + 1][0]) * (d.time[t + 1] - d.time[t]);
  }
  return integral / (window.end - window.begin);
}

double interpolation_distance(const Path& a, const Path& b, Window window) {
  return process_distance(a, thinned(a, b.time), window) +
         process_distance(b, thinned(b, a.time), window);
}

Match find_match(const Path& reference, const Process& process, Window window) {
  constexpr int steps = 32;
  Match match;
  for (const double threshold : process.threshold) {
    match.distance.push_back(process_distance(reference, path_at(process, threshold), window));
  }
  const auto least = std::min_element(match.distance.begin(), match.distance.end());
  const auto at = static_cast<std::size_t>(least - match.distance.begin());
  match.best_threshold = process.threshold[at];
  match.best_distance = *least;
  const std::size_t low = at == 0 ? 0 : at - 1;
  const std::size_t last = std::min(at + 1, process.threshold.size() - 1);
  for (std::size_t k = low; k < last; ++k) {
    for (int step = 1; step < steps; ++step) {
      const double threshold = between(process.threshold[k], process.threshold[k + 1],
                                       static_cast<double>(step) / steps);
      const double d = process_distance(reference, path_at(process, threshold), window);
      if (!(d < match.best_distance)) continue;
      match.best_distance = d;
      match.best_threshold = threshold;
    }
  }
  match.at_end = match.best_threshold == process.threshold.front() ||
                 match.best_threshold == process.threshold.back();
  return match;
}

}  // namespace poreshock
