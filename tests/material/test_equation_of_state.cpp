// The equation of state against the exact states, its continuity, and its sound speed.

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <limits>

#include "poreshock/material/material.hpp"
#include "support/aluminium.hpp"
#include "support/reference_shock.hpp"

namespace {

using namespace poreshock;
using reference::aluminium;

MieGruneisen aluminium_eos() {
  const MaterialParameters p = aluminium();
  return make_mie_gruneisen(p.density, p.c0, p.lambda, p.gamma, p.cv, p.T0);
}

TEST(EquationOfState, HugoniotStates) {
  const MieGruneisen eos = aluminium_eos();
  for (const double up : {10.0, 300.0, 500.0, 700.0, 1100.0, 1500.0, 2000.0, 3000.0}) {
    const double us = eos.bulk / eos.density;
    const double front = std::sqrt(us) + eos.lambda * up;
    const double density = eos.density / (1.0 - up / front);
    const double expected = eos.density * front * up;
    const double energy = 0.5 * up * up;
    EXPECT_NEAR(conserving_state(eos, density, energy).pressure, expected, 1e-11 * expected) << up;
    const ReferencePoint r = reference_point(eos, up / front);
    EXPECT_NEAR(r.pressure, expected, 1e-11 * expected) << up;
    EXPECT_NEAR(r.energy, energy, 1e-11 * energy) << up;
  }
}

TEST(EquationOfState, SpotNumbers) {
  const MieGruneisen eos = aluminium_eos();
  EXPECT_EQ(eos.bulk, 2700.0 * 5350.0 * 5350.0);
  EXPECT_NEAR(conserving_state(eos, 3218.87, 605000.0).pressure, 20.2673e9, 3e5);
  EXPECT_NEAR(conserving_state(eos, 2700.0 / 1.01313, 605000.0).pressure, 2.1972e9, 5e5);
  const Material m = make_material(aluminium());
  EXPECT_NEAR(longitudinal_sound_speed(m), 6436.8, 0.05);
  EXPECT_EQ(m.eos.density, 2700.0);
  // Shocked at 1100 and 2000 m/s: 7622 and 8386 m/s.
  for (const auto& [up, expected] : {std::pair{1100.0, 7622.0}, std::pair{2000.0, 8386.0}}) {
    const reference::State s = reference::hugoniot(reference::solid(aluminium()), up);
    const double c2 = conserving_state(m.eos, s.density(), s.energy).sound_speed2;
    EXPECT_NEAR(std::sqrt(c2 + 4.0 / 3.0 * m.strength.shear * s.volume), expected, 0.5);
  }
}

TEST(EquationOfState, AgreesWithTheReferenceAtAnyVolumeAndEnergy) {
  for (const double gamma : {2.0, 1.96, 0.97}) {
    MaterialParameters p = aluminium();
    p.gamma = gamma;
    const reference::Solid m = reference::solid(p);
    const MieGruneisen eos = make_mie_gruneisen(p.density, p.c0, p.lambda, p.gamma, p.cv, p.T0);
    for (double x = 0.56; x < 1.6; x += 0.0103) {
      for (const double e : {-2e5, 0.0, 6.05e5, 4.5e6}) {
        const double v = x / p.density;
        const double expected = reference::pressure(m, v, e);
        const EquationOfState s = conserving_state(eos, 1.0 / v, e);
        EXPECT_NEAR(s.pressure, expected, 1e-12 * (std::abs(expected) + eos.bulk)) << x << ' ' << e;
        const double c2 = -v * v * reference::pressure_slope(m, v, e, -expected);
        EXPECT_NEAR(s.sound_speed2, c2, 1e-11 * (std::abs(c2) + p.c0 * p.c0)) << x << ' ' << e;
      }
    }
  }
}

// Two shocks and elastic-plastic states found without the program's code give the same pressure
// and, with the elastic energy of the deviator added, the same temperature.
TEST(EquationOfState, ElasticPlasticShockStates) {
  const MaterialParameters p = aluminium();
  const Material m = make_material(p);
  for (const double up : {100.0, 300.0, 700.0, 900.0, 1100.0, 2000.0}) {
    const reference::State s = reference::piston(reference::solid(p), up).shocked;
    EXPECT_NEAR(conserving_state(m.eos, s.density(), s.energy).pressure, s.pressure,
                1e-11 * s.pressure);
    ThermalState state;
    state.density = s.density();
    state.deviator_square = 2.0 / 3.0 * s.flow_stress * s.flow_stress;
    state.internal_energy =
        s.energy + s.volume * s.flow_stress * s.flow_stress / (6.0 * m.strength.shear);
    EXPECT_NEAR(temperature(m, Thermal::conserving, state), s.temperature, 1e-6) << up;
  }
}

TEST(EquationOfState, SmoothAtTheUndisturbedVolume) {
  const MieGruneisen eos = aluminium_eos();
  const ReferencePoint at = reference_point(eos, 0.0);
  EXPECT_EQ(at.pressure, 0.0);
  EXPECT_EQ(at.energy, 0.0);
  EXPECT_EQ(at.energy_slope, 0.0);
  EXPECT_EQ(at.pressure_slope, eos.bulk);
  for (const double eta : {1e-12, -1e-12}) {
    const ReferencePoint r = reference_point(eos, eta);
    EXPECT_NEAR(r.pressure_slope, eos.bulk, 1e-11 * eos.bulk);
    EXPECT_NEAR(r.pressure / eta, eos.bulk, 1e-11 * eos.bulk);
    EXPECT_NEAR(r.energy_slope / (eta * eos.bulk / eos.density), 1.0, 1e-11);
  }
  for (const double energy : {0.0, 3e5}) {
    const auto above = conserving_state(eos, eos.density * (1.0 + 1e-12), energy);
    const auto below = conserving_state(eos, eos.density * (1.0 - 1e-12), energy);
    EXPECT_NEAR(above.sound_speed2, below.sound_speed2, 1e-10 * above.sound_speed2);
  }
}

// With the other sign of the expansion branch an expanded solid would push itself apart.
TEST(EquationOfState, TensionPullsAndIsStable) {
  const MieGruneisen eos = aluminium_eos();
  double before = 0.0;
  for (int i = 1; i <= 100; ++i) {
    const double x = 1.0 + 0.01 * i;
    const double density = eos.density / x;
    // The linear law, exactly: along the cold curve E is E_r.
    const ReferencePoint r = reference_point(eos, 1.0 - x);
    const EquationOfState s = conserving_state(eos, density, r.energy);
    EXPECT_NEAR(s.pressure, eos.bulk * (1.0 - x), 1e-12 * eos.bulk);
    EXPECT_LT(s.pressure, before);
    // c^2 = V^2 rho0 K0: the curve is an isentrope.
    EXPECT_NEAR(s.sound_speed2, eos.bulk / eos.density * x * x, 1e-11 * eos.bulk / eos.density * 4);
    const EquationOfState paper = paper_state(eos, density, 0.0);
    EXPECT_LT(paper.pressure, 0.0);
    EXPECT_GT(paper.sound_speed2, 0.0);
    before = s.pressure;
  }
}

/// P one small isentropic step of relative density change h away (fourth-order Runge-Kutta).
double isentrope(const MieGruneisen& eos, double density, double energy, double h) {
  const auto slope = [&](double d, double e) {
    return conserving_state(eos, d, e).pressure / (d * d);
  };
  const double step = density * h;
  const double a = slope(density, energy);
  const double b = slope(density + 0.5 * step, energy + 0.5 * step * a);
  const double c = slope(density + 0.5 * step, energy + 0.5 * step * b);
  const double d = slope(density + step, energy + step * c);
  return conserving_state(eos, density + step, energy + step / 6.0 * (a + 2.0 * (b + c) + d))
      .pressure;
}

TEST(EquationOfState, SoundSpeedIsTheSlopeOfTheIsentrope) {
  const MieGruneisen eos = aluminium_eos();
  constexpr double h = 1e-4;
  for (const double eta : {-0.8, -0.3, -0.05, 0.05, 0.2, 0.4, 0.6, 0.7, 0.8}) {
    const double density = eos.density / (1.0 - eta);
    for (const double extra : {0.0, 2e5, 3e6}) {
      const double energy = reference_point(eos, eta).energy + extra;
      const double expected =
          (8.0 * (isentrope(eos, density, energy, h) - isentrope(eos, density, energy, -h)) -
           (isentrope(eos, density, energy, 2 * h) - isentrope(eos, density, energy, -2 * h))) /
          (12.0 * h * density);
      const double c2 = conserving_state(eos, density, energy).sound_speed2;
      EXPECT_NEAR(c2, expected, 1e-8 * c2) << eta << ' ' << extra;

      const auto paper = [&](double x) {
        return paper_state(eos, density * (1 + x), extra).pressure;
      };
      const double paper_expected =
          (8.0 * (paper(h) - paper(-h)) - (paper(2 * h) - paper(-2 * h))) / (12.0 * h * density);
      const double paper_c2 = paper_state(eos, density, extra).sound_speed2;
      EXPECT_NEAR(paper_c2, paper_expected, 1e-8 * paper_c2) << eta << ' ' << extra;
    }
  }
}

TEST(EquationOfState, PaperModeAddsThePlasticWork) {
  const MieGruneisen eos = aluminium_eos();
  for (const double eta : {-0.2, 0.0, 0.1, 0.3}) {
    const double density = eos.density / (1.0 - eta);
    const double cold = paper_state(eos, density, 0.0).pressure;
    EXPECT_NEAR(cold, reference_point(eos, eta).pressure, 1e-12 * eos.bulk);
    EXPECT_NEAR(paper_state(eos, density, 2e5).pressure - cold, 2.0 * density * 2e5,
                1e-12 * eos.bulk);
  }
}

TEST(EquationOfState, TangentBeyondTheGuard) {
  const MieGruneisen eos = aluminium_eos();
  EXPECT_NEAR(eos.guard, 1.8 / 4.0, 1e-15);  // below 0.85/lambda, where c^2 < 0
  const ReferencePoint guard = reference_point(eos, eos.guard);
  constexpr double h = 1e-9;
  const ReferencePoint below = reference_point(eos, eos.guard - h);
  const ReferencePoint above = reference_point(eos, eos.guard + h);
  EXPECT_NEAR((above.pressure - guard.pressure) / h, guard.pressure_slope,
              1e-5 * guard.pressure_slope);
  EXPECT_NEAR((guard.pressure - below.pressure) / h, guard.pressure_slope,
              1e-5 * guard.pressure_slope);
  EXPECT_NEAR((above.energy - guard.energy) / h, guard.energy_slope, 1e-5 * guard.energy_slope);
  EXPECT_NEAR((guard.energy - below.energy) / h, guard.energy_slope, 1e-5 * guard.energy_slope);
  EXPECT_NEAR(below.pressure_slope, above.pressure_slope, 1e-6 * guard.pressure_slope);
  for (double eta = eos.guard; eta < 1.0; eta += 0.01) {
    const ReferencePoint r = reference_point(eos, eta);
    EXPECT_EQ(r.pressure_slope, guard.pressure_slope);
    EXPECT_NEAR(r.pressure, guard.pressure + guard.pressure_slope * (eta - eos.guard),
                1e-12 * r.pressure);
    EXPECT_NEAR(r.energy, guard.energy + guard.energy_slope * (eta - eos.guard), 1e-12 * r.energy);
  }
}

// On the bare Hugoniot of a constant gamma c^2 is negative from about eta = 0.54 (gamma 2):
// pressing would soften the solid without end. The tangents keep every state stable that is not
// colder than the reference curve.
TEST(EquationOfState, StableAtAnyCompression) {
  struct Row {
    double lambda, gamma;
  };
  for (const Row& row : {Row{1.34, 2.0}, Row{1.34, 1.96}, Row{1.237, 1.6}, Row{1.489, 2.0},
                         Row{1.516, 0.97}, Row{2.06, 0.7}, Row{1.0, 1.0}, Row{1.34, 3.0}}) {
    const MieGruneisen eos = make_mie_gruneisen(2700, 5350, row.lambda, row.gamma, 880, 300);
    for (double eta = -2.0; eta < 0.999; eta += 0.001) {
      const double density = eos.density / (1.0 - eta);
      for (const double extra : {0.0, 1e5, 1e7}) {
        const double energy = reference_point(eos, eta).energy + extra;
        EXPECT_GT(conserving_state(eos, density, energy).sound_speed2, 0.0)
            << row.lambda << ' ' << row.gamma << ' ' << eta;
        EXPECT_GT(paper_state(eos, density, extra).sound_speed2, 0.0);
      }
    }
  }
}

// A straight Hugoniot (lambda 0, or below 1) has no singularity before V = 0.
TEST(EquationOfState, SmallLambdaStaysFinite) {
  for (const double lambda : {0.0, 0.5, 1.0}) {
    MaterialParameters p = aluminium();
    p.lambda = lambda;
    const Material m = make_material(p);
    for (double eta = -1.5; eta < 0.995; eta += 0.01) {
      const ReferencePoint r = reference_point(m.eos, eta);
      EXPECT_TRUE(std::isfinite(r.pressure) && std::isfinite(r.energy_slope))
          << lambda << ' ' << eta;
      EXPECT_GT(r.pressure_slope, 0.0);
      EXPECT_TRUE(std::isfinite(reference_temperature(m.temperature, eta))) << lambda << ' ' << eta;
    }
  }
}

// The same solid in units that differ by powers of two: the same bits.
TEST(EquationOfState, ScalesExactly) {
  const MieGruneisen a = aluminium_eos();
  const double mass = 0x1p-7, speed = 0x1p5;
  const MieGruneisen b =
      make_mie_gruneisen(2700.0 * mass, 5350.0 * speed, 1.34, 2.0, 880.0 * speed * speed, 300.0);
  const TemperatureCurve ta = make_temperature_curve(a), tb = make_temperature_curve(b);
  EXPECT_EQ(ta.value, tb.value);
  EXPECT_EQ(ta.slope, tb.slope);
  for (double density = 1500.0; density < 12000.0; density *= 1.037) {
    const EquationOfState x = conserving_state(a, density, 7.1e5);
    const EquationOfState y = conserving_state(b, density * mass, 7.1e5 * speed * speed);
    EXPECT_EQ(y.pressure, x.pressure * mass * speed * speed);
    EXPECT_EQ(y.sound_speed2, x.sound_speed2 * speed * speed);
    const EquationOfState u = paper_state(a, density, 7.1e5);
    const EquationOfState w = paper_state(b, density * mass, 7.1e5 * speed * speed);
    EXPECT_EQ(w.pressure, u.pressure * mass * speed * speed);
    EXPECT_EQ(w.sound_speed2, u.sound_speed2 * speed * speed);
  }
}

}  // namespace
