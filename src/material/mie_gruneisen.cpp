#include "poreshock/material/mie_gruneisen.hpp"

#include <algorithm>
#include <cmath>

namespace poreshock {

namespace {
constexpr double lowest_eta = -1.0;

// The Hugoniot is singular at eta = 1/lambda, and eta = 1 is no volume at all.
double eta_limit(double lambda) {
  return 1.0 / std::max(lambda, 1.0);
}
constexpr int table_intervals = 4096;
}  // namespace

MieGruneisen make_mie_gruneisen(double density, double c0, double lambda, double gamma, double cv,
                                double T0) {
  // 0.85 of the limit keeps the tangent finite and steep.
  return {density, density * c0 * c0, lambda, gamma, cv, T0, 0.85 * eta_limit(lambda)};
}

TemperatureCurve make_temperature_curve(const MieGruneisen& eos) {
  TemperatureCurve curve;
  const double highest_eta = 0.95 * eta_limit(eos.lambda);
  curve.first = lowest_eta;
  curve.step = (highest_eta - lowest_eta) / table_intervals;
  const double heating = eos.lambda * (eos.bulk / eos.density) / eos.cv;
  // Eq 6 is the entropy that (eta P_r' - P_r)/2 makes: constant on the tangent beyond the guard.
  const auto source = [&](double s) {
    const double inside = std::min(s, eos.guard);
    const double f = 1.0 - eos.lambda * inside;
    return inside * inside / (f * f * f);
  };
  const auto integrand = [&](double s) { return source(s) * std::pow(1.0 - s, eos.gamma); };
  // T_r (1 - eta)^gamma = T0 + heating * integral, integrated node to node by 5-point Gauss.
  static constexpr double x[5] = {0.0, 0.5384693101056831, -0.5384693101056831, 0.9061798459386640,
                                  -0.9061798459386640};
  static constexpr double w[5] = {0.5688888888888889, 0.4786286704993665, 0.4786286704993665,
                                  0.2369268850561891, 0.2369268850561891};
  double integral = 0.0;
  double from = 0.0;
  for (int i = 0; i <= table_intervals; ++i) {
    const double eta = curve.first + curve.step * i;
    double heat_slope = 0.0;
    if (eta > 0.0) {
      const double half = 0.5 * (eta - from);
      for (int k = 0; k < 5; ++k) integral += half * w[k] * integrand(from + half * (1.0 + x[k]));
      from = eta;
      heat_slope = heating * source(eta);
    }
    const double T = (eos.T0 + heating * integral) / std::pow(1.0 - eta, eos.gamma);
    curve.value.push_back(T);
    curve.slope.push_back(eos.gamma * T / (1.0 - eta) + heat_slope);  // eq 6 in eta
  }
  return curve;
}

double reference_temperature(const MieGruneisen& eos, const TemperatureCurve& curve, double eta) {
  // The negation sends NaN this way, where it passes on.
  if (!(eta >= curve.first)) return eos.T0 / std::pow(1.0 - eta, eos.gamma);
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
