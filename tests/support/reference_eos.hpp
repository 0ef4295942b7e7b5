#pragma once
// Exact states of a Mie-Grueneisen solid, written apart from the program so that tests can judge
// it. Functions of the specific volume v (m^3/kg) and the energy per mass e (J/kg); SI throughout,
// pressure and axial stress positive in compression.

#include <cmath>
#include <stdexcept>

namespace poreshock::reference {

/// A solid; the defaults are the aluminium of the paper.
struct Solid {
  double density = 2700.0;
  double c0 = 5350.0;
  double lambda = 1.34;
  double gamma = 2.0;  ///< constant Grueneisen coefficient
  double cv = 880.0;
  double T0 = 300.0;
  double shear = 69.0e9 / 2.66;
  double yield = 120.0e6;
  double hardening = 384.0e6;
  double kinematic_share = 0.0;
  bool elastic_energy_heats =
      false;  ///< true: the elastic deviatoric energy counts in the pressure

  double volume() const { return 1.0 / density; }
  double bulk() const { return density * c0 * c0; }
};

/// The same solid without strength.
inline Solid fluid_of(Solid m) {
  m.shear = m.yield = m.hardening = 0.0;
  return m;
}

/// The first zero of f on the way from `from` to `to`, found by scanning and bisection.
template <class F>
double first_root(const F& f, double from, double to, int scans = 4000) {
  double a = from;
  const bool sign = f(a) > 0.0;
  for (int i = 1; i <= scans; ++i) {
    double b = from + (to - from) * i / scans;
    if ((f(b) > 0.0) == sign) {
      a = b;
      continue;
    }
    for (int k = 0; k < 100; ++k) {
      const double middle = 0.5 * (a + b);
      ((f(middle) > 0.0) == sign ? a : b) = middle;
    }
    return 0.5 * (a + b);
  }
  throw std::runtime_error("reference solution: no root between the two ends");
}

/// Pressure of the reference curve: Hugoniot for v <= V0, linear in v beyond, Pa.
inline double curve_pressure(const Solid& m, double v) {
  const double eta = 1.0 - v * m.density;
  const double f = eta > 0.0 ? 1.0 - m.lambda * eta : 1.0;
  return m.bulk() * eta / (f * f);
}

/// dP_r/dv.
inline double curve_slope(const Solid& m, double v) {
  const double eta = 1.0 - v * m.density;
  if (eta <= 0.0) return -m.density * m.bulk();
  const double f = 1.0 - m.lambda * eta;
  return -m.density * m.bulk() * (1.0 + m.lambda * eta) / (f * f * f);
}

/// Energy of the reference curve, J/kg.
inline double curve_energy(const Solid& m, double v) {
  return 0.5 * curve_pressure(m, v) * (m.volume() - v);
}

/// Temperature of the reference curve, K: eq 6 integrated by Simpson's rule (isentrope beyond V0).
inline double curve_temperature(const Solid& m, double v, int intervals = 2000) {
  const double eta = 1.0 - v * m.density;
  const double isentrope = m.T0 * std::pow(1.0 - eta, -m.gamma);
  if (eta <= 0.0) return isentrope;
  const auto heat = [&](double s) {
    return s * s * std::pow(1.0 - s, m.gamma) / std::pow(1.0 - m.lambda * s, 3.0);
  };
  const double h = eta / intervals;
  double sum = heat(0.0) + heat(eta);
  for (int i = 1; i < intervals; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * heat(h * i);
  const double integral = sum * h / 3.0;
  return isentrope + m.lambda * m.c0 * m.c0 / m.cv * integral * std::pow(1.0 - eta, -m.gamma);
}

/// Pressure at volume and energy (without the elastic deviatoric part), Pa.
inline double pressure(const Solid& m, double v, double e) {
  return curve_pressure(m, v) + m.gamma / v * (e - curve_energy(m, v));
}

/// Temperature at volume and energy, K.
inline double temperature(const Solid& m, double v, double e) {
  return curve_temperature(m, v) + (e - curve_energy(m, v)) / m.cv;
}

/// dP/dv along a path with energy slope de/dv.
inline double pressure_slope(const Solid& m, double v, double e, double energy_slope) {
  const double g = m.gamma / v;
  const double curve_energy_slope =
      0.5 * (curve_slope(m, v) * (m.volume() - v) - curve_pressure(m, v));
  return curve_slope(m, v) - g / v * (e - curve_energy(m, v)) +
         g * (energy_slope - curve_energy_slope);
}

/// Longitudinal sound speed, m/s.
inline double longitudinal_speed(const Solid& m, double v, double e) {
  const double bulk2 = -v * v * pressure_slope(m, v, e, -pressure(m, v, e));
  return std::sqrt(bulk2 + 4.0 / 3.0 * m.shear * v);
}

/// A uniform state behind a front, in the frame where the material ahead of all fronts is at rest.
struct State {
  double front = 0.0;        ///< speed of the front that makes it, m/s
  double velocity = 0.0;     ///< m/s
  double volume = 0.0;       ///< specific volume, m^3/kg
  double pressure = 0.0;     ///< Pa
  double stress = 0.0;       ///< axial stress, Pa
  double flow_stress = 0.0;  ///< von Mises stress, Pa
  double plastic_strain = 0.0;
  double energy = 0.0;       ///< J/kg without the elastic deviatoric part
  double temperature = 0.0;  ///< K

  double density() const { return 1.0 / volume; }
  double deviator() const { return stress - pressure; }  ///< axial deviator, Pa
};

/// State on the Hugoniot of the solid without strength at piston velocity up.
inline State hugoniot(const Solid& m, double up) {
  State s;
  s.front = m.c0 + m.lambda * up;
  s.velocity = up;
  s.volume = m.volume() * (1.0 - up / s.front);
  s.pressure = s.stress = m.density * s.front * up;
  s.energy = 0.5 * up * up;
  s.temperature = curve_temperature(m, s.volume);
  return s;
}

/// Porous solid of void fraction `porosity` that collapses completely and has no strength ("snow
/// plow"), at piston velocity up. The root is sought from the expanded side: at fixed energy the
/// pressure turns over again at high compression.
inline State snow_plow(const Solid& m, double porosity, double up) {
  const double v00 = m.volume() / (1.0 - porosity);
  const double e = 0.5 * up * up;
  State s;
  s.volume = first_root([&](double v) { return pressure(m, v, e) * (v00 - v) - up * up; }, v00,
                        0.4 * m.volume());
  s.velocity = up;
  s.front = up * v00 / (v00 - s.volume);
  s.pressure = s.stress = pressure(m, s.volume, e);
  s.energy = e;
  s.temperature = temperature(m, s.volume, e);
  return s;
}

}  // namespace poreshock::reference
