// The time to go against what really followed.
#include <gtest/gtest.h>

#include <cmath>

#include "poreshock/run/time_to_go.hpp"

namespace poreshock::test {
namespace {

TEST(WorkAhead, GrowsEvenlyToThatOfAllParticlesThenStays) {
  EXPECT_DOUBLE_EQ(work_ahead({10.0, 0.0, 50.0}, 3.0), 30.0);
  EXPECT_DOUBLE_EQ(work_ahead({10.0, 2.0, 50.0}, 3.0), 3.0 * 13.0);
  EXPECT_DOUBLE_EQ(work_ahead({10.0, 2.0, 50.0}, 30.0), 20.0 * 30.0 + 10.0 * 50.0);
  EXPECT_DOUBLE_EQ(work_ahead({50.0, 2.0, 50.0}, 4.0), 200.0);
  EXPECT_DOUBLE_EQ(work_ahead({20.0, -1.0, 50.0}, 4.0), 80.0);
}

// Rows of input/paper/fig1_coarse.toml on one core, in seconds of processor time: after a tenth of
// the run what is left is right within 10 %. The steps are shorter than later on just then.
TEST(TimeToGo, OfThePapersFirstCase) {
  const RunSoFar rows[] = {
      {27.19e-9, 100, 2.49, 0.255, 18458800, 16696165},
      {44.85e-9, 180, 5.06, 0.353, 33225840, 29263992},
      {58.68e-9, 240, 7.43, 0.550, 44301120, 38363421},
      {71.09e-9, 300, 9.86, 0.631, 55376400, 47159677},
      {83.73e-9, 360, 12.4, 0.684, 66451680, 55703669},
      {96.09e-9, 420, 15.3, 0.774, 77526960, 64032578},
      {104.3e-9, 460, 17.4, 0.901, 84910480, 69454940},
      {112.5e-9, 500, 19.5, 0.953, 92294000, 74784685},
  };
  TimeToGo estimate{.asleep = 0.07};
  double to_go = 0.0;
  for (const RunSoFar& row : rows) to_go = seconds_to_go(row, 1100e-9, estimate);
  EXPECT_NEAR(to_go, 579.1 - 19.5, 0.1 * (579.1 - 19.5));
}

/// A run whose wave reaches all particles at 60 % of its time, with a record every 50 ns.
RunSoFar made_up(std::int64_t steps, double seconds_per_record) {
  constexpr double particles = 1e5, seconds_per_particle = 1e-6;
  RunSoFar run;
  for (run.step = 0; run.step < steps; ++run.step) {
    // Steps of 0.2 to 0.3 ns.
    run.time += (0.25 + 0.05 * std::sin(0.3 * static_cast<double>(run.step))) * 1e-9;
    const double awake = std::fmin(1.0, 0.05 + run.time / 632e-9);
    run.particle_steps += particles;
    run.sleeping_steps += particles * (1.0 - awake);
    run.wall += seconds_per_particle * particles * (awake + 0.07 * (1.0 - awake));
    const double recorded = seconds_per_record * (1.0 + std::floor(run.time / 50e-9));
    run.wall += recorded - run.recorded;
    run.recorded = recorded;
  }
  return run;
}

// Records cost as much early in the run as late, while steps cost a tenth at its start.
TEST(TimeToGo, DoesNotMistakeRecordsForSteps) {
  for (const double seconds_per_record : {0.0, 1.0, 10.0}) {
    const RunSoFar whole = made_up(4000, seconds_per_record);
    TimeToGo estimate{.asleep = 0.07};
    for (std::int64_t step = 50; step < 4000; step += 50) {
      const RunSoFar now = made_up(step, seconds_per_record);
      const double to_go = seconds_to_go(now, whole.time, estimate);
      const double left = whole.wall - now.wall;
      // The last records are few.
      if (step >= 400 && step <= 3600) {
        EXPECT_NEAR(to_go, left, 0.2 * left) << step;
      }
    }
  }
}

TEST(TimeToGo, IsNothingBeforeTheFirstStep) {
  TimeToGo estimate{.asleep = 0.07};
  EXPECT_EQ(seconds_to_go({}, 1e-6, estimate), 0.0);
}

}  // namespace
}  // namespace poreshock::test
