#pragma once
// What the words of the command line mean.

#include <optional>

#include "poreshock/app/commands.hpp"

namespace poreshock {

/// Reads the command line into `command`. Returns the exit code where the program ends here: after
/// help or the version, or with words that are not understood, which are said. Works before MPI is
/// initialised; of ranks started by mpirun the first one speaks. Not collective.
std::optional<int> read_command_line(int argc, char** argv, Command& command);

}  // namespace poreshock
