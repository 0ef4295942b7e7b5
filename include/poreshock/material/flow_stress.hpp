#pragma once
// Flow stress that hardens by a power of the plastic strain, rises with strain rate and pressure
// and falls with temperature: the laws of Johnson and Cook (Proc. 7th Int. Symp. Ballistics, 1983)
// and of Steinberg, Cochran and Guinan (J. Appl. Phys. 51, 1980, 1498) are cases of it. The return
// to the yield surface is implicit in plastic strain and strain rate; temperature and pressure are
// those of the start of the step.

#include <array>
#include <cmath>

#include "poreshock/core/elementary.hpp"
#include "poreshock/core/range.hpp"
#include "poreshock/material/j2_plasticity.hpp"
#include "poreshock/particles/particles.hpp"

namespace poreshock {

/// One key of the parameters of a law, as a scene gives it.
template <class Parameters>
struct LawKey {
  const char* name;
  double Parameters::*value;
  Range range;
  const char* unit;
  const char* about;
  bool required;
};

template <class Parameters>
constexpr LawKey<Parameters> law_key(const char* name, double Parameters::*value, Range range,
                                     const char* unit, const char* about, bool required = true) {
  return {name, value, range, unit, about, required};
}

inline constexpr Range exponent_range{.low = 0.0, .high = 1.0, .above_low = true};

/// Y = (A + B ep^n)(1 + C ln(rate/reference_rate))(1 - T*^m) with T* = 0 at the reference
/// temperature and 1 at melting.
struct JohnsonCookParameters {
  double yield = 0.0;                    ///< Pa, A
  double hardening = 0.0;                ///< Pa, B
  double exponent = 1.0;                 ///< n
  double rate = 0.0;                     ///< C
  double reference_rate = 1.0;           ///< 1/s
  double softening = 1.0;                ///< m
  double melting = 0.0;                  ///< K
  double reference_temperature = 300.0;  ///< K

  bool operator==(const JohnsonCookParameters&) const = default;
  static constexpr const char* name = "johnson_cook";
  static constexpr const char* about =
      "(A + B ep^n) (1 + C ln(rate/reference_rate)) (1 - T*^m), T* = 1 at melting.";
  static constexpr auto keys() {
    using P = JohnsonCookParameters;
    return std::array{
        law_key("yield", &P::yield, positive, "Pa", "A"),
        law_key("hardening", &P::hardening, not_negative, "Pa", "B"),
        law_key("exponent", &P::exponent, exponent_range, "", "n of the plastic strain"),
        law_key("rate", &P::rate, not_negative, "", "C, rise per e-fold of the strain rate"),
        law_key("reference_rate", &P::reference_rate, positive, "1/s",
                "strain rate from which on C counts", false),
        law_key("softening", &P::softening, positive, "", "m of the temperature"),
        law_key("melting", &P::melting, positive, "K", "temperature without strength"),
        law_key("reference_temperature", &P::reference_temperature, positive, "K",
                "temperature from which on it softens", false)};
  }
};

/// Y = min(Y0 (1 + beta (ep + ei))^n, Ymax) (1 + A P/(rho/rho0)^(1/3) - B (T - T_ref)); the last
/// bracket is that of the shear modulus, of which only the yield stress takes note here.
struct SteinbergGuinanParameters {
  double yield = 0.0;                    ///< Pa, Y0
  double hardening = 0.0;                ///< beta
  double exponent = 1.0;                 ///< n
  double initial_strain = 0.0;           ///< ei
  double limit = 0.0;                    ///< Pa, Ymax
  double pressure_rise = 0.0;            ///< 1/Pa, A
  double temperature_fall = 0.0;         ///< 1/K, B
  double reference_temperature = 300.0;  ///< K

