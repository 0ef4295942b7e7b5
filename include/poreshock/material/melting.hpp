#pragma once
// Melting at equilibrium: a melt curve, a latent heat, and the phase of a state. The equation of
// state P(V, E) stays that of the solid, so that latent heat presses as other heat does and the
// mechanics of a shock do not change but for the strength.

#include "poreshock/core/elementary.hpp"
#include "poreshock/material/mie_gruneisen.hpp"

namespace poreshock {

enum class MeltingLaw { none, lindemann, simon_glatzel };

/// What a scene says about melting.
struct MeltParameters {
  double temperature = 0.0;  ///< K, at no pressure
  double latent_heat = 0.0;  ///< J/kg
  double pressure = 0.0;     ///< Pa, Simon-Glatzel only
  double exponent = 0.0;     ///< Simon-Glatzel only
  bool operator==(const MeltParameters&) const = default;
};

/// Constants of a melt curve.
struct MeltCurve {
  MeltingLaw law = MeltingLaw::none;
  double temperature = 0.0;  ///< K, at no pressure
  double latent_heat = 0.0;  ///< J/kg
  double inverse = 0.0;      ///< 1/density (m^3/kg) or 1/pressure (1/Pa) of the law
  double power = 0.0;
};

/// Temperature (K) and the share of the mass that is liquid.
struct MaterialPhase {
  double temperature = 0.0;
  double molten = 0.0;
};

/// The curve of a material from its equation of state: Lindemann's law T_m = T_0 (rho/rho_0)^(2
/// (gamma - 1/3)) with rho_0 the density of the solid at T_0 and no pressure, T_0 where it has
/// expanded further; or that of Simon and Glatzel, T_m = T_0 (1 + P/a)^(1/c), T_0 in tension.
MeltCurve make_melt_curve(MeltingLaw law, const MeltParameters& parameters, const MieGruneisen& eos,
                          const TemperatureCurve& reference);

/// Melting temperature (K) at a density (kg/m^3) and pressure (Pa).
inline double melting_temperature(const MeltCurve& curve, double density, double pressure) {
  const double base =
      curve.law == MeltingLaw::lindemann ? density * curve.inverse : 1.0 + pressure * curve.inverse;
  if (!(base > 1.0)) return curve.temperature;
  return curve.temperature * positive_power(base, curve.power);
}

/// Phase of a state whose temperature would be `solid` (K) without melting, at the melting
/// temperature `melting` (K): what heat it has beyond the melt line melts it first.
inline MaterialPhase phase_of(const MeltCurve& curve, double cv, double solid, double melting) {
  const double share = cv * (solid - melting) / curve.latent_heat;
  if (!(share > 0.0)) return {solid, 0.0};
  if (share < 1.0) return {melting, share};
  return {solid - curve.latent_heat / cv, 1.0};
}

}  // namespace poreshock
