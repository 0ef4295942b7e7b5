#include "poreshock/solver/ledger.hpp"

#include <algorithm>
#include <cmath>

#include "poreshock/core/parallel.hpp"
#include "poreshock/particles/derived.hpp"

namespace poreshock {

namespace {

/// Quanta per reference energy of a particle: 2^50 leaves a factor 2^12 for hot particles.
constexpr double quanta_per_particle = 1125899906842624.0;

/// Visits all 128-bit sums in a fixed order.
template <class LedgerType, class Visitor>
void for_each_sum(LedgerType& l, Visitor&& visit) {
  visit(l.nodes.wall_heat);
  visit(l.nodes.contact_heat);
  visit(l.nodes.friction_heat);
  visit(l.nodes.wall_work);
  visit(l.nodes.body_work);
  for (auto& x : l.nodes.body_impulse) visit(x);
  for (auto& x : l.nodes.wall_impulse) visit(x);
  visit(l.viscous_heat);
  visit(l.transfer_heat);
  visit(l.conduction);
  visit(l.escaped_energy);
  visit(l.escaped_mass);
  for (auto& x : l.escaped_momentum) visit(x);
  visit(l.row_wall_impulse);
}

/// Visits all counters in a fixed order.
template <class LedgerType, class Visitor>
void for_each_counter(LedgerType& l, Visitor&& visit) {
  visit(l.escaped_particles);
  visit(l.guards.compression);
  visit(l.guards.sound_speed);
  visit(l.guards.wall_crossing);
  visit(l.guards.temperature);
  visit(l.guards.pixel);
  visit(l.guards.negative_heat);
  visit(l.shortened);
}

template <int Dim>
double square(const std::array<std::vector<double>, symmetric_size<Dim>>& tensor, std::size_t p) {
  SymmetricTensor<Dim> t;
  for (int k = 0; k < symmetric_size<Dim>; ++k) t[k] = tensor[k][p];
  return contract<Dim>(t, t);
}

/// Momentum now, what left and what was given, and their sum, which stays. Collective.
void balance_momentum(const std::array<Int128, 3>& momentum, const Ledger& ledger,
                      MPI_Comm communicator, HistoryRow& row) {
  std::vector<Int128> sums;
  for (const auto* triple : {&momentum, &ledger.escaped_momentum, &ledger.nodes.wall_impulse,
                             &ledger.nodes.body_impulse}) {
    sums.insert(sums.end(), triple->begin(), triple->end());
  }
  sum(sums, communicator);
  for (std::size_t a = 0; a < 3; ++a) {
    const auto value = [&](Int128 quanta) {
      return static_cast<double>(quanta) * ledger.momentum_quantum;
    };
    row.momentum[a] = value(sums[a]);
    row.escaped_momentum[a] = value(sums[3 + a]);
    row.wall_impulse[a] = value(sums[6 + a]);
    row.body_impulse[a] = value(sums[9 + a]);
    row.total_momentum[a] = value(sums[a] + sums[3 + a] - sums[6 + a] - sums[9 + a]);
  }
}

}  // namespace

void set_quanta(double energy, double momentum, Ledger& ledger) {
  ledger.energy_quantum = energy;
  ledger.momentum_quantum = momentum;
  ledger.nodes.inverse_energy_quantum = 1.0 / energy;
  ledger.nodes.inverse_momentum_quantum = 1.0 / momentum;
}

template <int Dim>
Ledger make_ledger(const Scene& scene, const std::vector<Material>& materials,
                   const Particles<Dim>& particles, MPI_Comm communicator) {
  double heaviest = 0.0;
  for (const double m : particles.mass) heaviest = std::max(heaviest, m);
  MPI_Allreduce(MPI_IN_PLACE, &heaviest, 1, MPI_DOUBLE, MPI_MAX, communicator);
  // A tenth of the sound speed stands in where nothing moves at the start.
  double speed = scene.loading.velocity;
  for (const Material& m : materials) speed = std::max(speed, 0.1 * longitudinal_sound_speed(m));
  for (const double v : scene.loading.frame) speed = std::max(speed, std::abs(v));
  for (const Body& body : scene.bodies) {
    for (const double v : body.velocity) speed = std::max(speed, std::abs(v));
  }
  Ledger ledger;
  set_quanta(power_of_two_below(heaviest * speed * speed) / quanta_per_particle,
             power_of_two_below(heaviest * speed) / quanta_per_particle, ledger);
  return ledger;
}

template <int Dim>
HistoryRow take_stock(const Scene& scene, const std::vector<Material>& materials,
                      const Particles<Dim>& particles, const Ledger& ledger,
                      MPI_Comm communicator) {
  const double inertia = affine_inertia(scene.transfer, scene.domain.cell);
  const double per_quantum = ledger.nodes.inverse_energy_quantum;
  Int128 kinetic = 0, internal = 0, elastic = 0, plastic = 0;
  std::array<Int128, 3> momentum{};
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double m = particles.mass[p];
    kinetic += quantise(m * kinetic_energy(particles, inertia, p), per_quantum);
    internal += quantise(m * particles.internal_energy[p], per_quantum);
    plastic += quantise(m * particles.plastic_work[p], per_quantum);
    for (int a = 0; a < Dim; ++a) {
      momentum[a] += quantise(m * particles.velocity[a][p], ledger.nodes.inverse_momentum_quantum);
    }
    const Material& material = materials[static_cast<std::size_t>(particles.material[p])];
    double stored =
        material.deviatoric_energy(square<Dim>(particles.deviator, p), particles.density[p]);
    if (particles.options.back_stress) {
      stored += material.back_stress_energy(square<Dim>(particles.back_stress, p),
                                            particles.density[p]);
    }
    elastic += quantise(m * stored, per_quantum);
  }
  std::vector<Int128> sums = {kinetic,
                              internal,
                              elastic,
                              plastic,
                              ledger.escaped_energy,
                              ledger.nodes.wall_work,
                              ledger.nodes.body_work,
                              ledger.viscous_heat,
                              ledger.transfer_heat,
                              ledger.nodes.wall_heat,
                              ledger.conduction,
                              ledger.nodes.contact_heat,
                              ledger.nodes.friction_heat};
  sum(sums, communicator);
  std::vector<std::int64_t> counts = {static_cast<std::int64_t>(particles.size()),
                                      ledger.guards.compression + ledger.guards.sound_speed +
                                          ledger.guards.wall_crossing + ledger.guards.temperature +
                                          ledger.guards.pixel + ledger.guards.negative_heat};
  sum(counts, communicator);
  const auto energy = [&](Int128 quanta) {
    return static_cast<double>(quanta) * ledger.energy_quantum;
  };
  HistoryRow row;
  row.particles = counts[0];
  row.guards = counts[1];
  row.kinetic = energy(sums[0]);
  row.internal = energy(sums[1]);
  row.elastic = energy(sums[2]);
  row.plastic_work = energy(sums[3]);
  row.escaped = energy(sums[4]);
  row.wall_work = energy(sums[5]);
  row.body_work = energy(sums[6]);
  row.viscous_heat = energy(sums[7]);
  row.filter_heat = energy(sums[8]);
  row.wall_heat = energy(sums[9]);
  row.conduction = energy(sums[10]);
  row.contact_heat = energy(sums[11]);
  row.friction_heat = energy(sums[12]);
  row.total = energy(sums[0] + sums[1] + sums[4] - sums[5] - sums[6]);
  balance_momentum(momentum, ledger, communicator, row);
  return row;
}

