// The temperature along the reference curve against its closed form and against quadrature, and the
// temperatures of the two thermal models.

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>

#include "poreshock/material/material.hpp"
#include "support/aluminium.hpp"
#include "support/reference_shock.hpp"

namespace {

using namespace poreshock;
using reference::aluminium;

/// T_r for gamma = 2 in closed form.
double closed_form(const MaterialParameters& p, double eta) {
  const double l = p.lambda, b = l - 1.0, u = 1.0 - l * eta;
  const std::array<double, 5> A = {b * b, 2 * b * (1 - b), (1 - b) * (1 - b) - 2 * b, -2 * (1 - b),
                                   1.0};
  const double integral = (A[0] * (1 / (u * u) - 1) / 2 + A[1] * (1 / u - 1) - A[2] * std::log(u) +
                           A[3] * (1 - u) + A[4] * (1 - u * u) / 2) /
                          std::pow(l, 5);
  return (p.T0 + l * p.c0 * p.c0 / p.cv * integral) / ((1 - eta) * (1 - eta));
}

TEST(Temperature, ReferenceCurveClosedForm) {
  const MaterialParameters p = aluminium();
  const Material m = make_material(p);
  for (double eta = 0.0007; eta < m.eos.guard; eta += 0.00131) {
    const double expected = closed_form(p, eta);
    EXPECT_NEAR(reference_temperature(m.temperature, eta), expected,
                std::max(1e-6, 1e-10 * expected))
        << eta;
  }
}

TEST(Temperature, ReferenceCurveByQuadrature) {
  MaterialParameters p = aluminium();
  p.gamma = 1.96;
  const Material m = make_material(p);
  for (double eta = 0.0007; eta < m.eos.guard; eta += 0.0131) {
    const double expected =
        reference::curve_temperature(reference::solid(p), (1.0 - eta) / p.density, 20000);
    EXPECT_NEAR(reference_temperature(m.temperature, eta), expected,
                std::max(1e-6, 1e-10 * expected))
        << eta;
  }
  // The two values of gamma in use at 1100 m/s: 540.6 and 537.4 K.
  const double eta = 1100.0 / 6824.0;
  EXPECT_NEAR(reference_temperature(m.temperature, eta), 537.4, 0.05);
  const Material two = make_material(aluminium());
  EXPECT_NEAR(reference_temperature(two.temperature, eta), 540.567, 5e-4);
}

TEST(Temperature, ReferenceCurveInExpansion) {
  for (const double gamma : {2.0, 1.96, 0.97}) {
    MaterialParameters p = aluminium();
    p.gamma = gamma;
    const Material m = make_material(p);
    for (double eta = -3.0; eta <= 0.0; eta += 0.00917) {
      EXPECT_NEAR(reference_temperature(m.temperature, eta), p.T0 * std::pow(1.0 - eta, -gamma),
                  1e-9)
          << eta;
    }
  }
}

// Beyond the guard the curve goes on with the entropy its own pressure and energy make:
// dT/deta = gamma T/(1 - eta) + (dE_r/deta - P_r V0)/cv; beyond the table it is its tangent.
TEST(Temperature, ReferenceCurveBeyondTheGuard) {
  const Material m = make_material(aluminium());
  const auto T = [&](double eta) { return reference_temperature(m.temperature, eta); };
  constexpr double h = 1e-5;
  for (double eta = m.eos.guard - 0.02; eta < 0.95 / 1.34 - 2 * h; eta += 0.00313) {
    const ReferencePoint r = reference_point(m.eos, eta);
    const double expected = m.eos.gamma * T(eta) / (1.0 - eta) +
                            (r.energy_slope - r.pressure / m.eos.density) / m.eos.cv;
    EXPECT_NEAR((T(eta + h) - T(eta - h)) / (2 * h), expected, 1e-6 * expected) << eta;
  }
  const double end = 0.95 / 1.34;
  const double slope = (T(end + 0.1) - T(end)) / 0.1;
  EXPECT_NEAR((T(end + 0.2) - T(end + 0.1)) / 0.1, slope, 1e-9 * slope);
  EXPECT_NEAR((T(end) - T(end - 1e-6)) / 1e-6, slope, 1e-4 * slope);
  EXPECT_TRUE(std::isnan(T(std::numeric_limits<double>::quiet_NaN())));
}

// On an isentrope T V^gamma is constant, from beyond the guard down into tension: pressure, energy
// and temperature of the reference curve belong together.
TEST(Temperature, IsentropeKeepsTVGamma) {
  MaterialParameters p = aluminium();
  p.gamma = 1.96;
  const Material m = make_material(p);
  ThermalState s;
  double v = (1.0 - 0.69) / p.density;
  double e = reference_point(m.eos, 0.69).energy + 4e6;
  const auto invariant = [&] {
    s.density = 1.0 / v;
    s.internal_energy = e;
    return temperature(m, Thermal::conserving, s) * std::pow(v * p.density, p.gamma);
  };
  const double start = invariant();
  const auto slope = [&](double x, double y) {
    return -conserving_state(m.eos, 1.0 / x, y).pressure;
  };
  constexpr int steps = 8000;
  const double h = (1.15 - 0.31) / p.density / steps;
  for (int i = 0; i < steps; ++i) {
    const double a = slope(v, e);
    const double b = slope(v + 0.5 * h, e + 0.5 * h * a);
    const double c = slope(v + 0.5 * h, e + 0.5 * h * b);
    const double d = slope(v + h, e + h * c);
    e += h / 6.0 * (a + 2.0 * (b + c) + d);
    v += h;
    if (i % 400 == 0) {
      EXPECT_NEAR(invariant(), start, 1e-7 * start) << v * p.density;
    }
  }
  EXPECT_NEAR(invariant(), start, 1e-7 * start);
}

TEST(Temperature, PaperModel) {
  const Material m = make_material(aluminium());
  const double eta = 1100.0 / 6824.0;
  ThermalState s;
  s.density = 2700.0 / (1.0 - eta);
  const double cold = temperature(m, Thermal::paper, s);
  EXPECT_NEAR(cold, 540.567, 5e-4);
  EXPECT_NEAR(cold, reference_temperature(m.temperature, eta), 1e-9);
  s.plastic_work = 23.0 * 880.0;
  EXPECT_NEAR(temperature(m, Thermal::paper, s), cold + 23.0, 1e-9);
  // Neither the energy nor what the deviator stores enters eqs 6 and 7.
  const double with_work = temperature(m, Thermal::paper, s);
  s.internal_energy = 1e6;
  s.deviator_square = 1e16;
  s.back_stress_square = 1e16;
  EXPECT_EQ(temperature(m, Thermal::paper, s), with_work);
  // Back at V0 without work the solid is at T0 again: the loss that eqs 4 to 7 have built in.
  s = {};
  s.density = 2700.0;
  EXPECT_NEAR(temperature(m, Thermal::paper, s), 300.0, 1e-9);
}

TEST(Temperature, ConservingModel) {
  MaterialParameters p = aluminium();
  p.kinematic_share = 0.25;
  const double density = 3000.0;
  ThermalState s;
  s.density = density;
  s.internal_energy = 4e5;
  const Material work = make_material(p);
  const double plain = temperature(work, Thermal::conserving, s);
  const double eta = 1.0 - 2700.0 / density;
  EXPECT_NEAR(plain,
              reference_temperature(work.temperature, eta) +
                  (4e5 - reference_point(work.eos, eta).energy) / 880.0,
              1e-9);
  // The elastic energy of the deviator is no heat.
  s.deviator_square = 2.0 / 3.0 * 1e8 * 1e8;
  const double shear = 69e9 / 2.66;
  const double stored = 1e8 * 1e8 / (6.0 * shear * density);
  EXPECT_NEAR(work.deviatoric_energy(s.deviator_square, density), stored, 1e-12 * stored);
  EXPECT_NEAR(temperature(work, Thermal::conserving, s), plain - stored / 880.0, 1e-9);
  // Neither is that of the back stress, where only the dissipation heats.
  s.back_stress_square = 3e14;
  EXPECT_NEAR(temperature(work, Thermal::conserving, s), plain - stored / 880.0, 1e-9);
  p.plastic_heat = PlasticHeat::dissipation;
  const Material dissipation = make_material(p);
  const double back = 3.0 * 3e14 / (4.0 * 0.25 * 384e6 * density);
  EXPECT_NEAR(temperature(dissipation, Thermal::conserving, s), plain - (stored + back) / 880.0,
              1e-9);
  // The plastic work is in the internal energy already.
  s.plastic_work = 1e5;
  EXPECT_NEAR(temperature(dissipation, Thermal::conserving, s), plain - (stored + back) / 880.0,
              1e-9);
}

TEST(Temperature, FluidStoresNothing) {
  MaterialParameters p = aluminium();
  p.young = p.yield = p.hardening = 0.0;
  p.plastic_heat = PlasticHeat::dissipation;
  const Material m = make_material(p);
  EXPECT_EQ(m.deviatoric_energy(0.0, 2700.0), 0.0);
  EXPECT_EQ(m.back_stress_energy(0.0, 2700.0), 0.0);
  // The sound speed is the bulk one.
  EXPECT_NEAR(longitudinal_sound_speed(make_material(p)), 5350.0, 1e-9);
}

TEST(Temperature, MaterialConstants) {
  MaterialParameters p = aluminium();
  p.kinematic_share = 0.25;
  const Material m = make_material(p);
  EXPECT_NEAR(m.strength.shear, 25.94e9, 5e6);
  EXPECT_EQ(m.strength.yield, 120e6);
  EXPECT_EQ(m.strength.isotropic, 288e6);
  EXPECT_EQ(m.strength.kinematic, 96e6);
  EXPECT_EQ(make_material(aluminium()).strength.kinematic, 0.0);
}

}  // namespace
