#include "poreshock/output/comparison_file.hpp"

#include <array>
#include <cstdio>

#include "poreshock/core/rank_zero.hpp"
#include "poreshock/files/hdf5_file.hpp"
#include "poreshock/files/posix_file.hpp"

namespace poreshock {

namespace {

/// One dataset of a run: its values, and its shape.
struct Part {
  std::string path;
  std::vector<std::uint64_t> shape;
  std::string unit;
  const std::vector<double>& values;
};

std::vector<Part> parts_of(const Comparison& comparison, const ComparedRun& run,
                           const std::string& folder) {
  const std::uint64_t references = comparison.reference_threshold.size();
  const std::uint64_t thresholds = run.threshold.size();
  const std::uint64_t times = run.time.size();
  const std::string& unit = comparison.unit;
  return {{folder + "threshold", {thresholds}, unit, run.threshold},
          {folder + "d_p", {references, thresholds}, "1", run.distance},
          {folder + "d_p_same", {references}, "1", run.same_distance},
          {folder + "best_threshold", {references}, unit, run.best_threshold},
          {folder + "d_p_best", {references}, "1", run.best_distance},
          {folder + "d_p_same_interpolation", {references}, "1", run.same_interpolation},
          {folder + "d_p_best_interpolation", {references}, "1", run.best_interpolation},
          {folder + "time", {times}, comparison.time_unit, run.time},
          {folder + "d", {references, times}, "1", run.pattern_distance}};
}

std::vector<Part> parts_of(const SeedGroup& group, const std::string& unit,
                           const std::string& folder) {
  const std::uint64_t references = group.best_threshold.mean.size();
  return {{folder + "best_threshold", {references}, unit, group.best_threshold.mean},
          {folder + "best_threshold_deviation", {references}, unit, group.best_threshold.deviation},
          {folder + "d_p_best", {references}, "1", group.best_distance.mean},
          {folder + "d_p_best_deviation", {references}, "1", group.best_distance.deviation}};
}

void write_hdf5(const std::string& path, const Comparison& comparison) {
  FileSpec spec;
  spec.attributes = {{"kind", "comparison"},
                     {"version", version()},
                     {"revision", revision()},
                     {"reference", comparison.reference},
                     {"field", comparison.field}};
  std::vector<Part> parts = {{"/reference_threshold",
                              {comparison.reference_threshold.size()},
                              comparison.unit,
                              comparison.reference_threshold}};
  for (std::size_t r = 0; r < comparison.runs.size(); ++r) {
    const std::string name = "run_" + std::to_string(r + 1);
    spec.attributes.push_back({name, comparison.runs[r].path});
    for (Part& part : parts_of(comparison, comparison.runs[r], "/" + name + "/")) {
      parts.push_back(std::move(part));
    }
  }
  for (std::size_t g = 0; g < comparison.groups.size(); ++g) {
    const std::string name = "seeds_" + std::to_string(g + 1);
    std::string members;
    for (const std::size_t r : comparison.groups[g].runs) {
      members.append(members.empty() ? "run_" : ", run_").append(std::to_string(r + 1));
    }
    spec.attributes.push_back({name, members});
    for (Part& part : parts_of(comparison.groups[g], comparison.unit, "/" + name + "/")) {
      parts.push_back(std::move(part));
    }
  }
  for (const Part& part : parts) {
    spec.datasets.push_back({part.path, NumberType::float64, part.shape, part.unit, {}});
  }
  Hdf5File file = Hdf5File::create(path, spec, MPI_COMM_SELF, Replace::yes);
  for (const Part& part : parts) file.write<double>(part.path, 0, part.values);
  file.finish();
}

/// A text as one cell of a CSV file, RFC 4180.
std::string quoted(const std::string& text) {
  std::string cell = "\"";
  for (const char c : text) cell.append(c == '"' ? 2 : 1, c);
  return cell + "\"";
}

std::string csv_text(const Comparison& comparison) {
  const std::string& unit = comparison.unit;
  std::string text = "run,reference_threshold [" + unit + "],begin [" + comparison.time_unit +
                     "],end [" + comparison.time_unit + "],d_p_same [1]," + "best_threshold [" +
                     unit +
                     "],d_p_best [1],d_p_same_interpolation [1],d_p_best_interpolation [1]\n";
  for (const ComparedRun& run : comparison.runs) {
    for (std::size_t r = 0; r < comparison.reference_threshold.size(); ++r) {
      std::array<char, 256> line{};
      std::snprintf(line.data(), line.size(), ",%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g,%.17g\n",
                    comparison.reference_threshold[r], run.begin, run.end, run.same_distance[r],
                    run.best_threshold[r], run.best_distance[r], run.same_interpolation[r],
                    run.best_interpolation[r]);
      text += quoted(run.path) + line.data();
    }
  }
  return text;
}

}  // namespace

void write_comparison(const std::string& path, const Comparison& comparison,
                      MPI_Comm communicator) {
  on_rank_zero(communicator, [&] {
    if (path.ends_with(".h5")) {
      write_hdf5(path, comparison);
    } else if (path.ends_with(".csv")) {
      write_text(path, csv_text(comparison));
    } else {
      throw InputError(path + ": a comparison goes to a file whose name ends in .h5 or .csv");
    }
  });
}

}  // namespace poreshock
