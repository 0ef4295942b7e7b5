#include "poreshock/solver/row_cost.hpp"

#include <algorithm>
#include <limits>

#include "poreshock/core/parallel.hpp"

namespace poreshock {

void count_work(std::int64_t particles, double computed, std::int64_t contact_nodes,
                WorkMeter& work) {
  const auto add = [&](Work kind, double units) {
    work.done[static_cast<std::size_t>(kind)] += units;
  };
  add(Work::particle, computed);
  add(Work::recorded_particle, static_cast<double>(particles));
  add(Work::contact_node, static_cast<double>(contact_nodes));
}

PerWork<double> work_seconds(const PhaseTable& phases) {
  PerWork<double> seconds{};
  const auto add = [&](Work kind, std::initializer_list<PhaseName> names) {
    seconds[static_cast<std::size_t>(kind)] = seconds_in(phases, names);
  };
  add(Work::particle, {PhaseName::sort, PhaseName::particles_to_grid, PhaseName::grid_update,
                       PhaseName::grid_to_particles, PhaseName::conduction, PhaseName::stress});
  add(Work::contact_node, {PhaseName::contact});
  add(Work::recorded_particle, {PhaseName::morphology, PhaseName::profile, PhaseName::snapshot});
  return seconds;
}

PerWork<double> measured_unit_seconds(const PerWork<double>& done, const PerWork<double>& seconds,
                                      const PerWork<double>& before, MPI_Comm communicator) {
  const int kinds = static_cast<int>(done.size());
  PerWork<double> mean = done;
  check_mpi(MPI_Allreduce(MPI_IN_PLACE, mean.data(), kinds, MPI_DOUBLE, MPI_SUM, communicator),
            "MPI_Allreduce of work");
  PerWork<double> least;
  for (std::size_t k = 0; k < done.size(); ++k) {
    mean[k] /= size(communicator);
    // The mean of equal numbers may come out a rounding above them.
    const bool busy = done[k] > 0.0 && done[k] >= mean[k] * (1.0 - 1e-9);
    least[k] = busy ? seconds[k] / done[k] : std::numeric_limits<double>::infinity();
  }
  check_mpi(MPI_Allreduce(MPI_IN_PLACE, least.data(), kinds, MPI_DOUBLE, MPI_MIN, communicator),
            "MPI_Allreduce of seconds per unit of work");
  for (std::size_t k = 0; k < done.size(); ++k) {
    if (!(mean[k] > 0.0)) least[k] = before[k];
  }
  return least;
}

std::vector<double> slab_factors(const PerWork<double>& done, const PerWork<double>& seconds,
                                 const PerWork<double>& unit_seconds, MPI_Comm communicator) {
  constexpr auto kind = static_cast<std::size_t>(Work::particle);
  constexpr double most = 1.5;
  const double mine[2] = {done[kind], seconds[kind]};
  std::vector<double> all(2 * static_cast<std::size_t>(size(communicator)));
  check_mpi(MPI_Allgather(mine, 2, MPI_DOUBLE, all.data(), 2, MPI_DOUBLE, communicator),
            "MPI_Allgather of the cost of particles");
  double mean = 0.0;
  for (std::size_t r = 0; r < all.size(); r += 2) mean += all[r] / size(communicator);
  std::vector<double> factors;
  for (std::size_t r = 0; r < all.size(); r += 2) {
    const bool busy = all[r] > 0.0 && all[r] >= 0.5 * mean && unit_seconds[kind] > 0.0;
    const double factor = busy ? all[r + 1] / all[r] / unit_seconds[kind] : 1.0;
    factors.push_back(std::clamp(factor, 1.0 / most, most));
  }
  return factors;
}

std::vector<double> predicted_row_seconds(const std::vector<std::int64_t>& particles,
                                          const std::vector<std::int64_t>& contact_nodes,
                                          RowRange awake, double weight,
                                          const PerWork<double>& unit_seconds) {
  const auto unit = [&](Work kind) { return unit_seconds[static_cast<std::size_t>(kind)]; };
  const double computed = unit(Work::particle) > 0.0 ? unit(Work::particle) : 1.0;
  std::vector<double> weights;
  weights.reserve(particles.size());
  for (int row = 0; row < static_cast<int>(particles.size()); ++row) {
    const auto at = static_cast<std::size_t>(row);
    const bool asleep = row < awake.first || row >= awake.last;
    const double each = computed * (asleep ? weight : 1.0) + unit(Work::recorded_particle);
    double seconds = each * static_cast<double>(particles[at]);
    if (!contact_nodes.empty()) {
      seconds += unit(Work::contact_node) * static_cast<double>(contact_nodes[at]);
    }
    weights.push_back(seconds);
  }
  return weights;
}

bool cutting_pays(double now, double best, std::int64_t steps, WorkMeter& meter) {
  meter.lost += (now - best) * static_cast<double>(steps);
  return best < now && meter.lost > meter.cut_seconds;
}

}  // namespace poreshock
