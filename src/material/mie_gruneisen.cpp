#include "poreshock/material/mie_gruneisen.hpp"

#include <algorithm>
#include <cmath>

namespace poreshock {

namespace {
constexpr int intervals_to_guard = 1280;  // about 3e-4 in eta
constexpr int most_doublings = 1100;      // of a volume that is still finite

// The Hugoniot is singular at eta = 1/lambda, and eta = 1 is no volume at all.
double eta_limit(double lambda) {
  return 1.0 / std::max(lambda, 1.0);
}
}  // namespace

MieGruneisen make_mie_gruneisen(double density, double c0, double lambda, double gamma, double cv,
                                double T0) {
  // At 0.85 of the limit the tangent is finite and steep. A constant gamma asks for less: on the
  // Hugoniot c^2 = V^2 rho0 [P'(1 - gamma eta/(2 (1 - eta))) + gamma P/(2 (1 - eta))] turns
  // negative a little above eta = 2/(2 + gamma). From 0.9 of that the tangents keep c^2 > 0 at any
  // eta.
  const double guard = std::min(0.85 * eta_limit(lambda), 1.8 / (2.0 + gamma));
  return {density, density * c0 * c0, lambda, gamma, cv, T0, guard};
}

TemperatureCurve make_temperature_curve(const MieGruneisen& eos) {
  TemperatureCurve curve;
  // The curve bends at V0 and at the guard: a node lies on each. It starts at twice V0.
  curve.step = eos.guard / intervals_to_guard;
  const int below = static_cast<int>(std::ceil(1.0 / curve.step));
  const int above = static_cast<int>(0.95 * eta_limit(eos.lambda) / curve.step);
  curve.first = -curve.step * below;
  // Eq 6 in eta: what the reference energy gains beyond the work of the reference pressure, K.
  const auto heat = [&](double eta) {
    const ReferencePoint r = reference_point(eos, eta);
    return (r.energy_slope - r.pressure / eos.density) / eos.cv;
  };
  // T_r (1 - eta)^gamma = T0 + integral of heat (1 - eta)^gamma, node to node by 5-point Gauss.
  static constexpr double x[5] = {0.0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640,
                                  -0.9061798459386640};
  static constexpr double w[5] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665,
                                  0.2369268850561891, 0.2369268850561891};
  double integral = 0.0;
  for (int i = -below; i <= above; ++i) {
    const double eta = curve.step * i;
    if (i > 0) {
      const double half = 0.5 * curve.step;
      for (int k = 0; k < 5; ++k) {
        const double s = eta - half * (1.0 - x[k]);
        integral += half * w[k] * heat(s) * std::pow(1.0 - s, eos.gamma);
      }
    }
    const double T = (eos.T0 + integral) / std::pow(1.0 - eta, eos.gamma);
    curve.value.push_back(T);
    curve.slope.push_back(eos.gamma * T / (1.0 - eta) + (i > 0 ? heat(eta) : 0.0));
  }
  curve.doubling = std::pow(0.5, eos.gamma);
  return curve;
}

double reference_temperature(const TemperatureCurve& curve, double eta) {
  // The negation sends NaN this way, where it passes on.
  if (!(eta >= curve.first)) {
    // T V^gamma is constant: halve the volume until the table has it. The temperature is state
    // where heat is conducted, so that no power function may enter here.
    double ratio = 1.0 - eta, factor = 1.0;
    for (int k = 0; k < most_doublings && ratio > 2.0; ++k) {
      ratio *= 0.5;
      factor *= curve.doubling;
    }
    return ratio <= 2.0 ? factor * reference_temperature(curve, 1.0 - ratio) : factor * ratio;
  }
  const double s = (eta - curve.first) / curve.step;
  const auto last = curve.value.size() - 1;
  if (s >= static_cast<double>(last)) {
    return curve.value[last] + curve.slope[last] * curve.step * (s - static_cast<double>(last));
  }
  const auto i = static_cast<std::size_t>(s);
  const double t = s - static_cast<double>(i);
  const double d0 = curve.slope[i] * curve.step;
  const double d1 = curve.slope[i + 1] * curve.step;
  const double rise = curve.value[i + 1] - curve.value[i];
  return curve.value[i] +
         t * (d0 + t * ((3.0 * rise - 2.0 * d0 - d1) + t * (d0 + d1 - 2.0 * rise)));
}

}  // namespace poreshock
