#include "poreshock/solver/ledger.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <type_traits>

#include "poreshock/core/parallel.hpp"
#include "poreshock/material/derived.hpp"
#include "poreshock/scene/transfer_scheme.hpp"

namespace poreshock {

namespace {

/// Quanta per reference energy of a particle: 2^50 leaves a factor 2^12 for hot particles.
constexpr double quanta_per_particle = 1125899906842624.0;

/// What the particles hold now, of this rank, in quanta.
struct Stock {
  Int128 kinetic = 0, internal = 0, elastic = 0, plastic = 0;
  std::array<Int128, 3> momentum{};
};

/// Calls visit(sum, where the history shows it, its sign in the total) for all that particles hold.
template <class Visitor>
void for_each_sum(const Stock& stock, Visitor&& visit) {
  visit(stock.kinetic, &HistoryRow::kinetic, 1);
  visit(stock.internal, &HistoryRow::internal, 1);
  visit(stock.elastic, &HistoryRow::elastic, 0);
  visit(stock.plastic, &HistoryRow::plastic_work, 0);
  visit(stock.momentum, &HistoryRow::momentum, 1);
}

/// The same for all cumulative sums; their order is the checkpoint format. Null: not shown.
template <class LedgerType, class Visitor>
void for_each_sum(LedgerType& l, Visitor&& visit) {
  visit(l.nodes.wall_heat, &HistoryRow::wall_heat, 0);
  visit(l.nodes.contact_heat, &HistoryRow::contact_heat, 0);
  visit(l.nodes.friction_heat, &HistoryRow::friction_heat, 0);
  visit(l.nodes.wall_work, &HistoryRow::wall_work, -1);
  visit(l.nodes.body_work, &HistoryRow::body_work, -1);
  visit(l.nodes.body_impulse, &HistoryRow::body_impulse, -1);
  visit(l.nodes.wall_impulse, &HistoryRow::wall_impulse, -1);
  visit(l.viscous_heat, &HistoryRow::viscous_heat, 0);
  visit(l.compression_work, &HistoryRow::compression_work, 0);
  visit(l.step_heat, &HistoryRow::step_heat, 0);
  visit(l.failure_heat, &HistoryRow::plastic_work, 0);
  visit(l.transfer_heat, &HistoryRow::filter_heat, 0);
  visit(l.conduction, &HistoryRow::conduction, 0);
  visit(l.escaped.energy, &HistoryRow::escaped, 1);
  visit(l.escaped.mass, nullptr, 0);
  visit(l.escaped.momentum, &HistoryRow::escaped_momentum, 1);
  visit(l.row_wall_impulse, nullptr, 0);
  if (!l.follows) return;
  visit(l.handed_over.energy, &HistoryRow::handed_over, 1);
  visit(l.handed_over.mass, nullptr, 0);
  visit(l.handed_over.momentum, &HistoryRow::handed_over_momentum, 1);
  visit(l.taken_in.energy, &HistoryRow::taken_in, -1);
  visit(l.taken_in.mass, nullptr, 0);
  visit(l.taken_in.momentum, &HistoryRow::taken_in_momentum, -1);
  visit(l.handed_plastic_work, &HistoryRow::plastic_work, 0);
}

/// Visits all counters in the order of the checkpoint format.
template <class LedgerType, class Visitor>
void for_each_counter(LedgerType& l, Visitor&& visit) {
  visit(l.escaped.particles);
  for (const GuardCounter& guard : guard_counters) visit(l.guards.*guard.count);
  visit(l.shortened);
  if (!l.follows) return;
  visit(l.handed_over.particles);
  visit(l.taken_in.particles);
}

/// The numbers of a sum: one of energy or mass, or the components of momentum.
template <class Sum>
auto numbers_of(Sum& sum) {
  if constexpr (std::is_same_v<std::remove_const_t<Sum>, Int128>) {
    return std::span(&sum, 1);
  } else {
    return std::span(sum);
  }
}

template <int Dim>
double square(const std::array<std::vector<double>, symmetric_size<Dim>>& tensor, std::size_t p) {
  SymmetricTensor<Dim> t;
  for (int k = 0; k < symmetric_size<Dim>; ++k) t[k] = tensor[k][p];
  return contract<Dim>(t, t);
}

template <int Dim>
Stock add_up(const Scene& scene, const std::vector<Material>& materials,
             const Particles<Dim>& particles, const Ledger& ledger) {
  const double inertia = affine_inertia(scene.transfer, scene.domain.cell);
  const double per_quantum = ledger.nodes.inverse_energy_quantum;
  Stock stock;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double m = particles.mass[p];
    stock.kinetic += quantise(m * kinetic_energy(particles, inertia, p), per_quantum);
    stock.internal += quantise(m * particles.internal_energy[p], per_quantum);
    stock.plastic += quantise(m * particles.plastic_work[p], per_quantum);
    for (int a = 0; a < Dim; ++a) {
      stock.momentum[a] +=
          quantise(m * particles.velocity[a][p], ledger.nodes.inverse_momentum_quantum);
    }
    const Material& material = materials[static_cast<std::size_t>(particles.material[p])];
    double stored =
        material.deviatoric_energy(square<Dim>(particles.deviator, p), particles.density[p]);
    if (particles.options.back_stress) {
      stored +=
          material.back_stress_energy(square<Dim>(particles.back_stress, p), particles.density[p]);
    }
    stock.elastic += quantise(m * stored, per_quantum);
  }
  return stock;
}

/// The row of sums over all ranks, in the order in which `visit_sums` visits them.
template <class VisitSums>
HistoryRow make_row(const Ledger& ledger, const std::vector<Int128>& sums,
                    const VisitSums& visit_sums) {
  HistoryRow row;
  std::size_t at = 0;
  Int128 total = 0;
  std::array<Int128, 3> total_momentum{};
  const auto in = [](Int128 quanta, double quantum) {
    return static_cast<double>(quanta) * quantum;
  };
  visit_sums([&]<class Sum, class Place>(const Sum&, Place place, int sign) {
    if constexpr (std::is_null_pointer_v<Place>) {
      ++at;
    } else if constexpr (std::is_same_v<Sum, Int128>) {
      row.*place += in(sums[at], ledger.energy_quantum);
      total += sign * sums[at++];
    } else {
      for (std::size_t a = 0; a < 3; ++a) {
        (row.*place)[a] = in(sums[at], ledger.momentum_quantum);
        total_momentum[a] += sign * sums[at++];
      }
    }
  });
  row.total = in(total, ledger.energy_quantum);
  for (std::size_t a = 0; a < 3; ++a) {
    row.total_momentum[a] = in(total_momentum[a], ledger.momentum_quantum);
  }
  return row;
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
  ledger.follows = follows_front(scene);
  set_quanta(power_of_two_below(heaviest * speed * speed) / quanta_per_particle,
             power_of_two_below(heaviest * speed) / quanta_per_particle, ledger);
  return ledger;
}

template <int Dim>
HistoryRow take_stock(const Scene& scene, const std::vector<Material>& materials,
                      const Particles<Dim>& particles, const Ledger& ledger,
                      MPI_Comm communicator) {
  const Stock stock = add_up(scene, materials, particles, ledger);
  const auto visit_sums = [&](auto&& visit) {
    for_each_sum(stock, visit);
    for_each_sum(ledger, visit);
  };
  std::vector<Int128> sums;
  visit_sums([&](const auto& one, auto, int) {
    for (const Int128& x : numbers_of(one)) sums.push_back(x);
  });
  sum(sums, communicator);
  std::vector<std::int64_t> counts = {static_cast<std::int64_t>(particles.size()), 0};
  for (const GuardCounter& guard : guard_counters) counts[1] += ledger.guards.*guard.count;
  sum(counts, communicator);
  HistoryRow row = make_row(ledger, sums, visit_sums);
  row.particles = counts[0];
  row.guards = counts[1];
  row.follows = ledger.follows;
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
void book(const Particles<Dim>& particles, std::size_t p, double inertia, const Ledger& ledger,
          Passage& passage) {
  const double mass = particles.mass[p], per_quantum = ledger.nodes.inverse_energy_quantum;
  ++passage.particles;
  passage.mass += quantise(mass, 1.0 / mass_quantum(ledger));
  passage.energy += quantise(mass * kinetic_energy(particles, inertia, p), per_quantum);
  passage.energy += quantise(mass * particles.internal_energy[p], per_quantum);
  for (int a = 0; a < Dim; ++a) {
    passage.momentum[a] +=
        quantise(mass * particles.velocity[a][p], ledger.nodes.inverse_momentum_quantum);
  }
}

std::vector<std::int64_t> save(const Ledger& ledger, MPI_Comm communicator) {
  std::vector<Int128> sums;
  for_each_sum(ledger, [&](const auto& one, auto, int) {
    for (const Int128& x : numbers_of(one)) sums.push_back(x);
  });
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
  for_each_sum(ledger, [&](auto& one, auto, int) {
    for (Int128& x : numbers_of(one)) {
      x = root ? from_words({words.at(at), words.at(at + 1)})[0] : Int128{0};
      at += 2;
    }
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
template void book<2>(const Particles<2>&, std::size_t, double, const Ledger&, Passage&);
template void book<3>(const Particles<3>&, std::size_t, double, const Ledger&, Passage&);

}  // namespace poreshock
