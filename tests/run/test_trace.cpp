// What is read from a velocity trace: traces whose figures are known.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "poreshock/run/trace.hpp"

namespace poreshock::test {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

/// Linear between (time, velocity) corners, a sample every unit of time.
TraceFigures figures_of(const std::vector<std::array<double, 2>>& corners, double impedance) {
  std::vector<double> time, velocity;
  for (std::size_t k = 1; k < corners.size(); ++k) {
    const auto &a = corners[k - 1], &b = corners[k];
    for (double t = a[0]; t < b[0]; t += 1.0) {
      time.push_back(t);
      velocity.push_back(a[1] + (b[1] - a[1]) * (t - a[0]) / (b[0] - a[0]));
    }
  }
  time.push_back(corners.back()[0]);
  velocity.push_back(corners.back()[1]);
  return read_figures(time, velocity, impedance);
}

TEST(Trace, PlateauPullBackAndRebound) {
  const TraceFigures f = figures_of(
      {{0, -100}, {10, -100}, {20, 900}, {60, 900}, {80, 700}, {90, 850}, {120, 850}}, 14.0);
  EXPECT_DOUBLE_EQ(f.arrival, 14.0);
  EXPECT_DOUBLE_EQ(f.jump_off, 1000.0);
  EXPECT_DOUBLE_EQ(f.pull_back, 200.0);
  EXPECT_DOUBLE_EQ(f.pull_back_time, 80.0);
  EXPECT_DOUBLE_EQ(f.spall_strength, 1400.0);
}

TEST(Trace, DownwardsIsTheSame) {
  const TraceFigures f =
      figures_of({{0, 0}, {10, -1000}, {60, -1000}, {80, -800}, {90, -950}}, 2.0);
  EXPECT_DOUBLE_EQ(f.jump_off, 1000.0);
  EXPECT_DOUBLE_EQ(f.pull_back, 200.0);
  EXPECT_DOUBLE_EQ(f.arrival, 4.0);
}

TEST(Trace, ALaterHigherStepIsNotTheJump) {
  // The spalled layer rings: what comes after the pull-back may be faster.
  const TraceFigures f =
      figures_of({{0, 0}, {10, 1000}, {50, 1000}, {60, 800}, {70, 1200}, {90, 1200}}, 2.0);
  EXPECT_DOUBLE_EQ(f.jump_off, 1000.0);
  EXPECT_DOUBLE_EQ(f.pull_back, 200.0);
}

TEST(Trace, RingingBelowATwentiethIsNoPullBack) {
  const TraceFigures f =
      figures_of({{0, 0}, {10, 1020}, {20, 980}, {30, 1010}, {40, 990}, {80, 1000}}, 2.0);
  EXPECT_NEAR(f.jump_off, 1000.0, 5.0);
  EXPECT_TRUE(std::isnan(f.pull_back));
  EXPECT_TRUE(std::isnan(f.spall_strength));
}

TEST(Trace, AFallWithoutAReboundIsNoPullBack) {
  const TraceFigures f = figures_of({{0, 0}, {10, 1000}, {50, 1000}, {90, 0}}, 2.0);
  EXPECT_DOUBLE_EQ(f.jump_off, 1000.0);
  EXPECT_TRUE(std::isnan(f.pull_back));
}

TEST(Trace, NothingMoves) {
  EXPECT_TRUE(std::isnan(figures_of({{0, 5}, {10, 5}}, 1.0).jump_off));
  EXPECT_TRUE(std::isnan(read_figures({}, {}, 1.0).arrival));
}

TEST(Trace, SamplesWithoutMaterialAreLeftOut) {
  const std::vector<double> time = {0, 1, 2, 3, 4}, velocity = {none, 2, none, 6, 6};
  const TraceFigures f = read_figures(time, velocity, none);
  EXPECT_DOUBLE_EQ(f.jump_off, 4.0);
  EXPECT_DOUBLE_EQ(f.arrival, 1.8);
}

}  // namespace
}  // namespace poreshock::test
