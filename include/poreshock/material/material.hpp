#pragma once
// Materials: their parameters as a scene states them, the constants kernels use, and what follows
// from a particle's state. There is one model, of parts: equation of state, strength and heat.

#include <limits>
#include <optional>
#include <string>
#include <variant>

#include "poreshock/material/flow_stress.hpp"
#include "poreshock/material/j2_plasticity.hpp"
#include "poreshock/material/melting.hpp"
#include "poreshock/material/mie_gruneisen.hpp"
#include "poreshock/particles/particles.hpp"

namespace poreshock {

enum class Thermal { paper, conserving };
enum class PlasticHeat { work, dissipation };

/// How the yield stress changes; a flow law has an entry in for_each_flow_law.
enum class StrengthModel { linear, johnson_cook, steinberg_guinan };

/// A flow stress in place of linear hardening, or none.
using FlowLaw = std::variant<std::monostate, FlowStress>;

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
  double spall = 0.0;         ///< Pa, tension at which the material opens; 0 = never
  double spall_time = 0.0;    ///< s, for which it opens before it fails; 0 = by the cells
  MeltingLaw melting = MeltingLaw::none;
  MeltParameters melt;

  bool operator==(const MaterialParameters&) const = default;
};

/// Calls visit(model, parameters) for each flow law; the parameters tell their keys and the law.
template <class Parameters, class Visitor>
void for_each_flow_law(Parameters& material, Visitor&& visit) {
  visit(StrengthModel::johnson_cook, material.johnson_cook);
  visit(StrengthModel::steinberg_guinan, material.steinberg_guinan);
}

/// J2 plasticity with a Mie-Grueneisen equation of state.
struct Material {
  MieGruneisen eos;
  J2Plasticity strength;
  FlowLaw flow;
  TemperatureCurve temperature;
  std::optional<MeltCurve> melt;  ///< where it melts
  PlasticHeat plastic_heat = PlasticHeat::work;
  double conductivity = 0.0;                               ///< W/(m K)
  double spall = std::numeric_limits<double>::infinity();  ///< Pa, infinite where it cannot fail
  double spall_time = 0.0;  ///< s, for which it opens before it fails; 0 = by the cells
  /// Pa, of the solid at the volume at which it fails: a share of it has opened by then.
  double opened_tension = std::numeric_limits<double>::infinity();

  /// Energy per mass stored in the deviator, s:s/(4 G rho), J/kg; zero for a fluid.
  double deviatoric_energy(double deviator_square, double density) const {
    return strength.shear > 0.0 ? deviator_square / (4.0 * strength.shear * density) : 0.0;
  }
  /// Energy per mass stored by the back stress when it is not heat, 3 a:a/(4 Hk rho), J/kg.
  double back_stress_energy(double back_stress_square, double density) const {
    // The same for all particles of a loop, so it is chosen outside.
    const bool stores = plastic_heat == PlasticHeat::dissipation && strength.kinematic > 0.0;
    const double modulus = stores ? strength.kinematic : std::numeric_limits<double>::infinity();
    return 0.75 * back_stress_square / (modulus * density);
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
  bool failed = false;              ///< spalled: bears no tension
};

/// Temperature and molten share. paper: T_r(V) + (W_p + conducted heat)/c_v (eqs 6, 7); conserving:
/// T_r(V) + (E - E_r(V))/c_v with the elastic deviatoric energy taken off E. Where it has
/// opened, its solid has the volume at the spall strength, failed that without load. A material
/// that melts holds T on its melt line while both phases are there (conserving mode only). Not
/// clamped.
MaterialPhase material_phase(const Material& material, Thermal thermal, const ThermalState& state);

/// The temperature alone, K.
inline double temperature(const Material& material, Thermal thermal, const ThermalState& state) {
  return material_phase(material, thermal, state).temperature;
}

/// Longitudinal sound speed of the undisturbed material, m/s.
double longitudinal_sound_speed(const Material& material);

}  // namespace poreshock
