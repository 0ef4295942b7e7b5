// Material behind a free side: its stress.
#include <gtest/gtest.h>

#include <cmath>

#include "poreshock/physics/transmit.hpp"
#include "support/aluminium.hpp"

namespace poreshock {
namespace {

TEST(Transmit, StressOfTheHalfSpace) {
  const MaterialParameters p = reference::aluminium();
  const Backing b = make_backing(p);
  const double shear = p.young / (2.0 * 1.33);
  const double longitudinal = std::sqrt(p.c0 * p.c0 + 4.0 / 3.0 * shear / p.density);
  // Slow: rho c_l; fast: the Hugoniot and two thirds of the yield stress; out of it: acoustic.
  EXPECT_NEAR(backing_stress(b, 1e-3) / (p.density * longitudinal * 1e-3), 1.0, 1e-6);
  EXPECT_NEAR(backing_stress(b, -1e-3) / (p.density * longitudinal * -1e-3), 1.0, 1e-6);
  EXPECT_DOUBLE_EQ(backing_stress(b, 1000.0),
                   p.density * 1000.0 * (p.c0 + p.lambda * 1000.0) + 80e6);
  EXPECT_DOUBLE_EQ(backing_stress(b, -1000.0), -p.density * 1000.0 * p.c0 - 80e6);
}

}  // namespace
}  // namespace poreshock