double mean_wall_force(const Ledger& ledger, int dimension, double time, MPI_Comm communicator) {
  const auto axis = static_cast<std::size_t>(dimension - 1);
  std::vector<Int128> impulse = {ledger.nodes.wall_impulse[axis] - ledger.row_wall_impulse};
  sum(impulse, communicator);
  const double span = time - ledger.row_time;
  return span > 0.0 ? static_cast<double>(impulse[0]) * ledger.momentum_quantum / span : 0.0;
}

void mark_row(int dimension, double time, Ledger& ledger) {
  ledger.row_wall_impulse = ledger.nodes.wall_impulse[static_cast<std::size_t>(dimension - 1)];
  ledger.row_time = time;
}

template <int Dim>
void book_escape(const Particles<Dim>& particles, std::size_t p, double inertia, Ledger& ledger) {
  ++ledger.escaped_particles;
  ledger.escaped_mass += quantise(particles.mass[p], 1.0 / mass_quantum(ledger));
  ledger.escaped_energy += quantise(particles.mass[p] * kinetic_energy(particles, inertia, p),
                                    ledger.nodes.inverse_energy_quantum);
  ledger.escaped_energy += quantise(particles.mass[p] * particles.internal_energy[p],
                                    ledger.nodes.inverse_energy_quantum);
  for (int a = 0; a < Dim; ++a) {
    ledger.escaped_momentum[a] += quantise(particles.mass[p] * particles.velocity[a][p],
                                           ledger.nodes.inverse_momentum_quantum);
  }
}

std::vector<std::int64_t> save(const Ledger& ledger, MPI_Comm communicator) {
  std::vector<Int128> sums;
  for_each_sum(ledger, [&](const Int128& x) { sums.push_back(x); });
  sum(sums, communicator);
  std::vector<std::int64_t> counters;
  for_each_counter(ledger, [&](const std::int64_t& x) { counters.push_back(x); });
  sum(counters, communicator);
  std::vector<std::int64_t> words = to_words(sums);
  words.insert(words.end(), counters.begin(), counters.end());
  return words;
}

void restore(const std::vector<std::int64_t>& words, bool root, Ledger& ledger) {
  std::size_t at = 0;
  for_each_sum(ledger, [&](Int128& x) {
    x = root ? from_words({words.at(at), words.at(at + 1)})[0] : Int128{0};
    at += 2;
  });
  for_each_counter(ledger, [&](std::int64_t& x) { x = root ? words.at(at) : 0, ++at; });
}

template Ledger make_ledger<2>(const Scene&, const std::vector<Material>&, const Particles<2>&,
                               MPI_Comm);
template Ledger make_ledger<3>(const Scene&, const std::vector<Material>&, const Particles<3>&,
                               MPI_Comm);
template HistoryRow take_stock<2>(const Scene&, const std::vector<Material>&, const Particles<2>&,
                                  const Ledger&, MPI_Comm);
template HistoryRow take_stock<3>(const Scene&, const std::vector<Material>&, const Particles<3>&,
                                  const Ledger&, MPI_Comm);
template void book_escape<2>(const Particles<2>&, std::size_t, double, Ledger&);
template void book_escape<3>(const Particles<3>&, std::size_t, double, Ledger&);

}  // namespace poreshock
