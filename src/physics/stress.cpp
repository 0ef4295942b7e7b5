#include "poreshock/physics/stress.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

#include "flow_increments.hpp"
#include "stress_point.hpp"

namespace poreshock {

namespace {

/// Numbers of one block: particles whose state is no longer one, those that met a guard, and the
/// bits of the least limit.
struct BlockCounts {
  std::int64_t bad = 0, compressed = 0, slow = 0;
  std::int64_t least = std::bit_cast<std::int64_t>(std::numeric_limits<double>::infinity());
};

// Integers of 64 bits only, in variables of their own, and no jumps: then the loop vectorises
// without leave to reorder sums of doubles.
[[gnu::noinline]] BlockCounts count_block(const Material& m, const BlockResults& r,
                                          std::size_t count, double cell) {
  using Flag = std::int64_t;
  constexpr BlockCounts none;
  const double floor2 = sound_speed_floor * (m.eos.bulk / m.eos.density);
  const double guard = m.eos.guard;
  std::int64_t bad = 0, compressed = 0, slow = 0, least = none.least;
  for (std::size_t k = 0; k < count; ++k) {
    // Written so that a NaN counts as bad. A particle that crosses more than a cell in a step could
    // jump over a whole slab.
    const Flag good = Flag{r.volume_ratio[k] > 0.5} & Flag{r.volume_ratio[k] < 2.0} &
                      Flag{r.energy[k] - r.energy[k] == 0.0} & Flag{r.limit[k] > 0.0} &
                      Flag{r.travel[k] < cell};
    bad += 1 - good;
    compressed += Flag{r.eta[k] > guard};
    slow += Flag{r.sound_speed2[k] <= floor2};
    // Bits of positive numbers are in their order.
    const std::int64_t limit = good != 0 ? std::bit_cast<std::int64_t>(r.limit[k]) : none.least;
    least = limit < least ? limit : least;
  }
  return {bad, compressed, slow, least};
}

Int128 sum_of_block(const double* energies, std::size_t count, double inverse_quantum) {
  Int128 sum = 0;
  for (std::size_t k = 0; k < count; k += lane_count) {
    const auto part = static_cast<int>(std::min<std::size_t>(lane_count, count - k));
    sum += sum_of_quanta(*reinterpret_cast<const Lanes*>(energies + k), part, inverse_quantum);
  }
  return sum;
}

void reduce(const Material& m, const BlockResults& r, std::size_t count, double cell,
            double inverse_quantum, StressReport& report) {
  const BlockCounts c = count_block(m, r, count, cell);
  report.bad += c.bad;
  report.compression_guard += c.compressed;
  report.sound_speed_guard += c.slow;
  report.dt_limit = std::min(report.dt_limit, std::bit_cast<double>(c.least));
  report.viscous_heat += sum_of_block(r.viscous, count, inverse_quantum);
  report.compression_work += sum_of_block(r.compression, count, inverse_quantum);
  report.step_heat += sum_of_block(r.unstored, count, inverse_quantum);
  if (std::isfinite(m.spall))
    report.failure_heat += sum_of_block(r.released, count, inverse_quantum);
}

// Flattened: the loop vectorises only when all it calls is inlined, and with so many variants the
// compiler would stop.
template <int Dim, Yielding How, bool Spall, bool Conserving>
[[gnu::flatten]] void update_block(const Material& material,
                                   const StressSettings<Dim>& all_settings, double dt,
                                   const Columns<Dim>& all_columns, std::size_t count,
                                   StressReport& report) {
  BlockResults results;
  // Local copies: the compiler sees that stores through the columns cannot change them.
  const StressSettings<Dim> settings = all_settings;
  const Columns<Dim> c = all_columns;
  Material m;
  m.eos = material.eos;
  m.strength = material.strength;
  m.plastic_heat = material.plastic_heat;
  m.spall = material.spall;
  m.spall_time = material.spall_time;
  m.opened_tension = material.opened_tension;
  const double lone = lone_rate<Dim>(settings, m);
#pragma GCC ivdep
  for (std::size_t k = 0; k < count; ++k) {
    update_particle<Dim, How, Spall, Conserving>(m, settings, dt, lone, c, k, results);
  }
  reduce(m, results, count, settings.cell, settings.inverse_energy_quantum, report);
}

template <class T>
struct alignas(64) BlockColumn {
  T values[block_size];
};

/// Copies of the particles of one block side by side, where their columns have them scattered.
template <int Dim>
using BlockCopy = ParticleColumns<Dim, BlockColumn>;

/// Calls visit(use, column of `all`, of `block`, of `copy`) for all columns that the update needs.
template <int Dim, class Visitor>
void for_each_stress_column(const ParticlePointers<Dim>& all, ParticlePointers<Dim>& block,
                            BlockCopy<Dim>& copy, Visitor&& visit) {
  const auto at = [&]<std::size_t I>() {
    // Constants: looked up at run time, the tables cost more than the copies.
    constexpr auto entry = std::get<I>(ParticlePointers<Dim>::columns());
    constexpr auto member = std::get<I>(BlockCopy<Dim>::columns()).member;
    if constexpr (entry.use.stress != InStress::unused) {
      if (entry.use.option != nullptr && !(all.options.*entry.use.option)) return;
      for_each_component([&](int, auto* source, auto*& local,
                             auto& room) { visit(entry.use.stress, source, local, room.values); },
                         all.*entry.member, block.*entry.member, copy.*member);
    }
  };
  [&]<std::size_t... I>(std::index_sequence<I...>) {
    (at.template operator()<I>(), ...);
  }
  (std::make_index_sequence<std::tuple_size_v<decltype(BlockCopy<Dim>::columns())>>{});
}

template <int Dim>
ParticlePointers<Dim> pointers_to(Particles<Dim>& particles) {
  ParticlePointers<Dim> pointers{};
  for_each_entry(
      [](const auto&, auto& vectors, auto& targets) {
        for_each_component([](int, auto& vector, auto& target) { target = vector.data(); }, vectors,
                           targets);
      },
      particles, pointers);
  pointers.options = particles.options;
  return pointers;
}

bool side_by_side(std::span<const std::uint32_t> places) {
  bool adjacent = true;
  for (std::size_t k = 1; k < places.size(); ++k) adjacent = adjacent && places[k] == places[0] + k;
  return adjacent;
}

/// The columns of a block of particles: in place where they lie side by side, else copied.
template <int Dim>
ParticlePointers<Dim> fetch(const ParticlePointers<Dim>& all, std::span<const std::uint32_t> places,
                            bool adjacent, BlockCopy<Dim>& copy) {
  ParticlePointers<Dim> block{};
  for_each_stress_column<Dim>(all, block, copy,
                              [&](InStress, auto* source, auto*& local, auto* room) {
                                if (adjacent) {
                                  local = source + places[0];
                                  return;
                                }
                                local = room;
                                for (std::size_t k = 0; k < places.size(); ++k)
                                  local[k] = source[places[k]];
                              });
  return block;
}

/// Puts the changed columns of a copied block back.
template <int Dim>
void put_back(const ParticlePointers<Dim>& all, std::span<const std::uint32_t> places,
              ParticlePointers<Dim>& block, BlockCopy<Dim>& copy) {
  for_each_stress_column<Dim>(all, block, copy,
                              [&](InStress use, auto* target, auto*& local, auto*) {
                                if (use != InStress::changed) return;
                                for (std::size_t k = 0; k < places.size(); ++k)
                                  target[places[k]] = local[k];
                              });
}

/// Calls visit(material index, first, count) for blocks of particles of one material.
template <int Dim, class Visitor>
void for_each_block(const Particles<Dim>& particles, std::span<const std::uint32_t> places,
                    Visitor&& visit) {
  std::size_t first = 0;
  while (first < places.size()) {
    const std::int32_t material = particles.material[places[first]];
    std::size_t last = first + 1;
    const std::size_t end = std::min(places.size(), first + block_size);
    while (last < end && particles.material[places[last]] == material) ++last;
    visit(material, first, last - first);
    first = last;
  }
}

template <int Dim, Yielding How, bool Spall>
void update_in_mode(const Material& m, const StressSettings<Dim>& settings, double dt,
                    const Columns<Dim>& c, std::size_t count, StressReport& report) {
  settings.thermal == Thermal::conserving
      ? update_block<Dim, How, Spall, true>(m, settings, dt, c, count, report)
      : update_block<Dim, How, Spall, false>(m, settings, dt, c, count, report);
}

template <int Dim, Yielding How, bool Spall>
void update_all(const std::vector<Material>& materials, const StressSettings<Dim>& settings,
                const StepData<Dim>& step, double dt, std::span<const std::uint32_t> places,
                Particles<Dim>& particles, StressReport& report) {
  const ParticlePointers<Dim> all = pointers_to(particles);
  BlockCopy<Dim> copy;
  double increments[block_size];
  for_each_block<Dim>(
      particles, places, [&](std::int32_t material, std::size_t first, std::size_t count) {
        const auto block = places.subspan(first, count);
        const bool adjacent = side_by_side(block);
        Columns<Dim> c{};
        c.particle = fetch<Dim>(all, block, adjacent, copy);
        set_step_columns<Dim>(step, first, c);
        const auto& m = materials[static_cast<std::size_t>(material)];
        if (plastic_increments<Dim>(materials, settings.thermal, particles, block, c, dt,
                                    increments)) {
          c.plastic_increment = increments;
          update_in_mode<Dim, Yielding::known, Spall>(m, settings, dt, c, count, report);
        } else {
          update_in_mode<Dim, How, Spall>(m, settings, dt, c, count, report);
        }
        if (!adjacent) put_back<Dim>(all, block, c.particle, copy);
      });
}

}  // namespace

template <int Dim>
double lone_rate(const StressSettings<Dim>& settings, const Material& material) {
  const double bulk = material.eos.bulk, shear = material.strength.shear;
  const double swinging = bulk + (Dim == 2 ? shear / 3.0 : 0.0);
  const double stiffness = Dim * settings.stiffness;
  const double elastic = stiffness * swinging / (bulk + 4.0 / 3.0 * shear);
  const double viscous = stiffness * settings.viscosity.linear;
  return 0.25 * (viscous + std::sqrt(viscous * viscous + 4.0 * elastic));
}

template <int Dim>
void update_stress(const std::vector<Material>& materials, const StressSettings<Dim>& settings,
                   const StepData<Dim>& step, double dt, std::span<const std::uint32_t> places,
                   Particles<Dim>& particles, StressReport& report) {
  constexpr Yielding isotropic = Yielding::isotropic, kinematic = Yielding::kinematic;
  if (particles.options.failed) {
    particles.options.back_stress
        ? update_all<Dim, kinematic, true>(materials, settings, step, dt, places, particles, report)
        : update_all<Dim, isotropic, true>(materials, settings, step, dt, places, particles,
                                           report);
  } else {
    particles.options.back_stress ? update_all<Dim, kinematic, false>(materials, settings, step, dt,
                                                                      places, particles, report)
                                  : update_all<Dim, isotropic, false>(materials, settings, step, dt,
                                                                      places, particles, report);
  }
}

template <int Dim>
void initialise_stress(const std::vector<Material>& materials, const StressSettings<Dim>& settings,
                       Particles<Dim>& particles, StressReport& report) {
  // A step of no length: all rates are zero, so only pressure, viscosity and the limit are set.
  report = {};
  constexpr std::size_t chunk = 4096;
  StepData<Dim> still;
  resize_ordered(chunk, still);
  std::vector<std::uint32_t> places;
  for (std::size_t first = 0; first < particles.size(); first += chunk) {
    places.resize(std::min(chunk, particles.size() - first));
    std::iota(places.begin(), places.end(), static_cast<std::uint32_t>(first));
    update_stress<Dim>(materials, settings, still, 0.0, places, particles, report);
  }
}

template double lone_rate<2>(const StressSettings<2>&, const Material&);
template double lone_rate<3>(const StressSettings<3>&, const Material&);
template void update_stress<2>(const std::vector<Material>&, const StressSettings<2>&,
                               const StepData<2>&, double, std::span<const std::uint32_t>,
                               Particles<2>&, StressReport&);
template void update_stress<3>(const std::vector<Material>&, const StressSettings<3>&,
                               const StepData<3>&, double, std::span<const std::uint32_t>,
                               Particles<3>&, StressReport&);
template void initialise_stress<2>(const std::vector<Material>&, const StressSettings<2>&,
                                   Particles<2>&, StressReport&);
template void initialise_stress<3>(const std::vector<Material>&, const StressSettings<3>&,
                                   Particles<3>&, StressReport&);

}  // namespace poreshock
