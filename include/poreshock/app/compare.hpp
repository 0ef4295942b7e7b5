#pragma once
// Similarity of runs from what they measured.

#include <mpi.h>

#include <optional>
#include <string>
#include <vector>

namespace poreshock {

/// What is to be compared, as the command line gives it.
struct CompareOptions {
  std::vector<std::string> runs;  ///< folders or files; the first is the reference
  std::string field = "temperature";
  std::string threshold;  ///< of the reference, A,B,C in the unit of the field; empty: all
  std::string window;     ///< BEGIN:END, s; slower (or empty), faster: to that run's end of loading
  std::string time = "common";   ///< common, or loading: in units of each run's own loading time
  std::string chi = "chi";       ///< which Euler characteristic: chi, chi4 (chi6 in 3-D), chi_paper
  std::optional<double> length;  ///< m, unit of length of the functionals; without: the pixel
  std::string output;            ///< .h5 or .csv; empty: none
};

/// Compares every run with the first one: prints a table of d_p and S_p at the same and at the best
/// threshold, and writes what was asked for. Throws InputError. Collective.
void compare(const CompareOptions& options, MPI_Comm communicator);

}  // namespace poreshock
