#include "poreshock/run/progress.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "poreshock/core/memory.hpp"
#include "poreshock/core/parallel.hpp"

namespace poreshock {

namespace {

double communication(const PhaseTable& phases) {
  return seconds_in(phases, {PhaseName::exchange, PhaseName::migrate, PhaseName::time_step});
}

double compute(const PhaseTable& phases) {
  return seconds_in(phases, {PhaseName::sort, PhaseName::particles_to_grid, PhaseName::grid_update,
                             PhaseName::contact, PhaseName::grid_to_particles,
                             PhaseName::conduction, PhaseName::stress});
}

std::string duration(double s) {
  char text[32];
  if (s < 100.0) {
    std::snprintf(text, sizeof text, "%.0f s", s);
  } else if (s < 6000.0) {
    std::snprintf(text, sizeof text, "%.1f min", s / 60.0);
  } else {
    std::snprintf(text, sizeof text, "%.1f h", s / 3600.0);
  }
  return text;
}

double recording(const PhaseTable& phases) {
  return seconds_in(phases, {PhaseName::morphology, PhaseName::profile, PhaseName::history,
                             PhaseName::snapshot, PhaseName::checkpoint});
}

}  // namespace

std::string progress_header() {
  return "    step   time ns     dt ns    kinetic   internal     drift   M/s/core  comm  imbal    "
         "to go";
}

std::string progress_row(const Clock& clock, double end, const EnergyStatus& energy,
                         const PhaseTable& phases, Progress& progress, MPI_Comm communicator) {
  const double busy = compute(phases);
  // Of all ranks since the start: work, compute time, communication, work asleep, records.
  std::array<double, 5> sums = {static_cast<double>(progress.particle_steps), busy,
                                communication(phases), static_cast<double>(progress.sleeping_steps),
                                recording(phases)};
  double longest = busy - progress.row_compute;
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), sums.size(), MPI_DOUBLE, MPI_SUM, communicator);
  MPI_Allreduce(MPI_IN_PLACE, &longest, 1, MPI_DOUBLE, MPI_MAX, communicator);
  const double ranks = size(communicator);
  const RunSoFar& before = progress.to_go.row;
  const RunSoFar now{clock.time,      clock.step, MPI_Wtime() - progress.start_wall,
                     sums[4] / ranks, sums[0],    sums[3]};
  const double wall = now.wall - before.wall;
  const double rate = (now.particle_steps - before.particle_steps) / (wall * ranks) * 1e-6;
  const double share = 100.0 * (sums[2] - progress.row_communication) / (wall * ranks);
  const double all_busy = sums[1] - progress.row_all_compute;
  const double imbalance = all_busy > 0.0 ? longest * ranks / all_busy : 1.0;
  const double to_go = seconds_to_go(now, end, progress.to_go);
  char text[160];
  std::snprintf(text, sizeof text, "%8lld %9.3f %9.5f %10.4g %10.4g %9.1e %10.2f %4.0f%% %6.2f %8s",
                static_cast<long long>(clock.step), clock.time * 1e9, clock.allowed * 1e9,
                energy.kinetic, energy.internal, energy.drift, rate, share, imbalance,
                duration(to_go).c_str());
  progress.row_communication = sums[2];
  progress.row_compute = busy;
  progress.row_all_compute = sums[1];
  return text;
}

void note_memory(MPI_Comm communicator, Progress& progress) {
  const std::int64_t now = sum(own_memory() - progress.start_own, communicator);
  progress.most_own = std::max(progress.most_own, now);
}

Timings final_timings(const Clock& clock, const PhaseTable& phases, const WorkMeter& work,
                      std::int64_t particles, const Progress& progress, MPI_Comm communicator) {
  Timings timings;
  timings.ranks = size(communicator);
  timings.wall_seconds = MPI_Wtime() - progress.start_wall;
  timings.steps = clock.step - progress.to_go.start.step;
  timings.particle_steps = sum(progress.particle_steps, communicator);
  timings.sleeping_steps = sum(progress.sleeping_steps, communicator);
  timings.cuts = work.cuts;
  timings.rate_per_core = timings.wall_seconds > 0.0 ? static_cast<double>(timings.particle_steps) /
                                                           (timings.wall_seconds * timings.ranks)
                                                     : 0.0;
  const std::int64_t memory = sum(peak_memory() - progress.start_memory, communicator);
  const std::int64_t all = sum(particles, communicator);
  const double per_particle = all > 0 ? 1.0 / static_cast<double>(all) : 0.0;
  timings.bytes_per_particle = static_cast<double>(memory) * per_particle;
  timings.bytes_at_once = static_cast<double>(progress.most_own) * per_particle;
  timings.phases = gather_phases(phases, communicator);
  timings.warnings = progress.warnings;
  return timings;
}

std::string timings_table(const Timings& timings) {
  std::string table = "phase                     min s      avg s      max s   share\n";
  char line[120];
  for (const PhaseTiming& phase : timings.phases) {
    std::snprintf(line, sizeof line, "%-20s %10.3f %10.3f %10.3f  %5.1f%%\n", phase.name.c_str(),
                  phase.min, phase.avg, phase.max, 100.0 * phase.avg / timings.wall_seconds);
    table += line;
  }
  std::snprintf(
      line, sizeof line,
      "%lld steps in %.1f s on %d ranks: %.2f million particle-steps per second per core\n",
      static_cast<long long>(timings.steps), timings.wall_seconds, timings.ranks,
      timings.rate_per_core * 1e-6);
  table += line;
  if (timings.sleeping_steps > 0) {
    std::snprintf(line, sizeof line,
                  "%.0f %% of them in rows that no wave had reached, which only move\n",
                  100.0 * static_cast<double>(timings.sleeping_steps) /
                      static_cast<double>(timings.particle_steps));
    table += line;
  }
  if (timings.cuts > 0) {
    std::snprintf(line, sizeof line,
                  "the slabs of the ranks were cut anew %lld times as the work moved\n",
                  static_cast<long long>(timings.cuts));
    table += line;
  }
  std::snprintf(line, sizeof line,
                "at most %.0f bytes per particle beyond the empty program at one time; the sum of "
                "each rank's most is %.0f\n",
                timings.bytes_at_once, timings.bytes_per_particle);
  return table + line;
}

}  // namespace poreshock
