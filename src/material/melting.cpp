#include "poreshock/material/melting.hpp"

namespace poreshock {

namespace {

/// Density of the solid at a temperature and no pressure, kg/m^3: halves an interval of eta.
double unloaded_density(double temperature, const MieGruneisen& eos,
                        const TemperatureCurve& reference) {
  double low = -0.5, high = 0.0;
  for (int k = 0; k < 100; ++k) {
    const double eta = 0.5 * (low + high);
    const double density = eos.density / (1.0 - eta);
    const double heat = eos.cv * (temperature - reference_temperature(reference, eta));
    const double pressure = reference_point(eos, eta).pressure + eos.gamma * density * heat;
    (pressure > 0.0 ? high : low) = eta;
  }
  return eos.density / (1.0 - 0.5 * (low + high));
}

}  // namespace

MeltCurve make_melt_curve(MeltingLaw law, const MeltParameters& p, const MieGruneisen& eos,
                          const TemperatureCurve& reference) {
  MeltCurve curve{law, p.temperature, p.latent_heat, 0.0, 0.0};
  if (law == MeltingLaw::lindemann) {
    curve.inverse = 1.0 / unloaded_density(p.temperature, eos, reference);
    curve.power = 2.0 * (eos.gamma - 1.0 / 3.0);
  } else {
    curve.inverse = 1.0 / p.pressure;
    curve.power = 1.0 / p.exponent;
  }
  return curve;
}

}  // namespace poreshock
