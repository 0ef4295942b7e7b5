#pragma once
// Failures that one rank sees and all ranks must answer together.

#include <mpi.h>

#include <exception>
#include <string>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"

namespace poreshock {

/// How an operation ended on one rank.
struct Outcome {
  ExitCode code = ExitCode::success;
  std::string reason;
};

/// Runs `action` and turns what it throws into an outcome. Not collective.
template <class Action>
Outcome attempt(Action&& action) {
  try {
    action();
  } catch (const InputError& error) {
    return {ExitCode::bad_input, error.what()};
  } catch (const std::exception& error) {
    return {ExitCode::system_failure, error.what()};
  }
  return {};
}

/// Returns when every rank succeeded; otherwise all ranks throw the failure of the lowest rank that
/// has one, as InputError or SystemError. Collective.
void agree(const Outcome& outcome, MPI_Comm communicator);

/// Runs `action` on rank 0 only; when it throws there, all ranks throw the same. Collective.
template <class Action>
void on_rank_zero(MPI_Comm communicator, Action&& action) {
  agree(rank(communicator) == 0 ? attempt(action) : Outcome{}, communicator);
}

}  // namespace poreshock
