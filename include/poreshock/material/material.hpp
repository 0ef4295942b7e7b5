#pragma once
// Materials: their parameters as a scene states them, the constants kernels use, and what follows
// from a particle's state. There is one model, of parts: equation of state, strength and heat.

#include <limits>
#include <optional>
#include <string>

#include "poreshock/material/flow_stress.hpp"
#include "poreshock/material/j2_plasticity.hpp"
#include "poreshock/material/melting.hpp"
#include "poreshock/material/mie_gruneisen.hpp"
#include "poreshock/particles/particles.hpp"

namespace poreshock {

enum class Thermal { paper, conserving };
enum class PlasticHeat { work, dissipation };
enum class StrengthModel { linear, johnson_cook, steinberg_guinan };

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
};

/// Isotropic elastic-plastic solid with J2 plasticity and a Mie-Grueneisen equation of state.
struct MaterialParameters {
  std::string name;
  std::string model = "j2_mie_gruneisen";
  double density = 0.0;  ///< kg/m^3
  double young = 0.0;    ///< Pa; with poisson it gives the shear modulus only
  double poisson = 0.0;
  StrengthModel strength = StrengthModel::linear;
  double yield = 0.0;            ///< Pa; this and the next three with linear hardening only
  double hardening = 0.0;        ///< Pa
  double kinematic_share = 0.0;  ///< 0 isotropic ... 1 kinematic
  PlasticHeat plastic_heat = PlasticHeat::work;
  JohnsonCookParameters johnson_cook;
  SteinbergGuinanParameters steinberg_guinan;
  double c0 = 0.0;            ///< m/s, bulk sound speed
  double lambda = 0.0;        ///< slope of Us = c0 + lambda Up
  double gamma = 0.0;         ///< constant Grueneisen coefficient
  double cv = 0.0;            ///< J/(kg K)
  double conductivity = 0.0;  ///< W/(m K)
  double T0 = 300.0;          ///< K
  double spall = 0.0;         ///< Pa, tension at which the material fails; 0 = never
  MeltingLaw melting = MeltingLaw::none;
  MeltParameters melt;

  bool operator==(const MaterialParameters&) const = default;
};

/// J2 plasticity with a Mie-Grueneisen equation of state.
struct Material {
  MieGruneisen eos;
  J2Plasticity strength;
  std::optional<FlowStress> flow;  ///< in place of linear hardening
  TemperatureCurve temperature;
  std::optional<MeltCurve> melt;  ///< where it melts
  PlasticHeat plastic_heat = PlasticHeat::work;
  double conductivity = 0.0;                               ///< W/(m K)
  double spall = std::numeric_limits<double>::infinity();  ///< Pa, infinite where it cannot fail

  /// Energy per mass stored in the deviator, s:s/(4 G rho), J/kg; zero for a fluid.
  double deviatoric_energy(double deviator_square, double density) const {
    return strength.shear > 0.0 ? deviator_square / (4.0 * strength.shear * density) : 0.0;
  }
  /// Energy per mass stored by the back stress when it is not heat, 3 a:a/(4 Hk rho), J/kg.
  double back_stress_energy(double back_stress_square, double density) const {
    return plastic_heat == PlasticHeat::dissipation && strength.kinematic > 0.0
               ? 0.75 * back_stress_square / (strength.kinematic * density)
               : 0.0;
  }
};

/// Constants of a material from its parameters.
Material make_material(const MaterialParameters& parameters);

/// Sets the options of the columns that a material needs. Pure function.
void ask_for_columns(const MaterialParameters& parameters, ParticleOptions& options);

/// State of one particle that its temperature depends on.
struct ThermalState {
  double density = 0.0;             ///< kg/m^3
  double internal_energy = 0.0;     ///< J/kg
  double plastic_work = 0.0;        ///< J/kg
  double conducted_heat = 0.0;      ///< J/kg, paper mode only
  double deviator_square = 0.0;     ///< s:s, Pa^2
  double back_stress_square = 0.0;  ///< Pa^2
  bool failed = false;              ///< spalled: what has opened is not solid
};

/// Temperature and molten share. paper: T_r(V) + (W_p + conducted heat)/c_v (eqs 6, 7); conserving:
/// T_r(V) + (E - E_r(V))/c_v with the elastic deviatoric energy taken off E. A failed particle that
/// has opened has the volume of its solid without load. A material that melts holds T on its melt
/// line while both phases are there (conserving mode only). Not clamped.
MaterialPhase material_phase(const Material& material, Thermal thermal, const ThermalState& state);

/// The temperature alone, K.
inline double temperature(const Material& material, Thermal thermal, const ThermalState& state) {
  return material_phase(material, thermal, state).temperature;
}

/// Longitudinal sound speed of the undisturbed material, m/s.
double longitudinal_sound_speed(const Material& material);

}  // namespace poreshock
