// Material behind a free side: its stress.
#include <gtest/gtest.h>

#include <cmath>

#include "poreshock/physics/transmit.hpp"
#include "support/aluminium.hpp"
#include "support/reference_shock.hpp"

namespace poreshock {
namespace {

TEST(Transmit, StressOfTheHalfSpace) {
  const MaterialParameters p = reference::aluminium();
  const Backing b = make_backing(p);
  const double shear = p.young / (2.0 * 1.33);
  const double longitudinal = std::sqrt(p.c0 * p.c0 + 4.0 / 3.0 * shear / p.density);
  const double limit = longitudinal * p.yield / (2.0 * shear);
  const double added = p.density * (longitudinal - p.c0) * limit;
  // Slow: rho c_l. Fast: the Hugoniot, and what the elastic precursor adds to it.
  EXPECT_NEAR(backing_stress(b, 1e-3) / (p.density * longitudinal * 1e-3), 1.0, 1e-6);
  EXPECT_NEAR(backing_stress(b, -1e-3) / (p.density * longitudinal * -1e-3), 1.0, 1e-6);
  EXPECT_DOUBLE_EQ(backing_stress(b, 1000.0),
                   p.density * 1000.0 * (p.c0 + p.lambda * 1000.0) + added);
  EXPECT_DOUBLE_EQ(backing_stress(b, -1000.0), -p.density * 1000.0 * p.c0 - added);
  // At the elastic limit it is that of the precursor.
  EXPECT_NEAR(backing_stress(b, limit) / (p.density * longitudinal * limit), 1.0, 0.01);
}

TEST(Transmit, StressWithinAFront) {
  // A steady front of a fluid bears rho Us w; the equation of state bears what belongs to w/Us.
  MaterialParameters p = reference::aluminium();
  p.young = p.yield = p.hardening = 0.0;
  const Backing b = make_backing(p);
  for (const double behind : {100.0, 500.0, 1500.0}) {
    const double speed = p.c0 + p.lambda * behind;
    for (const double w : {0.5 * behind, 0.7 * behind, behind}) {
      const double eta = w / speed, f = 1.0 - p.lambda * eta;
      const double all = p.density * speed * w, missing = all - backing_stress(b, w);
      const double viscous = all - p.density * p.c0 * p.c0 * eta / (f * f);
      EXPECT_NEAR(front_stress(b, w, viscous), missing, 0.2 * missing + 1e-9 * all) << behind;
    }
  }
  // The viscosity of a slow wave only spreads it, and what stretches has none.
  EXPECT_DOUBLE_EQ(front_stress(b, 1.0, 1e9), p.density * p.lambda);
  EXPECT_EQ(front_stress(b, -1.0, 1e9), 0.0);
}

TEST(Transmit, StressBehindTwoWaves) {
  // Precursor and plastic front of a plate: momentum, mass and energy.
  const MaterialParameters p = reference::aluminium();
  for (const double velocity : {50.0, 100.0, 200.0, 500.0}) {
    const reference::State behind = reference::piston(reference::solid(p), velocity).shocked;
    EXPECT_NEAR(backing_stress(make_backing(p), velocity) / behind.stress, 1.0, 0.005) << velocity;
  }
}

}  // namespace
}  // namespace poreshock
