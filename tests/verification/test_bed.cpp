// A bed of packed discs behind a shock: where its heat is, and how it fills the space.
#include <gtest/gtest.h>

#include "poreshock/output/history.hpp"
#include "poreshock/run/profiles.hpp"
#include "support/aluminium.hpp"
#include "support/runs.hpp"
#include "verification/verify.hpp"

namespace poreshock::test {
namespace {

// Ten cells a disc and no friction, which leaves most to contact. No particle is cooled to pay for
// the space that others took: heat >= 0 is counted, and no guard of the temperature is met.
TEST(BedOfDiscs, HeatsByPlasticWorkAndFillsTheSpace) {
  const std::string text = std::string(R"(
[domain]
size = [0.4e-3, 0.6e-3]
cell = 6.25e-6
periodic = true
[boundary]
low = "wall"
high = "free"
[sample]
kind = "packed_grains"
height = 0.5e-3
porosity = 0.3
grain_radius = 30e-6
grain_spread = 0.2
seed = 1
[loading]
velocity = 1100
[contact]
friction = 0.0
[time]
end = 130e-9
)") + aluminium_text;
  Simulation<2> sim = start<2>(scene_of(text, {}), MPI_COMM_SELF);
  const HistoryRow before = stock(sim);
  advance_to(1000000, 0, sim);
  const HistoryRow after = stock(sim);
  EXPECT_NEAR(after.total, before.total, 1e-13 * before.kinetic);
  EXPECT_EQ(after.guards, 0);
  const double heat = after.plastic_work + after.viscous_heat + after.filter_heat +
                      after.step_heat + after.wall_heat + after.contact_heat;
  verify_at_least("bed_of_discs", "plastic_work", after.plastic_work / heat, 0.22);
  verify_at_most("bed_of_discs", "numerical", numerical_share(after), 0.38);
  std::int64_t floored = 0;
  const Profile profile = measure_profile(sim, floored);
  double solid = 0.0;
  int rows = 0;
  for (std::size_t j = 0; j < profile.height.size(); ++j) {
    if (profile.height[j] < 30e-6 || profile.height[j] > 160e-6) continue;
    solid += profile.solid_fraction[j];
    ++rows;
  }
  verify_at_most("bed_of_discs", "overfilled", solid / rows - 1.0, 0.001);
  verify_at_most("bed_of_discs", "gaps", 1.0 - solid / rows, 0.01);
}

}  // namespace
}  // namespace poreshock::test
