// Predicted seconds per row, how they are measured, and when cutting the slabs anew pays.
#include "poreshock/solver/row_cost.hpp"

#include <gtest/gtest.h>

#include "poreshock/core/parallel.hpp"
#include "poreshock/grid/partition.hpp"

namespace poreshock {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;
constexpr auto particle = static_cast<std::size_t>(Work::particle);
constexpr auto contact_node = static_cast<std::size_t>(Work::contact_node);
constexpr auto recorded = static_cast<std::size_t>(Work::recorded_particle);

TEST(RowCost, AddsWhatEveryKindOfWorkCosts) {
  PerWork<double> unit{};
  unit[particle] = 2.0;
  unit[contact_node] = 5.0;
  unit[recorded] = 0.25;
  const std::vector<double> seconds =
      predicted_row_seconds({8, 8, 4, 0}, {0, 3, 0, 0}, {0, 2}, 0.07, unit);
  const double asleep = 2.0 * 0.07 + 0.25;
  EXPECT_EQ(seconds, (std::vector<double>{18.0, 33.0, 4.0 * asleep, 0.0}));
}

TEST(RowCost, CountsParticlesBeforeAnythingIsMeasured) {
  EXPECT_EQ(predicted_row_seconds({8, 100}, {}, {0, 1}, 0.07, {}),
            (std::vector<double>{8.0, 100.0 * 0.07}));
}

/// Slabs of equal particles, where a third also has contact: the cut moves towards it, to where
/// both sides take the same time.
TEST(RowCost, SlabsWithContactBecomeNarrower) {
  PerWork<double> unit{};
  unit[particle] = 1.0;
  unit[contact_node] = 1.0;
  std::vector<std::int64_t> particles(45, 10), contact(45, 0);
  for (std::size_t row = 0; row < 15; ++row) contact[row] = 10;
  const auto cut =
      partition_rows(predicted_row_seconds(particles, contact, {0, 45}, 0.01, unit), 2, {});
  EXPECT_EQ(cut, (std::vector<int>{0, 15, 45}));
}

/// Every unit takes 3 s; ranks with less to do wait for the busiest, inside their phases.
TEST(RowCost, WaitingIsNotWork) {
  PerWork<double> done{}, seconds{}, before{};
  done[particle] = 10.0 * (1 + rank(world));
  seconds[particle] = 30.0 * size(world);
  before[contact_node] = 7.0;
  const PerWork<double> unit = measured_unit_seconds(done, seconds, before, world);
  EXPECT_EQ(unit[particle], 3.0);
  EXPECT_EQ(unit[contact_node], 7.0);
  EXPECT_EQ(unit[recorded], 0.0);
}

TEST(RowCost, ASlabWithDearParticlesIsHeavier) {
  // Every rank did the same; the last took a quarter longer. A rank that did little counts as 1.
  const bool last = rank(world) == size(world) - 1;
  const PerWork<double> unit = {2e-8, 0.0, 0.0}, done = {1e6, 0.0, 0.0};
  const PerWork<double> seconds = {last ? 2.5e-2 : 2e-2, 0.0, 0.0};
  const auto factors = slab_factors(done, seconds, unit, world);
  ASSERT_EQ(std::ssize(factors), size(world));
  for (std::size_t r = 0; r + 1 < factors.size(); ++r) EXPECT_DOUBLE_EQ(factors[r], 1.0);
  EXPECT_DOUBLE_EQ(factors.back(), 1.25);
  for (const double x : slab_factors({}, {}, {}, world)) EXPECT_EQ(x, 1.0);
  if (size(world) > 1) {
    const PerWork<double> little = {last ? 1e5 : 1e6, 0.0, 0.0};
    EXPECT_EQ(slab_factors(little, seconds, unit, world).back(), 1.0);
  }
  const PerWork<double> slow = {1.0, 0.0, 0.0};
  for (const double x : slab_factors(done, slow, unit, world)) EXPECT_EQ(x, 1.5);
}

TEST(RowCost, ACutPaysOnceItsPriceIsLost) {
  WorkMeter meter;
  meter.cut_seconds = 2.0;
  EXPECT_FALSE(cutting_pays(1.01, 1.0, 100, meter));
  EXPECT_FALSE(cutting_pays(1.0, 1.0, 100, meter));  // nothing is lost, nothing forgotten
  EXPECT_NEAR(meter.lost, 1.0, 1e-12);
  EXPECT_TRUE(cutting_pays(1.02, 1.0, 100, meter));
  EXPECT_FALSE(cutting_pays(1.0, 1.0, 100, meter));  // there is no better cut
}

}  // namespace
}  // namespace poreshock
