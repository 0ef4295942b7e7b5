#pragma once
// Morphology of stored fields.

#include <mpi.h>

#include <optional>
#include <string>
#include <vector>

namespace poreshock {

/// What is to be measured, as the command line gives it.
struct AnalyzeOptions {
  std::vector<std::string> files;  ///< snapshots, FILE.npy or FILE.h5:/path
  std::string thresholds;          ///< FROM:TO:STEP or A,B,C, in the unit of the field
  std::string quantiles;           ///< the same, thresholds by the share of the material below them
  std::string hot_spots;           ///< the same, thresholds at which hot spots are listed
  std::string field;               ///< of a snapshot (temperature); name of an array in the output
  std::string mask;                ///< array, not zero = material
  std::string periodic;            ///< lateral axes of an array that wrap: x, y or x,y
  std::string voids;               ///< in chi: black, white, fill or exclude; empty: black
  bool isoline = false;            ///< lengths (3-D: areas) of interpolated boundaries too
  std::optional<double> pixel;     ///< m; without: as the scene says, 1 for arrays
  std::string output;              ///< folder
  bool force = false;
};

/// Measures every file, prints the curves, and writes morphology.h5 into the output folder as a run
/// does. Throws InputError. Collective.
void analyze(const AnalyzeOptions& options, MPI_Comm communicator);

}  // namespace poreshock
