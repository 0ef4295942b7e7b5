#include "poreshock/core/phase.hpp"

#include <sys/resource.h>

#include <fstream>

#ifdef __GLIBC__
#include <malloc.h>
#endif
#include <petsclog.h>
#include <unistd.h>

#include "poreshock/core/parallel.hpp"

namespace poreshock {

std::string_view phase_name(PhaseName phase) {
  static constexpr std::array<std::string_view, static_cast<int>(PhaseName::count)> names = {
      "sort",        "filter",    "particles to grid", "exchange",  "average",
      "grid update", "contact",   "grid to particles", "remap",     "heat conduction",
      "stress",      "time step", "migrate",           "rebalance", "morphology",
      "profile",     "history",   "snapshot",          "checkpoint"};
  return names[static_cast<std::size_t>(phase)];
}

std::int64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;
}

std::int64_t own_memory() {
  std::ifstream file("/proc/self/statm");
  std::int64_t size = 0, resident = 0, shared = 0;
  file >> size >> resident >> shared;
  return file ? (resident - shared) * sysconf(_SC_PAGESIZE) : 0;
}

void release_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

double seconds_in(const PhaseTable& table, std::initializer_list<PhaseName> phases) {
  double sum = 0.0;
  for (const PhaseName phase : phases) sum += table.seconds[static_cast<std::size_t>(phase)];
  return sum;
}

PhaseTable make_phase_table() {
  PhaseTable table;
  PetscClassId id = 0;
  check_petsc(PetscClassIdRegister("poreshock", &id), "PetscClassIdRegister");
  for (int i = 0; i < static_cast<int>(PhaseName::count); ++i) {
    check_petsc(PetscLogEventRegister(phase_name(static_cast<PhaseName>(i)).data(), id,
                                      &table.events[static_cast<std::size_t>(i)]),
                "PetscLogEventRegister");
  }
  return table;
}

Phase::Phase(PhaseTable& table, PhaseName name)
    : table_(table), index_(static_cast<int>(name)), start_(MPI_Wtime()) {
  PetscLogEventBegin(table_.events[static_cast<std::size_t>(index_)], 0, 0, 0, 0);
}

Phase::~Phase() {
  PetscLogEventEnd(table_.events[static_cast<std::size_t>(index_)], 0, 0, 0, 0);
  table_.seconds[static_cast<std::size_t>(index_)] += MPI_Wtime() - start_;
  ++table_.calls[static_cast<std::size_t>(index_)];
}

}  // namespace poreshock
