#include "poreshock/physics/stress.hpp"

#include <algorithm>
#include <limits>

#include "stress_point.hpp"

namespace poreshock {

namespace {

// Not part of the flattened loop.
[[gnu::noinline]] void reduce(const J2MieGruneisen& m, const BlockResults& r, std::size_t count,
                              double cell, double inverse_quantum, StressReport& report) {
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

// Flattened: the loop vectorises only when all it calls is inlined, and with so many variants the
// compiler would stop.
template <int Dim, bool Kinematic, bool Spall, bool Conserving, bool Averaging>
[[gnu::flatten]] void update_block(const J2MieGruneisen& material,
                                   const StressSettings<Dim>& all_settings, double dt,
                                   const Columns<Dim>& all_columns, std::size_t first,
                                   std::size_t count, StressReport& report) {
  BlockResults results;
  // Local copies: the compiler sees that stores through the columns cannot change them.
  const StressSettings<Dim> settings = all_settings;
  const Columns<Dim> c = all_columns;
  J2MieGruneisen m;
  m.eos = material.eos;
  m.strength = material.strength;
  m.plastic_heat = material.plastic_heat;
  m.spall = material.spall;
#pragma GCC ivdep
  for (std::size_t k = 0; k < count; ++k) {
    update_particle<Dim, Kinematic, Spall, Conserving, Averaging>(m, settings, dt, c, first + k, k,
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

template <int Dim, bool Kinematic, bool Spall>
void update_all(const std::vector<Material>& materials, const StressSettings<Dim>& settings,
                const StepData<Dim>& step, double dt, Particles<Dim>& particles,
                StressReport& report) {
  const Columns<Dim> c = columns<Dim>(step, particles);
  const bool conserving = settings.thermal == Thermal::conserving;
  for_each_block<Dim>(particles, [&](std::int32_t material, std::size_t first, std::size_t count) {
    std::visit(
        [&](const auto& m) {
          if (settings.averaging) {
            conserving ? update_block<Dim, Kinematic, Spall, true, true>(m, settings, dt, c, first,
                                                                         count, report)
                       : update_block<Dim, Kinematic, Spall, false, true>(m, settings, dt, c, first,
                                                                          count, report);
          } else {
            conserving ? update_block<Dim, Kinematic, Spall, true, false>(m, settings, dt, c, first,
                                                                          count, report)
                       : update_block<Dim, Kinematic, Spall, false, false>(m, settings, dt, c,
                                                                           first, count, report);
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
  if (particles.options.failed) {
    particles.options.back_stress
        ? update_all<Dim, true, true>(materials, settings, step, dt, particles, report)
        : update_all<Dim, false, true>(materials, settings, step, dt, particles, report);
  } else {
    particles.options.back_stress
        ? update_all<Dim, true, false>(materials, settings, step, dt, particles, report)
        : update_all<Dim, false, false>(materials, settings, step, dt, particles, report);
  }
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
