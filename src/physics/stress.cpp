#include "poreshock/physics/stress.hpp"

#include <algorithm>
#include <limits>

#include "poreshock/material/strain.hpp"

namespace poreshock {

namespace {

constexpr std::size_t block_size = 256;

/// A step may change no velocity difference across a particle by more than this strain.
constexpr double largest_strain_increment = 0.2;

/// Squared sound speeds below this share of c0^2 are floored (and counted).
constexpr double sound_speed_floor = 1.0e-4;

/// Per-particle results of one block that are reduced afterwards, in plain loops.
struct BlockResults {
  double limit[block_size];
  double viscous[block_size];
  double eta[block_size];
  double sound_speed2[block_size];
  double volume_ratio[block_size];
  double energy[block_size];
  double travel[block_size];
};

/// Artificial viscosity and stable step of one particle.
struct ViscousStep {
  double pressure, limit;
};

inline ViscousStep viscous_step(const Viscosity& viscosity, double cell, double cfl, double density,
                                double sound_speed, double dilatation, double strain_rate,
                                double speed) {
  const double closing = dilatation < 0.0 ? -(cell * dilatation) : 0.0;
  const double linear = viscosity.linear * sound_speed;
  const double pressure = density * (viscosity.quadratic * (closing * closing) + linear * closing);
  const double Q = linear + viscosity.quadratic * closing;
  const double shock = closing > 0.0 ? Q : 0.0;
  const double wave =
      cfl * cell / (speed + shock + std::sqrt(shock * shock + sound_speed * sound_speed));
  // 1/rate of a particle at rest is infinite, which the comparison handles.
  const double strain = largest_strain_increment / strain_rate;
  return {pressure, wave < strain ? wave : strain};
}

/// Columns of the particles and of the step as raw pointers, for the vectorised loop.
template <int Dim>
struct Columns {
  double *density, *pressure, *viscous_pressure, *energy, *strain, *work;
  const double *mass, *heat, *dilatation_end, *dilatation_mid;
  std::array<double*, symmetric_size<Dim>> deviator, back_stress;
  std::array<const double*, Dim * Dim> gradient;
  std::array<const double*, rate_size<Dim>> rate;
  std::array<const double*, Dim> velocity;
};

template <int Dim>
Columns<Dim> columns(const StepData<Dim>& step, Particles<Dim>& p) {
  Columns<Dim> c;
  c.density = p.density.data();
  c.pressure = p.pressure.data();
  c.viscous_pressure = p.viscous_pressure.data();
  c.energy = p.internal_energy.data();
  c.strain = p.plastic_strain.data();
  c.work = p.plastic_work.data();
  c.mass = p.mass.data();
  c.heat = step.heat.data();
  c.dilatation_end = step.dilatation_end.data();
  c.dilatation_mid = step.dilatation_mid.data();
  for (int k = 0; k < symmetric_size<Dim>; ++k) {
    c.deviator[k] = p.deviator[k].data();
    c.back_stress[k] = p.back_stress[k].data();
  }
  for (int k = 0; k < Dim * Dim; ++k) c.gradient[k] = step.gradient[k].data();
  for (int k = 0; k < rate_size<Dim>; ++k) c.rate[k] = step.rate[k].data();
  for (int k = 0; k < Dim; ++k) c.velocity[k] = p.velocity[k].data();
  return c;
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

/// One particle, load - call - store.
template <int Dim, bool Kinematic, bool Conserving, bool Averaging>
inline void update_particle(const J2MieGruneisen& m, const StressSettings<Dim>& settings, double dt,
                            const Columns<Dim>& c, std::size_t i, std::size_t local,
                            BlockResults& results) {
  constexpr int size = symmetric_size<Dim>;
  SymmetricTensor<Dim> s, alpha{};
  std::array<double, rate_size<Dim>> rate;
  std::array<double, Dim * Dim> F;
  double strain_rate = 0.0, dilatation_end = 0.0, speed = 0.0;
  for (int k = 0; k < size; ++k) s[k] = c.deviator[k][i];
  if constexpr (Kinematic) {
    for (int k = 0; k < size; ++k) alpha[k] = c.back_stress[k][i];
  }
  for (int k = 0; k < rate_size<Dim>; ++k) rate[k] = c.rate[k][i];
  for (int k = 0; k < Dim * Dim; ++k) {
    const double l = c.gradient[k][i];
    const double size_of_l = l < 0.0 ? -l : l;
    strain_rate = size_of_l > strain_rate ? size_of_l : strain_rate;
    const bool diagonal = k % (Dim + 1) == 0;
    if (diagonal) dilatation_end += l;
    F[k] = (diagonal ? 1.0 : 0.0) + dt * l;
  }
  for (int a = 0; a < Dim; ++a) {
    const double v = c.velocity[a][i] - settings.grid_velocity[a];
    const double magnitude = v < 0.0 ? -v : v;
    speed = magnitude > speed ? magnitude : speed;
  }
  const double start_volume = 1.0 / c.density[i];
  const double dilatation_mid = Averaging ? c.dilatation_mid[i] : trace<Dim>(rate);
  const double q = c.viscous_pressure[i];
  const double viscous = -dt * start_volume * q * dilatation_mid;
  const double work =
      dt * start_volume * (power<Dim>(s, rate) - c.pressure[i] * dilatation_mid) + viscous;
  const double energy = c.energy[i] + (work + c.heat[i]);

  const auto increment = deformation_increment(F);
  double ratio = increment.volume_ratio;
  if constexpr (Averaging) {
    ratio *= (1.0 + dt * c.dilatation_end[i]) / (1.0 + dt * dilatation_end);
    dilatation_end = c.dilatation_end[i];
  }
  const double density = c.density[i] / ratio;
  const SymmetricTensor<Dim> start = rotate(increment.rotation, s);
  SymmetricTensor<Dim> trial;
  const double twice_shear = 2.0 * m.strength.shear;
  for (int k = 0; k < size; ++k) trial[k] = start[k] + twice_shear * increment.strain_deviator[k];
  if constexpr (Kinematic) alpha = rotate(increment.rotation, alpha);
  const auto mapped = radial_return<Dim, Kinematic>(m.strength, start, trial, alpha, c.strain[i]);

  const double volume = 1.0 / density;
  const double heat_per_volume =
      m.plastic_heat == PlasticHeat::work ? mapped.plastic_work : mapped.dissipation;
  const double plastic_work = c.work[i] + 0.5 * (start_volume + volume) * heat_per_volume;
  double stored = m.deviatoric_energy(contract<Dim>(mapped.deviator, mapped.deviator), density);
  if constexpr (Kinematic) {
    stored += m.back_stress_energy(contract<Dim>(mapped.back_stress, mapped.back_stress), density);
  }
  const EquationOfState eos = Conserving ? conserving_state(m.eos, density, energy - stored)
                                         : paper_state(m.eos, density, plastic_work);
  const double floor2 = sound_speed_floor * (m.eos.bulk / m.eos.density);
  const double c2 = eos.sound_speed2 > floor2 ? eos.sound_speed2 : floor2;
  const double sound_speed = std::sqrt(c2 + 4.0 * m.strength.shear * volume / 3.0);
  const ViscousStep next = viscous_step(settings.viscosity, settings.cell, settings.cfl, density,
                                        sound_speed, dilatation_end, strain_rate, speed);

  for (int k = 0; k < size; ++k) c.deviator[k][i] = mapped.deviator[k];
  if constexpr (Kinematic) {
    for (int k = 0; k < size; ++k) c.back_stress[k][i] = mapped.back_stress[k];
  }
  c.density[i] = density;
  c.energy[i] = energy;
  c.strain[i] += mapped.plastic_strain_increment;
  c.work[i] = plastic_work;
  c.pressure[i] = eos.pressure;
  c.viscous_pressure[i] = next.pressure;
  results.limit[local] = next.limit;
  results.viscous[local] = c.mass[i] * viscous;
  results.eta[local] = 1.0 - m.eos.density * volume;
  results.sound_speed2[local] = eos.sound_speed2;
  results.volume_ratio[local] = ratio;
  results.energy[local] = energy;
  results.travel[local] = dt * speed;
}

void reduce(const J2MieGruneisen& m, const BlockResults& r, std::size_t count, double cell,
            double inverse_quantum, StressReport& report) {
  const double floor2 = sound_speed_floor * (m.eos.bulk / m.eos.density);
  for (std::size_t k = 0; k < count; ++k) {
    // Written so that a NaN counts as bad. A particle that crosses more than a cell in a step could
    // jump over a whole slab.
    const bool good = r.volume_ratio[k] > 0.5 && r.volume_ratio[k] < 2.0 &&
                      r.energy[k] - r.energy[k] == 0.0 && r.limit[k] > 0.0 && r.travel[k] < cell;
    if (!good) ++report.bad;
    if (good && r.limit[k] < report.dt_limit) report.dt_limit = r.limit[k];
    if (r.eta[k] > m.eos.guard) ++report.compression_guard;
    if (r.sound_speed2[k] <= floor2) ++report.sound_speed_guard;
    if (r.viscous[k] != 0.0) report.viscous_heat += quantise(r.viscous[k], inverse_quantum);
  }
}

template <int Dim, bool Kinematic, bool Conserving, bool Averaging>
void update_block(const J2MieGruneisen& material, const StressSettings<Dim>& all_settings,
                  double dt, const Columns<Dim>& all_columns, std::size_t first, std::size_t count,
                  StressReport& report) {
  BlockResults results;
  // Local copies: the compiler sees that stores through the columns cannot change them.
  const StressSettings<Dim> settings = all_settings;
  const Columns<Dim> c = all_columns;
  J2MieGruneisen m;
  m.eos = material.eos;
  m.strength = material.strength;
  m.plastic_heat = material.plastic_heat;
#pragma GCC ivdep
  for (std::size_t k = 0; k < count; ++k) {
    update_particle<Dim, Kinematic, Conserving, Averaging>(m, settings, dt, c, first + k, k,
                                                           results);
  }
  reduce(m, results, count, settings.cell, settings.inverse_energy_quantum, report);
}

/// Calls visit(material index, first, count) for blocks of stored particles of one material.
template <int Dim, class Visitor>
void for_each_block(const Particles<Dim>& particles, Visitor&& visit) {
  std::size_t first = 0;
  while (first < particles.size()) {
    const std::int32_t material = particles.material[first];
    std::size_t last = first + 1;
    const std::size_t end = std::min(particles.size(), first + block_size);
    while (last < end && particles.material[last] == material) ++last;
    visit(material, first, last - first);
    first = last;
  }
}

template <int Dim, bool Kinematic>
void update_all(const std::vector<Material>& materials, const StressSettings<Dim>& settings,
                const StepData<Dim>& step, double dt, Particles<Dim>& particles,
                StressReport& report) {
  const Columns<Dim> c = columns<Dim>(step, particles);
  const bool conserving = settings.thermal == Thermal::conserving;
  for_each_block<Dim>(particles, [&](std::int32_t material, std::size_t first, std::size_t count) {
    std::visit(
        [&](const auto& m) {
          if (settings.averaging) {
            conserving
                ? update_block<Dim, Kinematic, true, true>(m, settings, dt, c, first, count, report)
                : update_block<Dim, Kinematic, false, true>(m, settings, dt, c, first, count,
                                                            report);
          } else {
            conserving ? update_block<Dim, Kinematic, true, false>(m, settings, dt, c, first, count,
                                                                   report)
                       : update_block<Dim, Kinematic, false, false>(m, settings, dt, c, first,
                                                                    count, report);
          }
        },
        materials[static_cast<std::size_t>(material)]);
  });
}

}  // namespace

template <int Dim>
void update_stress(const std::vector<Material>& materials, const StressSettings<Dim>& settings,
                   const StepData<Dim>& step, double dt, Particles<Dim>& particles,
                   StressReport& report) {
  report.dt_limit = std::numeric_limits<double>::infinity();
  particles.options.back_stress
      ? update_all<Dim, true>(materials, settings, step, dt, particles, report)
      : update_all<Dim, false>(materials, settings, step, dt, particles, report);
}

template <int Dim>
void initialise_stress(const std::vector<Material>& materials, const StressSettings<Dim>& settings,
                       Particles<Dim>& particles, StressReport& report) {
  // A step of no length: all rates are zero, so only pressure, viscosity and the limit are set.
  StepData<Dim> still;
  still.resize(particles.size(), settings.averaging);
  update_stress<Dim>(materials, settings, still, 0.0, particles, report);
}

template void update_stress<2>(const std::vector<Material>&, const StressSettings<2>&,
                               const StepData<2>&, double, Particles<2>&, StressReport&);
template void update_stress<3>(const std::vector<Material>&, const StressSettings<3>&,
                               const StepData<3>&, double, Particles<3>&, StressReport&);
template void initialise_stress<2>(const std::vector<Material>&, const StressSettings<2>&,
                                   Particles<2>&, StressReport&);
template void initialise_stress<3>(const std::vector<Material>&, const StressSettings<3>&,
                                   Particles<3>&, StressReport&);

}  // namespace poreshock
