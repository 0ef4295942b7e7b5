#pragma once
// Mie-Grueneisen equation of state on the shock Hugoniot Us = c0 + lambda Up, with a constant
// Grueneisen coefficient; in expansion the reference is linear in the specific volume.
// eta = 1 - V/V0 = 1 - rho0/rho. Compression positive.

#include <cmath>
#include <vector>

namespace poreshock {

/// Constants of the equation of state; make_mie_gruneisen fills the derived ones.
struct MieGruneisen {
  double density = 0.0;  ///< rho0, kg/m^3
  double bulk = 0.0;     ///< rho0 c0^2, Pa
  double lambda = 0.0;
  double gamma = 0.0;
  double cv = 0.0;     ///< J/(kg K)
  double T0 = 0.0;     ///< K
  double guard = 0.0;  ///< eta beyond which the reference curve continues by its tangents
};

/// Reference curve at one compression: pressure (Pa), its slope dP/deta, energy (J/kg), dE/deta.
struct ReferencePoint {
  double pressure, pressure_slope, energy, energy_slope;
};

/// Pressure (Pa) and squared bulk sound speed (m^2/s^2).
struct EquationOfState {
  double pressure, sound_speed2;
};

/// The derived constants from density (kg/m^3), c0 (m/s), lambda, gamma, cv (J/(kg K)) and T0 (K).
MieGruneisen make_mie_gruneisen(double density, double c0, double lambda, double gamma, double cv,
                                double T0);

/// Hugoniot for V <= V0, isentrope linear in V for V > V0 (paper eq 5 with V0 in the denominator
/// and the sign of the expansion branch that is stable); pressure and energy by their tangents
/// beyond the guard.
inline ReferencePoint reference_point(const MieGruneisen& eos, double eta) {
  const double held = eta < eos.guard ? eta : eos.guard;
  const double inside = held > 0.0 ? held : 0.0;
  const double f = 1.0 / (1.0 - eos.lambda * inside);
  const double slope = eos.bulk * (1.0 + eos.lambda * inside) * (f * f * f);
  const double pressure = eos.bulk * inside * (f * f) + slope * (held - inside);
  const double half_volume = 0.5 / eos.density;
  const double energy_slope = half_volume * (slope * held + pressure);
  const double beyond = eta - held;
  return {pressure + slope * beyond, slope, half_volume * pressure * held + energy_slope * beyond,
          energy_slope};
}

/// P = P_r + gamma rho (E - E_r) and c^2 = (dP/drho)_S; `energy` is per mass without the elastic
/// deviatoric part (conserving mode).
inline EquationOfState conserving_state(const MieGruneisen& eos, double density, double energy) {
  const double v = 1.0 / density;
  const ReferencePoint r = reference_point(eos, 1.0 - eos.density * v);
  const double thermal = energy - r.energy;
  const double pressure = r.pressure + eos.gamma * density * thermal;
  const double slope =
      eos.density * (v * v) * (r.pressure_slope - eos.gamma * density * r.energy_slope);
  return {pressure, slope + eos.gamma * thermal + eos.gamma * pressure * v};
}

/// P = P_r + gamma rho W with W the plastic work per mass (paper eqs 4 and 5).
inline EquationOfState paper_state(const MieGruneisen& eos, double density, double plastic_work) {
  const double v = 1.0 / density;
  const ReferencePoint r = reference_point(eos, 1.0 - eos.density * v);
  return {r.pressure + eos.gamma * density * plastic_work,
          eos.density * (v * v) * r.pressure_slope + eos.gamma * plastic_work};
}

/// Compression eta at which the branch of expansion bears a tension S (Pa): K eta (1 - c eta) +
/// gamma rho0 heat + S (1 - eta) = 0, where c is 1 + gamma/2 when `heat` (J/kg) is the internal
/// energy and 1 when it is the plastic work of the paper's model.
inline double eta_in_tension(const MieGruneisen& eos, double c, double heat, double tension) {
  const double s = tension / eos.bulk, b = 1.0 - s;
  const double square = b * b + 4.0 * c * (eos.gamma * eos.density * heat / eos.bulk + s);
  return (b - std::sqrt(square > 0.0 ? square : 0.0)) / (2.0 * c);
}

/// Temperature along the reference curve, T_r(eta), tabulated (paper eq 6; T V^gamma constant in
/// expansion). Between the nodes a cubic Hermite polynomial with the exact slope: error < 1e-6 K.
struct TemperatureCurve {
  double first = 0.0, step = 0.0;    ///< eta of node 0, spacing
  std::vector<double> value, slope;  ///< K, K per unit eta
  double doubling = 1.0;  ///< 2^-gamma, the change of T_r when an expanded volume doubles
};

/// The table of a material; made once.
TemperatureCurve make_temperature_curve(const MieGruneisen& eos);

/// T_r at eta, K. Outside the table it continues by the tangent at its end (compression) or exactly
/// (expansion).
double reference_temperature(const TemperatureCurve& curve, double eta);

}  // namespace poreshock
