#include "poreshock/output/timings.hpp"

#include <array>
#include <charconv>
#include <cmath>

#include "poreshock/core/parallel.hpp"
#include "poreshock/core/rank_zero.hpp"
#include "poreshock/files/posix_file.hpp"

namespace poreshock {

namespace {

/// Shortest text of a number; JSON knows no infinity and no NaN.
std::string json(double value) {
  if (!std::isfinite(value)) return "null";
  char text[32];
  const auto end = std::to_chars(text, text + sizeof(text), value).ptr;
  return {text, end};
}

/// A text in quotes; control characters become spaces.
std::string json(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
  }
  return quoted + "\"";
}

std::string json(const PhaseTiming& phase) {
  return "{\"name\": \"" + phase.name + "\", \"min\": " + json(phase.min) +
         ", \"avg\": " + json(phase.avg) + ", \"max\": " + json(phase.max) +
         ", \"calls\": " + std::to_string(phase.calls) + "}";
}

}  // namespace

std::vector<PhaseTiming> gather_phases(const PhaseTable& table, MPI_Comm communicator) {
  constexpr int count = static_cast<int>(PhaseName::count);
  std::array<double, count> least{};
  std::array<double, count> total{};
  std::array<double, count> most{};
  std::array<long, count> calls{};
  const auto reduce = [&](const double* from, double* to, MPI_Op operation) {
    check_mpi(MPI_Allreduce(from, to, count, MPI_DOUBLE, operation, communicator), "MPI_Allreduce");
  };
  reduce(table.seconds.data(), least.data(), MPI_MIN);
  reduce(table.seconds.data(), total.data(), MPI_SUM);
  reduce(table.seconds.data(), most.data(), MPI_MAX);
  check_mpi(MPI_Allreduce(table.calls.data(), calls.data(), count, MPI_LONG, MPI_MAX, communicator),
            "MPI_Allreduce");
  std::vector<PhaseTiming> phases;
  for (std::size_t i = 0; i < calls.size(); ++i) {
    if (calls[i] == 0) continue;
    phases.push_back({std::string(phase_name(static_cast<PhaseName>(i))), least[i],
                      total[i] / size(communicator), most[i], calls[i]});
  }
  return phases;
}

void write_timings(const std::string& path, const Timings& timings, MPI_Comm communicator) {
  on_rank_zero(communicator, [&] {
    std::string text = "{\n  \"version\": \"" + version() + "\",\n  \"revision\": \"" + revision() +
                       "\",\n  \"ranks\": " + std::to_string(timings.ranks) +
                       ",\n  \"wall_seconds\": " + json(timings.wall_seconds) +
                       ",\n  \"steps\": " + std::to_string(timings.steps) +
                       ",\n  \"particle_steps\": " + std::to_string(timings.particle_steps) +
                       ",\n  \"sleeping_steps\": " + std::to_string(timings.sleeping_steps) +
                       ",\n  \"cuts\": " + std::to_string(timings.cuts) +
                       ",\n  \"bytes_per_particle\": " + json(timings.bytes_per_particle) +
                       ",\n  \"bytes_per_particle_at_once\": " + json(timings.bytes_at_once) +
                       ",\n  \"rate_per_core\": " + json(timings.rate_per_core) +
                       ",\n  \"phases\": [";
    for (std::size_t i = 0; i < timings.phases.size(); ++i) {
      text += (i > 0 ? ",\n    " : "\n    ") + json(timings.phases[i]);
    }
    text += "\n  ],\n  \"warnings\": [";
    for (std::size_t i = 0; i < timings.warnings.size(); ++i) {
      text += (i > 0 ? ",\n    " : "\n    ") + json(timings.warnings[i]);
    }
    write_text(path, text + (timings.warnings.empty() ? "]\n}\n" : "\n  ]\n}\n"));
  });
}

}  // namespace poreshock
