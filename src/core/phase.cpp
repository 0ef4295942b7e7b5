#include "poreshock/core/phase.hpp"

#include <petsclog.h>

#include "poreshock/core/parallel.hpp"

namespace poreshock {

std::string_view phase_name(PhaseName phase) {
  static constexpr std::array<std::string_view, static_cast<int>(PhaseName::count)> names = {
      "sort",      "particles to grid", "exchange",        "grid update",
      "contact",   "grid to particles", "heat conduction", "stress",
      "time step", "migrate",           "rebalance",       "morphology",
      "profile",   "history",           "snapshot",        "checkpoint"};
  return names[static_cast<std::size_t>(phase)];
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
