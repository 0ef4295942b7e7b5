#include "poreshock/app/compare.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <optional>
#include <sstream>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/core/text.hpp"
#include "poreshock/morphology/similarity.hpp"
#include "poreshock/output/comparison_file.hpp"
#include "poreshock/output/morphology_file.hpp"
#include "seed_groups.hpp"
#include "text.hpp"

namespace poreshock {

namespace {

/// The time window as asked for: its two ends, or whose end of loading ends it.
struct WindowChoice {
  std::optional<Window> window{};
  Until until = Until::slower;
};

WindowChoice parse_window(const std::string& text) {
  if (text.empty() || text == "slower") return {};
  if (text == "faster") return {std::nullopt, Until::faster};
  const std::size_t colon = text.find(':');
  const auto begin = parse_number(text.substr(0, colon));
  const auto end = colon == std::string::npos ? std::nullopt : parse_number(text.substr(colon + 1));
  if (!begin || !end || !(*begin < *end)) {
    throw InputError(
        "--window: found \"" + text +
        "\", allowed BEGIN:END, two numbers in seconds, the second larger, or slower or "
        "faster, the run whose end of loading ends the window");
  }
  return {Window{*begin, *end}};
}

/// What was read of one run.
struct RunData {
  std::string path;
  std::string unit;
  std::string scene;   ///< text
  double pixel = 0.0;  ///< m
  Process process;
};

/// Names of the functionals that span the space: fraction, lengths, Euler characteristic.
std::vector<std::string> functional_names(const MorphologyCurves& curves, const std::string& chi,
                                          const std::string& path) {
  std::vector<std::string> names = {"A", "L", chi};
  if (!curves.functionals.contains("A")) names = {"volume", "S", "M", chi};
  for (const std::string& name : names) {
    if (curves.functionals.contains(name)) continue;
    std::string known;
    for (const auto& [key, values] : curves.functionals) {
      known.append(known.empty() ? "" : ", ").append(key);
    }
    throw InputError(path + ": holds no functional " + name + ", allowed " + known +
                     (name == "chi_paper" ? "; run with morphology.domains = true" : ""));
  }
  return names;
}

/// Functionals per pixel, or in units of `length`: the k-th one counts pixels to the power -k.
RunData read_run(const std::string& path, const CompareOptions& options, MPI_Comm communicator) {
  MorphologyCurves curves = read_morphology(path, options.field, communicator);
  RunData run{path, curves.unit, curves.scene, curves.pixel, {}};
  run.process.time = curves.time;
  run.process.threshold = curves.threshold;
  const auto level = curves.functionals.find("level");
  if (level != curves.functionals.end()) run.process.level = level->second;
  const double ratio = options.length ? *options.length / curves.pixel : 1.0;
  double factor = 1.0;
  for (const std::string& name : functional_names(curves, options.chi, path)) {
    std::vector<double> values = curves.functionals.at(name);
    for (double& value : values) value *= factor;
    run.process.functionals.push_back(std::move(values));
    factor *= ratio;
  }
  if (options.time == "loading") {
    const double loaded = end_of_loading(run.process);
    if (!(loaded > 0.0)) throw InputError(path + ": its first record is its hottest: no loading");
    for (double& time : run.process.time) time /= loaded;
  }
  return run;
}

void require_comparable(const RunData& reference, const RunData& run,
                        const CompareOptions& options) {
  const std::size_t own = run.process.functionals.size();
  const std::size_t theirs = reference.process.functionals.size();
  if (own != theirs) {
    throw InputError(run.path + " is a run in " + std::to_string(own - 1) + " dimensions, " +
                     reference.path + " in " + std::to_string(theirs - 1) +
                     ": their morphology cannot be compared");
  }
  if (run.process.level.empty() != reference.process.level.empty()) {
    const bool shares = !run.process.level.empty();
    throw InputError((shares ? run.path : reference.path) + " was measured at quantiles, " +
                     (shares ? reference.path : run.path) + " at values in " +
                     (shares ? reference.unit : run.unit) +
                     ": allowed are two runs of one kind; measure the snapshots of one again with "
                     "poreshock analyze --quantiles or --thresholds");
  }
  if (run.pixel == reference.pixel || options.length) return;
  char text[160];
  std::snprintf(text, sizeof(text), "%.6g m against %.6g m", run.pixel, reference.pixel);
  throw InputError(run.path + " has other pixels than " + reference.path + ", " + text +
                   ", and lengths per pixel cannot be compared: give a common unit of length in "
                   "metres with --length");
}

std::vector<double> checked_thresholds(const std::string& text, const RunData& reference) {
  const std::vector<double>& measured = reference.process.threshold;
  std::vector<double> thresholds;
  std::stringstream parts(text);
  for (std::string part; std::getline(parts, part, ',');) {
    const auto threshold = parse_number(part);
    if (threshold && measured.front() <= *threshold && *threshold <= measured.back()) {
      thresholds.push_back(*threshold);
      continue;
    }
    char allowed[96];
    std::snprintf(allowed, sizeof(allowed), "a number from %.8g to %.8g %s", measured.front(),
                  measured.back(), reference.unit.c_str());
    throw InputError("--threshold: found \"" + part + "\", allowed " + allowed + ", what " +
                     reference.path + " measured");
  }
  return thresholds;
}

/// d_p at one threshold of a run, and how much of it interpolation may be.
struct DistanceThere {
  double distance = std::numeric_limits<double>::quiet_NaN();
  double interpolation = std::numeric_limits<double>::quiet_NaN();
};

/// Both NaN when the run did not measure the threshold.
DistanceThere distance_there(const Path& reference, const Process& process, double threshold,
                             Window window) {
  const bool measured =
      process.threshold.front() <= threshold && threshold <= process.threshold.back();
  if (!measured) return {};
  const Path path = path_at(process, threshold);
  return {process_distance(reference, path, window),
          interpolation_distance(reference, path, window)};
}

/// Whether a record of `a` in the window lies at no time of `b`, but for rounding.
bool has_other_times(const Process& a, const Process& b, Window window) {
  const double near = 1e-9 * (window.end - window.begin);
  for (const double time : a.time) {
    if (!(window.begin < time && time < window.end)) continue;
    const auto next = std::lower_bound(b.time.begin(), b.time.end(), time - near);
    if (next == b.time.end() || *next > time + near) return true;
  }
  return false;
}

ComparedRun compare_run(const RunData& reference, const RunData& run,
                        const std::vector<double>& thresholds, const WindowChoice& asked) {
  const Window window =
      asked.window ? *asked.window : loading_window(reference.process, run.process, asked.until);
  ComparedRun result;
  result.path = run.path;
  result.begin = window.begin;
  result.end = window.end;
  result.threshold = run.process.threshold;
  result.interpolated = has_other_times(reference.process, run.process, window) ||
                        has_other_times(run.process, reference.process, window);
  for (const double threshold : thresholds) {
    const Path path = path_at(reference.process, threshold);
    const Match match = find_match(path, run.process, window);
    result.distance.insert(result.distance.end(), match.distance.begin(), match.distance.end());
    const DistanceThere same = distance_there(path, run.process, threshold, window);
    result.same_distance.push_back(same.distance);
    result.same_interpolation.push_back(same.interpolation);
    result.best_threshold.push_back(match.best_threshold);
    result.best_distance.push_back(match.best_distance);
    const Path best = path_at(run.process, match.best_threshold);
    result.best_interpolation.push_back(interpolation_distance(path, best, window));
    const Path d = distances(path, best, window);
    result.time = d.time;
    for (const auto& point : d.points) result.pattern_distance.push_back(point[0]);
  }
  return result;
}

/// The similarity, or why there is no number: what interpolation alone makes up says nothing.
std::string similarity_text(double distance, double interpolation) {
  if (std::isnan(distance)) return "not measured";
  if (distance == 0.0) return "identical";
  if (distance <= interpolation * (1.0 + 1e-9)) return "alike";
  return significant<6>(similarity(distance));
}

void print_interpolation(const Comparison& comparison, const ComparedRun& run) {
  double most = 0.0;
  for (const double d : run.same_interpolation) most = d > most ? d : most;
  for (const double d : run.best_interpolation) most = d > most ? d : most;
  std::printf(
      "  recorded at other times than %s: each was interpolated at the times of the other, which "
      "alone moves d_p by up to %.6g; alike means by no more than that at this threshold\n",
      comparison.reference.c_str(), most);
}

void print(const Comparison& comparison) {
  const char* unit = comparison.unit.c_str();
  std::printf("%s against %s, S_p = 1/d_p\n", comparison.field.c_str(),
              comparison.reference.c_str());
  for (const ComparedRun& run : comparison.runs) {
    const bool seconds = comparison.time_unit == "s";
    std::printf("\n%s, from %.6g to %.6g %s\n", run.path.c_str(), run.begin * (seconds ? 1e9 : 1.0),
                run.end * (seconds ? 1e9 : 1.0), seconds ? "ns" : "loading times");
    std::printf("  %-18s %-14s %-14s %-18s %-14s %s\n",
                ("reference [" + comparison.unit + "]").c_str(), "d_p there", "S_p there",
                ("best [" + comparison.unit + "]").c_str(), "d_p best", "S_p best");
    bool at_end = false;
    for (std::size_t r = 0; r < comparison.reference_threshold.size(); ++r) {
      const double best = run.best_threshold[r];
      const bool end = best == run.threshold.front() || best == run.threshold.back();
      at_end = at_end || end;
      std::printf("  %-18.8g %-14.6g %-14s %-18s %-14.6g %s\n", comparison.reference_threshold[r],
                  run.same_distance[r],
                  similarity_text(run.same_distance[r], run.same_interpolation[r]).c_str(),
                  (std::to_string(best) + (end ? " *" : "")).c_str(), run.best_distance[r],
                  similarity_text(run.best_distance[r], run.best_interpolation[r]).c_str());
    }
    if (run.interpolated) print_interpolation(comparison, run);
    if (at_end) {
      std::printf(
          "  * at the end of the measured thresholds, %.8g ... %.8g %s: the best one may "
          "lie beyond\n",
          run.threshold.front(), run.threshold.back(), unit);
    }
  }
}

}  // namespace

void compare(const CompareOptions& options, MPI_Comm communicator) {
  if (options.runs.size() < 2) {
    throw InputError("compare: found " + std::to_string(options.runs.size()) +
                     " run, allowed two or more; the first is the reference");
  }
  if (options.time != "common" && options.time != "loading") {
    throw InputError("--time: found \"" + options.time + "\", allowed \"common\", \"loading\"");
  }
  require_length("--length", options.length);
  const WindowChoice window = parse_window(options.window);
  const RunData reference = read_run(options.runs[0], options, communicator);
  Comparison comparison{options.runs[0],
                        options.field,
                        reference.unit,
                        options.time == "common" ? "s" : "1",
                        reference.process.threshold,
                        {}};
  if (!options.threshold.empty()) {
    comparison.reference_threshold = checked_thresholds(options.threshold, reference);
  }
  std::vector<std::string> scenes;
  for (std::size_t r = 1; r < options.runs.size(); ++r) {
    const RunData run = read_run(options.runs[r], options, communicator);
    require_comparable(reference, run, options);
    comparison.runs.push_back(compare_run(reference, run, comparison.reference_threshold, window));
    scenes.push_back(run.scene);
  }
  comparison.groups = group_by_seed(comparison.runs, scenes);
  if (rank(communicator) == 0) {
    print(comparison);
    print_groups(comparison);
  }
  if (!options.output.empty()) write_comparison(options.output, comparison, communicator);
}

}  // namespace poreshock
