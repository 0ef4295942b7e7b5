// Structure and process similarity on paths whose distances have closed forms.

#include "poreshock/morphology/similarity.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "poreshock/core/error.hpp"

namespace {

using namespace poreshock;

/// A process whose functionals are functions of time and threshold.
using Functional = std::function<double(double time, double threshold)>;
Process make_process(std::vector<double> time, std::vector<double> threshold,
                     const std::vector<Functional>& functionals) {
  Process process{std::move(time), std::move(threshold), {}};
  for (const Functional& f : functionals) {
    std::vector<double>& values = process.functionals.emplace_back();
    for (const double t : process.time) {
      for (const double th : process.threshold) values.push_back(f(t, th));
    }
  }
  return process;
}

std::vector<double> times(int count, double step) {
  std::vector<double> result;
  for (int i = 0; i < count; ++i) result.push_back(i * step);
  return result;
}

TEST(Similarity, DistanceOfPatterns) {
  const std::vector<double> a = {0.5, 0.25, -0.125};
  const std::vector<double> b = {0.5 + 3.0, 0.25 - 4.0, -0.125 + 12.0};
  EXPECT_EQ(distance(a, b), 13.0);
  EXPECT_EQ(similarity(13.0), 1.0 / 13.0);
  EXPECT_EQ(distance(a, a), 0.0);
  EXPECT_TRUE(std::isinf(similarity(0.0)));
}

/// Two straight paths that part linearly: the trapezoidal rule is exact, on any times.
TEST(Similarity, StraightPathsThatPart) {
  const std::vector<double> one = {100.0};
  const auto at = [&](std::vector<double> t, double slope) {
    return path_at(make_process(std::move(t), one,
                                {[=](double s, double) { return 3.0 * slope * s; },
                                 [=](double s, double) { return 4.0 * slope * s; }}),
                   100.0);
  };
  const Path a = at({0.0, 1.0, 2.5, 4.0}, 1.0);
  const Path b = at({0.0, 0.5, 3.0, 4.0}, 2.0);
  EXPECT_DOUBLE_EQ(process_distance(a, b, {0.0, 4.0}), 5.0 * 2.0);
  EXPECT_DOUBLE_EQ(process_distance(a, b, {1.25, 3.5}), 5.0 * 2.375);
  EXPECT_EQ(process_distance(a, b, {0.0, 4.0}), process_distance(b, a, {0.0, 4.0}));
  EXPECT_EQ(process_distance(a, a, {0.25, 3.75}), 0.0);
  EXPECT_EQ(distances(a, b, {0.75, 3.0}).time, (std::vector<double>{0.75, 1.0, 2.5, 3.0}));
  EXPECT_THROW(process_distance(a, b, {0.0, 4.5}), InputError);
  EXPECT_THROW(process_distance(a, b, {2.0, 2.0}), InputError);
  EXPECT_THROW(process_distance(a, b, {-1.0, 2.0}), InputError);
}

/// Eq. 18 by the trapezoidal rule: d = t^2 on equal steps has the error h^2/6 of its mean.
TEST(Similarity, TrapezoidalRule) {
  for (const int count : {11, 21}) {
    const double step = 1.0 / (count - 1);
    const auto parabola = [](double t, double) { return t * t; };
    const auto zero = [](double, double) { return 0.0; };
    const Process a = make_process(times(count, step), {1.0}, {parabola});
    const Process b = make_process(times(count, step), {1.0}, {zero});
    EXPECT_NEAR(process_distance(path_at(a, 1.0), path_at(b, 1.0), {0.0, a.time.back()}),
                1.0 / 3.0 + step * step / 6.0, 1e-13);
  }
}

/// The same process with its thresholds stretched by 1.5: the match is the stretched threshold.
TEST(Similarity, MatchOfAStretchedProcess) {
  const auto process = [](double factor, double step) {
    std::vector<double> threshold;
    for (double th = 10.0; th <= 400.0; th += step) threshold.push_back(th);
    return make_process(times(21, 0.05), threshold,
                        {[=](double t, double th) { return t / (1.0 + th / (100.0 * factor)); },
                         [=](double t, double th) { return t * th / (factor * 1000.0); }});
  };
  const Process a = process(1.0, 10.0);
  const Process b = process(1.5, 10.0);
  const Window window = loading_window(a, b);
  EXPECT_EQ(window.begin, 0.0);
  EXPECT_EQ(window.end, a.time.back());
  // 100 maps to 150, which b has; 110 to 165, half-way between two of b.
  const Match stored = find_match(path_at(a, 100.0), b, window);
  EXPECT_NEAR(stored.best_threshold, 150.0, 1e-12);
  EXPECT_NEAR(stored.best_distance, 0.0, 1e-15);
  EXPECT_FALSE(stored.at_end);
  EXPECT_EQ(stored.distance.size(), b.threshold.size());
  const Match halfway = find_match(path_at(a, 110.0), b, window);
  EXPECT_NEAR(halfway.best_threshold, 165.0, 10.0 / 32.0);
  EXPECT_LT(halfway.best_distance,
            *std::min_element(halfway.distance.begin(), halfway.distance.end()));
  // 390 maps to 585, beyond what b measured.
  EXPECT_TRUE(find_match(path_at(a, 390.0), b, window).at_end);
  const Match itself = find_match(path_at(a, 100.0), a, window);
  EXPECT_EQ(itself.best_distance, 0.0);
  EXPECT_EQ(itself.best_threshold, 100.0);
  EXPECT_THROW(path_at(a, 5.0), InputError);
  EXPECT_THROW(path_at(a, 400.5), InputError);
}

/// Loading ends where the field is largest on the whole: a ramp up to t0 and down again.
TEST(Similarity, WindowEndsWithTheSlowerLoading) {
  const auto ramp = [](double top, int records) {
    return make_process(times(records, 1.0), {300.0, 400.0, 600.0}, {[=](double t, double th) {
                          const double level = t < top ? t : 2.0 * top - t;
                          return level / (20.0 * th / 300.0);
                        }});
  };
  EXPECT_EQ(end_of_loading(ramp(7.0, 20)), 7.0);
  EXPECT_EQ(end_of_loading(ramp(30.0, 20)), 19.0);
  // At quantiles the areas stay as they are, and the values show the loading.
  Process shares =
      make_process(times(20, 1.0), {0.25, 0.75}, {[](double, double p) { return 1 - p; }});
  for (int t = 0; t < 20; ++t) {
    const double level = t < 7 ? 300.0 + t : 307.0 - (t - 7);
    shares.level.insert(shares.level.end(), {level, level + 10.0});
  }
  EXPECT_EQ(end_of_loading(shares), 7.0);
  const Window window = loading_window(ramp(7.0, 20), ramp(11.0, 20));
  EXPECT_EQ(window.begin, 0.0);
  EXPECT_EQ(window.end, 11.0);
  EXPECT_EQ(loading_window(ramp(7.0, 10), ramp(11.0, 20)).end, 9.0);
  EXPECT_THROW(loading_window(ramp(0.0, 10), ramp(0.0, 10)), InputError);
}

/// One curved process at different record times: its distance is what interpolation makes of it.
TEST(Similarity, InterpolationBetweenRecords) {
  const auto at = [](std::vector<double> t, double slope) {
    return path_at(
        make_process(std::move(t), {100.0}, {[=](double s, double) { return s * s + slope * s; }}),
        100.0);
  };
  const Path fine = at(times(9, 1.0), 0.0);
  const Path coarse = at(times(5, 2.0), 0.0);
  // Half way between two records a parabola lies (2/2)^2 below its chord.
  EXPECT_DOUBLE_EQ(interpolation_distance(fine, coarse, {0.0, 8.0}), 0.5);
  for (const Window window : {Window{0.0, 8.0}, Window{1.0, 7.0}, Window{0.5, 7.25}}) {
    EXPECT_EQ(process_distance(fine, coarse, window), interpolation_distance(fine, coarse, window));
    EXPECT_EQ(interpolation_distance(fine, coarse, window),
              interpolation_distance(coarse, fine, window));
  }
  EXPECT_EQ(interpolation_distance(fine, at(times(9, 1.0), 3.0), {0.0, 8.0}), 0.0);
  // Neither has the times of the other, one ends earlier, one has a single gap.
  for (const Path& other : {at(times(6, 1.6), 0.0), at({0.0, 0.9, 2.2, 4.6, 4.7, 8.0}, 0.0),
                            at({0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 7.0, 8.0}, 0.0)}) {
    const double d = process_distance(fine, other, {0.0, 8.0});
    EXPECT_GT(d, 0.0);
    EXPECT_LE(d, interpolation_distance(fine, other, {0.0, 8.0}));
  }
  // What differs is found all the same.
  const Path parted = at(times(5, 2.0), 1.0);
  EXPECT_GT(process_distance(fine, parted, {0.0, 8.0}),
            5.0 * interpolation_distance(fine, parted, {0.0, 8.0}));
}

}  // namespace
