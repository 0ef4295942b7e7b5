#pragma once
// Structure and process similarity: distances between thresholded patterns, and between runs, in
// the space of their Minkowski functionals. Nothing here is collective.
//
// Equations 16 to 18 of "Temperature pattern dynamics in shocked porous materials": S = 1/d with d
// the Euclidean distance of two patterns, S_p = 1/d_p with d_p the mean of d over a time window.

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace poreshock {

/// Functionals of one field of a run, at all of its records and thresholds.
struct Process {
  std::vector<double> time;       ///< s, ascending, at least one
  std::vector<double> threshold;  ///< in the unit of the field, ascending, at least one
  std::vector<std::vector<double>> functionals;  ///< each times x thresholds; the first is the area
                                                 ///< (volume) fraction
  std::vector<double> level{};  ///< times x thresholds, where thresholds are shares of the
                                ///< material: the values of the field there
};

/// Functionals of a process at one threshold over time: a path in the space of functionals.
struct Path {
  std::vector<double> time;                 ///< s
  std::vector<std::vector<double>> points;  ///< one per time, all functionals
};

/// A time window, s.
struct Window {
  double begin = 0.0;
  double end = 0.0;
};

/// Distance d of two patterns, eq. 16. Both have the same number of functionals.
double distance(std::span<const double> a, std::span<const double> b);

/// Similarity 1/d or 1/d_p, eqs 16 and 17; infinite when the distance is exactly zero.
double similarity(double distance);

/// The path at a threshold; between stored thresholds the functionals are interpolated linearly.
/// Throws InputError when the threshold is outside the stored ones.
Path path_at(const Process& process, double threshold);

/// End of loading: the first record with the largest integral of the area fraction over the
/// thresholds, which is the mean of the field above the lowest one. Release lowers it. Where
/// thresholds are shares, their lowest value moves too and is added where it is reached.
double end_of_loading(const Process& process);

/// Whose end of loading ends a time window.
enum class Until { slower, faster };

/// From the first time that both have to the end of loading of the slower (or faster) one, or to
/// the last time that both have when that comes earlier. Throws InputError when they share no time
/// span.
Window loading_window(const Process& a, const Process& b, Until until = Until::slower);

/// Distance of two paths over the window: at all times of either, the other interpolated linearly.
Path distances(const Path& a, const Path& b, Window window);

/// Mean distance d_p of two paths over a window, eq. 18, by the trapezoidal rule over all record
/// times of either. Throws InputError when the window is empty or not covered by both.
double process_distance(const Path& a, const Path& b, Window window);

/// By how much interpolation between records alone moves the distance of two paths: each against
/// itself known at the times of the other only, the two distances d_p added. 0 where both have the
/// same times. Throws InputError as process_distance does.
double interpolation_distance(const Path& a, const Path& b, Window window);

/// The threshold of a process at which it is most similar to a path.
struct Match {
  std::vector<double> distance;  ///< d_p per stored threshold
  double best_threshold = 0.0;   ///< in the unit of the field
  double best_distance = 0.0;    ///< d_p there
  bool at_end = false;  ///< at the lowest or highest stored threshold, so maybe not a minimum
};

/// Compares a path with a process at all stored thresholds, and around the best one at 32 steps to
/// each neighbour with interpolated functionals; the lowest of equals wins. Throws InputError as
/// process_distance does.
Match find_match(const Path& reference, const Process& process, Window window);

}  // namespace poreshock
