#pragma once
// Errors that reach the user. Exit codes: 2 bad input, 3 state gone bad, 4 library or system
// failure.

#include <stdexcept>
#include <string>

namespace poreshock {

/// Exit status of the program for each kind of failure.
enum class ExitCode { success = 0, bad_input = 2, bad_state = 3, system_failure = 4 };

/// Something the user can correct: a scene, a file, a command line. Known to every rank.
class InputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The simulated state is no longer physical (NaN, inverted particle, collapsed time step).
class StateError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A library failed on this rank, and the others may not know: it ends the whole program.
class RankError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A library or the operating system failed (HDF5, disk). Known to every rank.
class SystemError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace poreshock
