#pragma once
// The commands of the program.

#include <mpi.h>

#include <string>
#include <vector>

#include "poreshock/app/analyze.hpp"
#include "poreshock/app/compare.hpp"
#include "poreshock/core/error.hpp"

namespace poreshock {

enum class CommandKind { run, check, sample, analyze, compare, info, materials, keys };

/// What the command line asks for.
struct Command {
  CommandKind kind = CommandKind::run;
  std::string file;                    ///< scene, the file to describe, or a material's name
  std::vector<std::string> overrides;  ///< --set table.key=value
  std::string output;
  std::string restart;      ///< file or "latest"
  double wall_limit = 0.0;  ///< s
  bool force = false;
  bool quiet = false;
  bool verbose = false;
  AnalyzeOptions analyze;
  CompareOptions compare;
};

/// The page of the sources, and of the installed documents, that explains how a command fails with
/// this code. Pure function.
std::string page_of(CommandKind kind, ExitCode code);

/// Carries out a command. Throws InputError, StateError, SystemError. Collective.
ExitCode execute(const Command& command, MPI_Comm communicator);

}  // namespace poreshock
