#pragma once
// The constitutive update of one particle, load - call - store, written so that the loop over
// particles vectorises: selects instead of branches, everything inlined.

#include <array>
#include <cmath>

#include "poreshock/material/flow_stress.hpp"
#include "poreshock/material/strain.hpp"
#include "poreshock/physics/stress.hpp"

namespace poreshock {

constexpr std::size_t block_size = 64;

/// A step may change no velocity difference across a particle by more than this strain.
constexpr double largest_strain_increment = 0.2;

/// Squared sound speeds below this share of c0^2 are floored (and counted).
constexpr double sound_speed_floor = 1.0e-4;

/// Below this share of the sound speed a closing cell meets less and less linear viscosity: else
/// rounding would decide about the step.
constexpr double least_closing = 1.0e-6;

/// Per-particle results of one block that are reduced afterwards, in plain loops.
struct BlockResults {
  double limit[block_size];
  double viscous[block_size];      ///< J, like the next three
  double compression[block_size];  ///< work of the pressure
  double unstored[block_size];     ///< work that the material neither stores nor dissipates
  double released[block_size];     ///< elastic energy of a deviator that failed
  double eta[block_size];
  double sound_speed2[block_size];
  double volume_ratio[block_size];
  double energy[block_size];
  double travel[block_size];
};

/// Particles and what the step found for them as raw pointers, for the vectorised loop.
template <int Dim>
struct Columns {
  ParticlePointers<Dim> particle;
  const double *heat, *viscous_linear, *viscous_quadratic;
  const double* plastic_increment;  // null unless known beforehand
  std::array<const double*, Dim * Dim> gradient;
  std::array<const double*, rate_size<Dim>> rate;
};

/// Points the step's columns to entry `first`.
template <int Dim>
void set_step_columns(const StepData<Dim>& step, std::size_t first, Columns<Dim>& c) {
  c.heat = step.heat.data() + first;
  c.viscous_linear = step.viscous_linear.data() + first;
  c.viscous_quadratic = step.viscous_quadratic.data() + first;
  for (int k = 0; k < Dim * Dim; ++k) c.gradient[k] = step.gradient[k].data() + first;
  for (int k = 0; k < rate_size<Dim>; ++k) c.rate[k] = step.rate[k].data() + first;
}

/// s : D of a deviator and a rate.
template <int Dim>
inline double power(const SymmetricTensor<Dim>& s, const std::array<double, rate_size<Dim>>& d) {
  if constexpr (Dim == 2) {
    return (s[0] * d[0] + s[1] * d[1]) + 2.0 * (s[3] * d[2]);
  } else {
    return ((s[0] * d[0] + s[1] * d[1]) + s[2] * d[2]) +
           2.0 * ((s[3] * d[3] + s[4] * d[4]) + s[5] * d[5]);
  }
}

template <int Dim>
inline double trace(const std::array<double, rate_size<Dim>>& d) {
  return Dim == 2 ? d[0] + d[1] : (d[0] + d[1]) + d[2];
}

/// Motion of one particle over the step.
template <int Dim>
struct Motion {
  std::array<double, Dim * Dim> F;          ///< I + dt grad v
  std::array<double, rate_size<Dim>> rate;  ///< 1/s
  double strain_rate = 0.0;                 ///< 1/s, largest component of the gradient
  double dilatation = 0.0;                  ///< 1/s, at the end of the step
  double speed = 0.0;                       ///< m/s, largest component relative to the grid
};

template <int Dim>
inline Motion<Dim> load_motion(const StressSettings<Dim>& settings, double dt,
                               const Columns<Dim>& c, std::size_t i) {
  Motion<Dim> motion;
  for (int k = 0; k < rate_size<Dim>; ++k) motion.rate[k] = c.rate[k][i];
  for (int k = 0; k < Dim * Dim; ++k) {
    const double l = c.gradient[k][i];
    const double size_of_l = l < 0.0 ? -l : l;
    motion.strain_rate = size_of_l > motion.strain_rate ? size_of_l : motion.strain_rate;
    const bool diagonal = k % (Dim + 1) == 0;
    if (diagonal) motion.dilatation += l;
    motion.F[k] = (diagonal ? 1.0 : 0.0) + dt * l;
  }
  for (int a = 0; a < Dim; ++a) {
    const double v = c.particle.velocity[a][i] - settings.grid_velocity[a];
    const double magnitude = v < 0.0 ? -v : v;
    motion.speed = magnitude > motion.speed ? magnitude : motion.speed;
  }
  return motion;
}

/// Shares of the two artificial viscosities that act.
struct ActingShares {
  double linear, quadratic;
};

/// Artificial viscosity and stable step of one particle.
struct ViscousStep {
  double pressure, limit;
};

/// `lone` is what a particle alone bounds the step to, in sound speeds per cell.
template <int Dim>
inline ViscousStep viscous_step(const StressSettings<Dim>& settings, double lone,
                                const Motion<Dim>& motion, ActingShares shares, double density,
                                double sound_speed) {
  const double cell = settings.cell;
  const double closing = motion.dilatation < 0.0 ? -(cell * motion.dilatation) : 0.0;
  // With what really acts, so that smooth flow pays nothing.
  const double share = settings.viscosity.linear * shares.linear *
                       (closing / (closing + least_closing * sound_speed));
  const double Q = share * sound_speed + settings.viscosity.quadratic * shares.quadratic * closing;
  const double pressure = density * (Q * closing);
  // What divides is the same for all particles of a loop.
  const double wave = (motion.speed + Q + std::sqrt(Q * Q + sound_speed * sound_speed)) *
                      (1.0 / (settings.cfl * cell));
  const double alone = (motion.speed + lone * sound_speed) * (1.0 / cell);
  const double strain = motion.strain_rate * (1.0 / largest_strain_increment);
  const double rate = wave > alone ? wave : alone;
  return {pressure, 1.0 / (rate > strain ? rate : strain)};
}

/// Energy per mass that the deviator stores, and the back stress where it does.
template <int Dim, bool Kinematic>
inline double stored_energy(const Material& m, const SymmetricTensor<Dim>& deviator,
                            const SymmetricTensor<Dim>& back_stress, double density) {
  double stored = m.deviatoric_energy(contract<Dim>(deviator, deviator), density);
  if constexpr (Kinematic) {
    stored += m.back_stress_energy(contract<Dim>(back_stress, back_stress), density);
  }
  return stored;
}

/// How a particle yields: by linear hardening without or with a back stress, or by a flow stress
/// whose plastic increment is known beforehand.
enum class Yielding { isotropic, kinematic, known };

/// Deviator of the start of the step, rotated to its end, and what it would be without plasticity.
template <int Dim>
struct TrialStress {
  SymmetricTensor<Dim> start, trial;
};

template <int Dim>
inline TrialStress<Dim> trial_stress(const DeformationIncrement<Dim>& increment,
                                     const SymmetricTensor<Dim>& s, double shear) {
  TrialStress<Dim> t;
  t.start = rotate(increment.rotation, s);
  const double twice_shear = 2.0 * shear;
  for (int k = 0; k < symmetric_size<Dim>; ++k) {
    t.trial[k] = t.start[k] + twice_shear * increment.strain_deviator[k];
  }
  return t;
}

/// Cells that sound crosses while a particle opens at its strength, where the material has no time
/// of its own: a front spans some cells, and what failed at once would take back the tension before
/// its peak has passed.
constexpr double held_cells = 32.0;

/// The new entry of a column `failed`: 1 where a particle fails, else how long it has opened at its
/// strength, in millionths of the time for which it does, negative.
inline std::int32_t held_tension(const Material& m, double cell, double dt, double pressure,
                                 std::int32_t before) {
  constexpr std::int32_t longest = -1000000;
  const double crossing = held_cells * cell / std::sqrt(m.eos.bulk / m.eos.density);
  const double share = dt / (m.spall_time > 0.0 ? m.spall_time : crossing);
  const auto part = static_cast<std::int32_t>(1e6 * (share < 1.0 ? share : 1.0));
  const std::int32_t held = pressure < -m.spall ? before - part : 0;
  const bool fails = before > 0 || held <= longest || pressure < -m.opened_tension;
  return fails ? 1 : held;
}

/// A particle opens at its spall strength and bears no more tension. A failed one bears neither
/// tension nor shear. The elastic energy it held is heat from now on, since it stays in the
/// internal energy. The solid of what has opened is near its volume at rest.
template <int Dim>
inline void release(const Material& m, bool fails, ReturnMapping<Dim>& mapped,
                    EquationOfState& eos) {
  const double least = fails ? 0.0 : -m.spall;
  const bool open = eos.pressure < least;
  eos.pressure = open ? least : eos.pressure;
  eos.sound_speed2 = open ? m.eos.bulk / m.eos.density : eos.sound_speed2;
  for (int k = 0; k < symmetric_size<Dim>; ++k) {
    mapped.deviator[k] = fails ? 0.0 : mapped.deviator[k];
    mapped.back_stress[k] = fails ? 0.0 : mapped.back_stress[k];
  }
}

template <int Dim, bool Kinematic>
inline void store_stress(const ReturnMapping<Dim>& mapped, const ParticlePointers<Dim>& p,
                         std::size_t i) {
  for (int k = 0; k < symmetric_size<Dim>; ++k) {
    p.deviator[k][i] = mapped.deviator[k];
    if constexpr (Kinematic) p.back_stress[k][i] = mapped.back_stress[k];
  }
}

/// One particle, load - call - store.
template <int Dim, Yielding How, bool Spall, bool Conserving>
inline void update_particle(const Material& m, const StressSettings<Dim>& settings, double dt,
                            double lone, const Columns<Dim>& c, std::size_t i,
                            BlockResults& results) {
  const ParticlePointers<Dim>& p = c.particle;
  constexpr bool kinematic = How == Yielding::kinematic;
  constexpr int size = symmetric_size<Dim>;
  SymmetricTensor<Dim> s, alpha{};
  for (int k = 0; k < size; ++k) s[k] = p.deviator[k][i];
  if constexpr (kinematic) {
    for (int k = 0; k < size; ++k) alpha[k] = p.back_stress[k][i];
  }
  const double stored_before = stored_energy<Dim, kinematic>(m, s, alpha, p.density[i]);
  const Motion<Dim> motion = load_motion<Dim>(settings, dt, c, i);
  const double start_volume = 1.0 / p.density[i];
  const double dilatation = trace<Dim>(motion.rate);
  const double q = p.viscous_pressure[i];
  const double viscous = -dt * start_volume * q * dilatation;
  const double work =
      dt * start_volume * (power<Dim>(s, motion.rate) - p.pressure[i] * dilatation) + viscous;
  const double energy = p.internal_energy[i] + (work + c.heat[i]);

  const auto increment = deformation_increment(motion.F);
  const double ratio = increment.volume_ratio;
  const double density = p.density[i] / ratio;
  const bool failed_before = Spall && p.failed[i] > 0;
  const auto [start, trial] =
      trial_stress<Dim>(increment, s, failed_before ? 0.0 : m.strength.shear);
  if constexpr (kinematic) alpha = rotate(increment.rotation, alpha);
  ReturnMapping<Dim> mapped;
  if constexpr (How == Yielding::known) {
    mapped = return_by<Dim>(c.plastic_increment[i], m.strength.shear, start, trial);
  } else {
    mapped = radial_return<Dim, kinematic>(m.strength, start, trial, alpha, p.plastic_strain[i]);
  }

  const double volume = 1.0 / density;
  const double heat_per_volume =
      m.plastic_heat == PlasticHeat::work ? mapped.plastic_work : mapped.dissipation;
  const double plastic_work = p.plastic_work[i] + 0.5 * (start_volume + volume) * heat_per_volume;
  const double stored =
      stored_energy<Dim, kinematic>(m, mapped.deviator, mapped.back_stress, density);
  EquationOfState eos = Conserving ? conserving_state(m.eos, density, energy - stored)
                                   : paper_state(m.eos, density, plastic_work);
  if constexpr (Spall) {
    const std::int32_t held = held_tension(m, settings.cell, dt, eos.pressure, p.failed[i]);
    const bool fails = held > 0;
    if constexpr (Conserving) eos.pressure += fails ? m.eos.gamma * density * stored : 0.0;
    release<Dim>(m, fails, mapped, eos);
    results.released[i] = fails ? p.mass[i] * stored : 0.0;
    p.failed[i] = held;
  }
  const double floor2 = sound_speed_floor * (m.eos.bulk / m.eos.density);
  const double c2 = eos.sound_speed2 > floor2 ? eos.sound_speed2 : floor2;
  const double sound_speed = std::sqrt(c2 + 4.0 / 3.0 * m.strength.shear * volume);
  const ActingShares shares = {c.viscous_linear[i], c.viscous_quadratic[i]};
  const ViscousStep next = viscous_step<Dim>(settings, lone, motion, shares, density, sound_speed);

  const double compression = 0.5 * (p.pressure[i] + eos.pressure) * (start_volume - volume);
  const double kept = (stored - stored_before) + (plastic_work - p.plastic_work[i]);
  results.compression[i] = p.mass[i] * compression;
  results.unstored[i] = p.mass[i] * (((work - viscous) - compression) - kept);
  store_stress<Dim, kinematic>(mapped, p, i);
  p.density[i] = density;
  p.internal_energy[i] = energy;
  p.plastic_strain[i] += mapped.plastic_strain_increment;
  p.plastic_work[i] = plastic_work;
  p.pressure[i] = eos.pressure;
  p.viscous_pressure[i] = next.pressure;
  results.limit[i] = next.limit;
  results.viscous[i] = p.mass[i] * viscous;
  results.eta[i] = 1.0 - m.eos.density * volume;
  results.sound_speed2[i] = eos.sound_speed2;
  results.volume_ratio[i] = ratio;
  results.energy[i] = energy;
  results.travel[i] = dt * motion.speed;
}

}  // namespace poreshock
