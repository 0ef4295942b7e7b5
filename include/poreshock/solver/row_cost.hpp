#pragma once
// What a row of cells costs, in seconds measured in this run, and when cutting the slabs anew pays.

#include <mpi.h>

#include <array>
#include <cstdint>
#include <vector>

#include "poreshock/core/phase.hpp"
#include "poreshock/particles/cell_order.hpp"

namespace poreshock {

/// Kinds of work: computed particles, nodes where grains meet, particles put on records.
enum class Work { particle, contact_node, recorded_particle, count };

template <class T>
using PerWork = std::array<T, static_cast<int>(Work::count)>;

/// What this rank has done since the last measurement, and what it costs.
struct WorkMeter {
  PerWork<double> done{};     ///< this rank, units x steps; those asleep by their weight
  PerWork<double> seconds{};  ///< this rank, phases of each kind up to the last measurement
  PerWork<double>
      unit_seconds{};  ///< s per unit and step, the same on all ranks; 0 before the first
  std::int64_t measured_step = 0;  ///< step of the last measurement
  double lost = 0.0;               ///< s, predicted loss to the best cut since the slabs were cut
  double cut_seconds = 0.0;        ///< s, of the slowest rank when the slabs were last cut
  std::int64_t cuts = 0;           ///< times the slabs were cut anew while running
};

/// Adds what this rank did in a step: its particles, those computed with those asleep by their
/// weight, and the nodes where grains met.
void count_work(std::int64_t particles, double computed, std::int64_t contact_nodes,
                WorkMeter& work);

/// Seconds this rank has spent in the phases of each kind of work.
PerWork<double> work_seconds(const PhaseTable& phases);

/// Seconds per unit of each kind, from what every rank has done and how long it took; a kind that
/// nobody did keeps its `before`. A rank with little to do waits inside its phases, so the least
/// figure of the ranks that did at least the mean counts. Collective; the same on all ranks.
PerWork<double> measured_unit_seconds(const PerWork<double>& done, const PerWork<double>& seconds,
                                      const PerWork<double>& before, MPI_Comm communicator);

/// Seconds of a computed particle on each rank over `unit_seconds`: behind a front particles cost
/// more than before it. 1 where nothing is measured or a rank did less than half the mean and may
/// have waited; from 2/3 to 3/2. Collective; the same on all ranks.
std::vector<double> slab_factors(const PerWork<double>& done, const PerWork<double>& seconds,
                                 const PerWork<double>& unit_seconds, MPI_Comm communicator);

/// Predicted seconds of a step per row, from all its particles and contact nodes; before the first
/// measurement in units of a particle.
/// @param particles,contact_nodes entries per row; contact_nodes may be empty
/// @param awake the rows that are computed
/// @param weight of a particle in the others
std::vector<double> predicted_row_seconds(const std::vector<std::int64_t>& particles,
                                          const std::vector<std::int64_t>& contact_nodes,
                                          RowRange awake, double weight,
                                          const PerWork<double>& unit_seconds);

/// Books what the present cut loses in `steps` steps to the best one; true when all that is lost
/// since the last cut exceeds what a cut costs, so that never more than twice the least is spent
/// whatever comes (the ski-rental rule; Menon, Jain, Zheng & Kale, IEEE Cluster 2012).
/// @param now,best seconds of the slowest slab per step
bool cutting_pays(double now, double best, std::int64_t steps, WorkMeter& meter);

}  // namespace poreshock
