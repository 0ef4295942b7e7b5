// Grains without friction behind a shock: how they fill the space, and where their heat is.
#include <gtest/gtest.h>

#include <cmath>

#include "poreshock/output/history.hpp"
#include "poreshock/run/profiles.hpp"
#include "support/aluminium.hpp"
#include "support/runs.hpp"
#include "verification/verify.hpp"

namespace poreshock::test {
namespace {

/// Grains of ten cells that hit a wall at 1100 m/s; `sample`: kind, height and porosity.
Simulation<2> grains(const std::string& size, const std::string& sample, const std::string& end) {
  const std::string text = "[domain]\nsize = " + size + "\n[sample]\n" + sample + R"(
grain_radius = 30e-6
seed = 1
[boundary]
low = "wall"
high = "free"
[loading]
velocity = 1100
[contact]
friction = 0.0
[time]
end = )" + end + "\n" + aluminium_text;
  return start<2>(scene_of(text, {"domain.cell=6.25e-6", "domain.periodic=true"}), MPI_COMM_SELF);
}

/// Share of the space that is filled from 30 um above the wall to a height, m.
double filled_below(double height, const Simulation<2>& sim) {
  std::int64_t floored = 0;
  const Profile profile = measure_profile(sim, floored);
  double solid = 0.0;
  int rows = 0;
  for (std::size_t j = 0; j < profile.height.size(); ++j) {
    if (profile.height[j] < 30e-6 || profile.height[j] > height) continue;
    solid += profile.solid_fraction[j];
    ++rows;
  }
  return solid / rows;
}

// Dense Voronoi grains behind a shock of about 18 GPa do not creep into each other where three of
// them meet.
TEST(DenseGrains, FillSpaceOnceUnderPressure) {
  Simulation<2> sim =
      grains("[0.15e-3, 0.425e-3]", "kind = \"voronoi_grains\"\nheight = 0.4e-3\nporosity = 0.03",
             "60e-9");
  advance_to(1000000, 0, sim);
  verify_at_most("dense_grains", "overlap", std::abs(filled_below(200e-6, sim) - 1.0), 0.01);
}

TEST(BedOfDiscs, HeatsByPlasticWorkAndFillsTheSpace) {
  Simulation<2> sim = grains("[0.4e-3, 0.6e-3]",
                             "kind = \"packed_grains\"\nheight = 0.5e-3\nporosity = 0.3\n"
                             "grain_spread = 0.2",
                             "130e-9");
  const HistoryRow before = stock(sim);
  advance_to(1000000, 0, sim);
  const HistoryRow after = stock(sim);
  EXPECT_NEAR(after.total, before.total, 1e-13 * before.kinetic);
  EXPECT_EQ(after.guards, 0);
  const double heat = after.plastic_work + after.viscous_heat + after.filter_heat +
                      after.step_heat + after.wall_heat + after.contact_heat;
  verify_at_least("bed_of_discs", "plastic_work", after.plastic_work / heat, 0.22);
  verify_at_most("bed_of_discs", "numerical", numerical_share(after), 0.38);
  const double filled = filled_below(160e-6, sim);
  verify_at_most("bed_of_discs", "overfilled", filled - 1.0, 0.001);
  verify_at_most("bed_of_discs", "gaps", 1.0 - filled, 0.01);
}

}  // namespace
}  // namespace poreshock::test
