#pragma once
// Files of process similarity between runs.

#include <mpi.h>

#include <string>
#include <vector>

namespace poreshock {

/// One run against the reference run, at R thresholds of the reference and K of the run.
struct ComparedRun {
  std::string path;
  double begin = 0.0;  ///< time window, in the unit of time
  double end = 0.0;
  std::vector<double> threshold;       ///< K, of the run
  std::vector<double> distance;        ///< R x K, d_p
  std::vector<double> same_distance;   ///< R, d_p at the reference's threshold; NaN if not measured
  std::vector<double> best_threshold;  ///< R
  std::vector<double> best_distance;   ///< R, d_p there
  std::vector<double> same_interpolation;  ///< R, what interpolation between records adds to each
  std::vector<double> best_interpolation;  ///< d_p; 0 where both have the same times
  bool interpolated = false;               ///< the runs were recorded at different times
  std::vector<double> time;                ///< of both runs in the window
  std::vector<double> pattern_distance;    ///< R x times, d at the best threshold
};

/// Mean and standard deviation, an entry per threshold of the reference.
struct Spread {
  std::vector<double> mean, deviation;
};

/// Runs that differ in the seed of their sample only: what one sample more would change.
struct SeedGroup {
  std::vector<std::size_t> runs;  ///< numbers of the compared runs, two or more
  Spread best_threshold, best_distance;
};

/// A reference run and all runs compared with it.
struct Comparison {
  std::string reference;
  std::string field;
  std::string unit;                         ///< of thresholds
  std::string time_unit;                    ///< "s", or "1": loading times of each run
  std::vector<double> reference_threshold;  ///< R
  std::vector<ComparedRun> runs;
  std::vector<SeedGroup> groups{};
};

/// Writes the comparison: to a name that ends in .h5 all of it, /run_1/..., /run_2/...,
/// /reference_threshold, and /seeds_1/... with mean and deviation of each group of runs (attribute
/// seeds_1: their numbers); to one that ends in .csv a row per run and threshold of the reference
/// (d_p = 0 means identical). An older file is replaced. InputError on all ranks for other names.
/// Rank 0 works. Collective.
void write_comparison(const std::string& path, const Comparison& comparison, MPI_Comm communicator);

}  // namespace poreshock
