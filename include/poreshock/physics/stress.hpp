#pragma once
// Constitutive update of every particle: density, rotation, strength, equation of state, artificial
// viscosity and energy.

#include <limits>
#include <span>

#include "poreshock/core/fixed_point.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/scene/scene.hpp"
#include "poreshock/transfer/step_data.hpp"

namespace poreshock {

/// What the update needs besides the particles.
template <int Dim>
struct StressSettings {
  Thermal thermal = Thermal::conserving;
  Viscosity viscosity;
  double cell = 0.0;  ///< m, length of the artificial viscosity
  double cfl = 0.5;
  double stiffness = 0.0;  ///< per axis and squared cell, of a particle alone; 0 without a bound
  Vector<Dim> grid_velocity = Vector<Dim>::Zero();
  double inverse_energy_quantum = 1.0;
};

/// What the update reports about this rank's particles.
struct StressReport {
  /// s, largest stable next step; cfl included
  double dt_limit = std::numeric_limits<double>::infinity();
  std::int64_t bad = 0;                ///< particles with a state that is not finite or inverted
  std::int64_t compression_guard = 0;  ///< particles beyond the guard of the reference curve
  std::int64_t sound_speed_guard = 0;  ///< particles whose sound speed had to be floored
  Int128 viscous_heat = 0;             ///< quanta, like the following
  /// Work of the pressure: the mean of those before and after the step, times the change of volume.
  Int128 compression_work = 0;
  /// Work of the stress less that of the pressure, what the deviator and a back stress store, and
  /// plastic work: the nodes give that of the stress of the start at the mean of their velocities.
  Int128 step_heat = 0;
  Int128 failure_heat = 0;  ///< what the deviators of particles that fail stored
};

/// What a particle without neighbours bounds the step to, as sound speeds per cell. Alone it moves
/// nodes that are as light as their weight, so all of it swings: with the stiffness S, elastic e =
/// Dim S (K + G/3 or, in 3-D, K)/(rho c^2) and viscous v = Dim S C_l, the force of the state before
/// a step of h/(r c) is stable while e/r^2 + 2 v/r < 4. Among neighbours it is less stiff. Not
/// collective.
template <int Dim>
double lone_rate(const StressSettings<Dim>& settings, const Material& material);

/// Advances the state of the particles at `places`, indices into the columns; entry k of the step
/// data is for places[k]. The report is added to (numerics: incremental polar decomposition, radial
/// return, energy from the grid's stress power with the stress of the start of the step, so that
/// the sum of kinetic and internal energy closes). A particle opens at its spall strength, and
/// fails for good when it has opened for the time of its material, or by a share of its volume:
/// from then on it bears neither tension nor shear. Not collective.
template <int Dim>
void update_stress(const std::vector<Material>& materials, const StressSettings<Dim>& settings,
                   const StepData<Dim>& step, double dt, std::span<const std::uint32_t> places,
                   Particles<Dim>& particles, StressReport& report);

/// Pressure, viscosity zero, and the stable step of the initial state, in a new report. Not
/// collective.
template <int Dim>
void initialise_stress(const std::vector<Material>& materials, const StressSettings<Dim>& settings,
                       Particles<Dim>& particles, StressReport& report);

}  // namespace poreshock