  bool operator==(const SteinbergGuinanParameters&) const = default;
  static constexpr const char* name = "steinberg_guinan";
  static constexpr const char* about =
      "min(Y0 (1 + beta ep)^n, Ymax) (1 + A P/(rho/rho0)^(1/3) - B (T - reference)).";
  static constexpr auto keys() {
    using P = SteinbergGuinanParameters;
    return std::array{
        law_key("yield", &P::yield, positive, "Pa", "Y0"),
        law_key("hardening", &P::hardening, not_negative, "", "beta"),
        law_key("exponent", &P::exponent, exponent_range, "", "n of the plastic strain"),
        law_key("initial_strain", &P::initial_strain, not_negative, "", "plastic strain before",
                false),
        law_key("limit", &P::limit, positive, "Pa", "Ymax, at no pressure"),
        law_key("pressure_rise", &P::pressure_rise, not_negative, "1/Pa",
                "A, relative rise of the shear modulus"),
        law_key("temperature_fall", &P::temperature_fall, not_negative, "1/K",
                "B, relative fall of the shear modulus"),
        law_key("reference_temperature", &P::reference_temperature, positive, "K",
                "temperature of Y0", false)};
  }
};

/// Y = min((start + hardening (initial_strain + ep)^exponent) (1 + rate ln(rate*)), limit) times
/// thermal_factor, with rate* = max(1, plastic strain rate / reference_rate).
struct FlowStress {
  double start = 0.0;                    ///< Pa
  double hardening = 0.0;                ///< Pa
  double exponent = 1.0;                 ///< 0 < exponent <= 1
  double initial_strain = 0.0;           ///< added to the plastic strain
  double limit = 1e300;                  ///< Pa
  double rate = 0.0;                     ///< rise per e-fold of the strain rate
  double reference_rate = 1.0;           ///< 1/s
  double reference_temperature = 300.0;  ///< K
  double melting = 1e300;                ///< K, where the stress is gone
  double softening = 1.0;                ///< exponent of the homologous temperature
  double pressure_rise = 0.0;            ///< 1/Pa, of the shear modulus
  double temperature_fall = 0.0;         ///< 1/K, of the shear modulus
};

inline FlowStress make_law(const JohnsonCookParameters& p) {
  FlowStress law;
  law.start = p.yield;
  law.hardening = p.hardening;
  law.exponent = p.exponent;
  law.rate = p.rate;
  law.reference_rate = p.reference_rate;
  law.softening = p.softening;
  law.melting = p.melting;
  law.reference_temperature = p.reference_temperature;
  return law;
}

inline FlowStress make_law(const SteinbergGuinanParameters& p) {
  FlowStress law;
  // Y0 (1 + beta e)^n = Y0 beta^n (1/beta + e)^n.
  const bool hardens = p.hardening > 0.0;
  law.start = hardens ? 0.0 : p.yield;
  law.hardening = hardens ? p.yield * positive_power(p.hardening, p.exponent) : 0.0;
  law.exponent = p.exponent;
  law.initial_strain = hardens ? 1.0 / p.hardening + p.initial_strain : 0.0;
  law.limit = p.limit;
  law.pressure_rise = p.pressure_rise;
  law.temperature_fall = p.temperature_fall;
  law.reference_temperature = p.reference_temperature;
  return law;
}

/// Share of the flow stress that pressure (Pa), compression (density over the initial one) and
/// temperature (K) leave: (1 - T*^softening)(1 + A P / compression^(1/3) - B (T - T_ref)), T* from
/// 0 at the reference temperature to 1 at melting; never negative.
inline double thermal_factor(const FlowStress& law, double pressure, double compression,
                             double temperature) {
  const double warmer = temperature - law.reference_temperature;
  const double homologous = warmer / (law.melting - law.reference_temperature);
  const double inside = homologous < 1.0 ? homologous : 1.0;
  const double soft = 1.0 - positive_power(inside, law.softening);
  const double modulus = 1.0 +
                         law.pressure_rise * pressure * positive_power(compression, -1.0 / 3.0) -
                         law.temperature_fall * warmer;
  return modulus > 0.0 ? soft * modulus : 0.0;
}

/// Flow stress (Pa) at a plastic strain and strain rate (1/s).
inline double flow_stress(const FlowStress& law, double factor, double plastic_strain,
                          double strain_rate) {
  const double relative = strain_rate / law.reference_rate;
  const double rise = relative > 1.0 ? 1.0 + law.rate * natural_logarithm(relative) : 1.0;
  const double hard =
      law.hardening * positive_power(law.initial_strain + plastic_strain, law.exponent);
  const double stress = (law.start + hard) * rise;
  return factor * (stress < law.limit ? stress : law.limit);
}

/// What the return of one particle over one step is solved from.
struct FlowStep {
  double trial = 0.0;           ///< Pa, equivalent stress of the trial state
  double triple_shear = 0.0;    ///< Pa, 3 G
  double factor = 1.0;          ///< thermal_factor of the start of the step
  double plastic_strain = 0.0;  ///< of the start of the step
  double dt = 0.0;              ///< s
};

/// Iterations of plastic_increment, the same for all particles.
inline constexpr int flow_iterations = 8;

/// trial - 3 G d - Y for a plastic increment d, and minus its slope over d, without the limit.
struct FlowResidual {
  double value, slope;
};

/// `rate` is that of the law or 0, `slow` the increment at the reference rate.
inline FlowResidual flow_residual(const FlowStress& law, const FlowStep& step, double rate,
                                  double slow, double d) {
  constexpr double least = 1e-300;
  const double sum = law.initial_strain + (step.plastic_strain + d);
  const double x = sum > least ? sum : least;
  const double hard = law.hardening * exponential(law.exponent * natural_logarithm(x));
  const double rise = 1.0 + rate * (natural_logarithm(d) - natural_logarithm(slow));
  const double stress = (law.start + hard) * rise;
  const double slope = law.exponent * hard / x * rise + (law.start + hard) * (rate / d);
  return {step.trial - step.triple_shear * d - step.factor * stress,
          step.triple_shear + step.factor * slope};
}

/// Plastic strain of the step: the root d of trial - 3 G d = Y(plastic_strain + d, d/dt), zero
/// below yield. Every iteration brackets the root from both sides, by the tangent over d and the
/// tangent over ln d, and goes on from their geometric mean: the residual is convex in d and
/// concave in ln d. The stress that follows from d errs by less than 1e-6 of the trial stress, as a
/// rule 1e-12.
inline double plastic_increment(const FlowStress& law, const FlowStep& step) {
  constexpr double least = 1e-300;
  const double excess = flow_residual(law, step, 0.0, 1.0, least).value;
  const double most = excess > 0.0 ? excess / step.triple_shear : least;
  // Below the increment of the reference rate the rate does not matter, above it always does.
  const double product = step.dt * law.reference_rate;
  const double slow = product > least ? product : least;
  const bool is_slow = flow_residual(law, step, 0.0, 1.0, slow).value <= 0.0;
  const double rate = is_slow ? 0.0 : law.rate;
  const double smaller = slow < most ? slow : most;
  double low = is_slow ? 0.0 : smaller;
  double high = is_slow ? smaller : most;
  double d = high;
#pragma GCC unroll 8
  for (int iteration = 0; iteration < flow_iterations; ++iteration) {
    const FlowResidual residual = flow_residual(law, step, rate, slow, d);
    low = residual.value > 0.0 ? d : low;
    high = residual.value > 0.0 ? high : d;
    const double change = residual.value / residual.slope;
    const double from_left = d + change > low ? d + change : low;
    const double left = from_left < high ? from_left : high;
    const double exponent = change < 60.0 * d ? change / d : 60.0;
    const double logarithmic = d * exponential(exponent);
    const double from_right = logarithmic < high ? logarithmic : high;
    const double right = from_right > low ? from_right : low;
    const double beside_zero = residual.value > 0.0 ? 0.5 * right : right;
    d = left > 0.0 ? std::sqrt(left * right) : beside_zero;
  }
  // The lower of two flow stresses flows more: that of the law or its limit.
  const double free = excess > 0.0 ? d : 0.0;
  const double limited = (step.trial - step.factor * law.limit) / step.triple_shear;
  const double larger = limited > free ? limited : free;
  return step.triple_shear > 0.0 ? larger : 0.0;
}

/// Particles of one material at the start of a step, their columns side by side.
template <int Dim>
struct FlowBlock {
  ParticlePointers<Dim> particle;
  std::size_t count;
  const double* equivalent;   ///< Pa, of the trial stress
  const double* temperature;  ///< K
  const double* molten;       ///< share of the mass, without strength
  double shear;               ///< Pa
  double density;             ///< kg/m^3, initial
  double dt;                  ///< s
};

/// Plastic strain of the step for each particle of a block.
// Flattened: the loop vectorises only when all it calls is inlined.
template <int Dim>
[[gnu::flatten]] void find_increments(const FlowStress& constants, const FlowBlock<Dim>& block,
                                      double* increments) {
  const FlowStress law = constants;
  const FlowBlock<Dim> b = block;
#pragma GCC ivdep
  for (std::size_t k = 0; k < b.count; ++k) {
    const double factor =
        (1.0 - b.molten[k]) * thermal_factor(law, b.particle.pressure[k],
                                             b.particle.density[k] / b.density, b.temperature[k]);
    increments[k] = plastic_increment(
        law, {b.equivalent[k], 3.0 * b.shear, factor, b.particle.plastic_strain[k], b.dt});
  }
}

/// Returns the trial deviator by a known plastic increment; `start` as in radial_return. All
/// plastic work is dissipation.
template <int Dim>
inline ReturnMapping<Dim> return_by(double increment, double shear,
                                    const SymmetricTensor<Dim>& start,
                                    const SymmetricTensor<Dim>& trial) {
  ReturnMapping<Dim> result;
  const double norm = std::sqrt(contract<Dim>(trial, trial));
  const double inverse_norm = increment > 0.0 ? 1.0 / norm : 0.0;
  const double back = std::sqrt(6.0) * shear * increment * inverse_norm;
  SymmetricTensor<Dim> middle;
  for (int c = 0; c < symmetric_size<Dim>; ++c) {
    result.deviator[c] = trial[c] - back * trial[c];
    result.back_stress[c] = 0.0;
    middle[c] = 0.5 * (start[c] + result.deviator[c]);
  }
  result.plastic_strain_increment = increment;
  result.plastic_work = std::sqrt(1.5) * increment * (contract<Dim>(middle, trial) * inverse_norm);
  result.dissipation = result.plastic_work;
  return result;
}

}  // namespace poreshock
