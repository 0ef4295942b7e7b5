#include "seed_groups.hpp"

#include <cmath>
#include <cstdio>
#include <optional>

#include "poreshock/scene/read_scene.hpp"

namespace poreshock {

namespace {

std::optional<Scene> without_seed(const std::string& text, const std::string& path) {
  if (text.empty()) return std::nullopt;
  Scene scene = parse_scene(text, path);
  scene.title.clear();
  scene.sample.seed = 0;
  return scene;
}

/// Mean and standard deviation of one number of each run at every threshold of the reference.
Spread spread(const std::vector<ComparedRun>& runs, const std::vector<std::size_t>& members,
              std::vector<double> ComparedRun::*numbers) {
  Spread result;
  const auto count = static_cast<double>(members.size());
  for (std::size_t k = 0; k < (runs[members[0]].*numbers).size(); ++k) {
    double sum = 0.0;
    for (const std::size_t m : members) sum += (runs[m].*numbers)[k];
    const double mean = sum / count;
    double squares = 0.0;
    for (const std::size_t m : members) squares += std::pow((runs[m].*numbers)[k] - mean, 2);
    result.mean.push_back(mean);
    result.deviation.push_back(std::sqrt(squares / (count - 1.0)));
  }
  return result;
}

}  // namespace

std::vector<SeedGroup> group_by_seed(const std::vector<ComparedRun>& runs,
                                     const std::vector<std::string>& scenes) {
  std::vector<SeedGroup> groups;
  std::vector<Scene> keys;
  for (std::size_t r = 0; r < runs.size(); ++r) {
    const std::optional<Scene> key = without_seed(scenes[r], runs[r].path);
    if (!key) continue;
    std::size_t g = 0;
    while (g < keys.size() && !(keys[g] == *key)) ++g;
    if (g == keys.size()) {
      keys.push_back(*key);
      groups.emplace_back();
    }
    groups[g].runs.push_back(r);
  }
  std::erase_if(groups, [](const SeedGroup& group) { return group.runs.size() < 2; });
  for (SeedGroup& group : groups) {
    group.best_threshold = spread(runs, group.runs, &ComparedRun::best_threshold);
    group.best_distance = spread(runs, group.runs, &ComparedRun::best_distance);
  }
  return groups;
}

void print_groups(const Comparison& comparison) {
  for (const SeedGroup& group : comparison.groups) {
    std::printf("\n%zu runs that differ in the seed only, mean +- standard deviation:",
                group.runs.size());
    for (const std::size_t r : group.runs) std::printf(" %s", comparison.runs[r].path.c_str());
    std::printf("\n  %-18s %-24s %s\n", ("reference [" + comparison.unit + "]").c_str(),
                ("best [" + comparison.unit + "]").c_str(), "d_p best");
    for (std::size_t k = 0; k < comparison.reference_threshold.size(); ++k) {
      char best[64];
      std::snprintf(best, sizeof(best), "%.6g +- %.3g", group.best_threshold.mean[k],
                    group.best_threshold.deviation[k]);
      std::printf("  %-18.8g %-24s %.6g +- %.3g\n", comparison.reference_threshold[k], best,
                  group.best_distance.mean[k], group.best_distance.deviation[k]);
    }
  }
}

}  // namespace poreshock
