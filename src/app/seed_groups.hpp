#pragma once
// Runs that differ in the seed of their sample only. Private to the app.

#include <string>
#include <vector>

#include "poreshock/output/comparison_file.hpp"

namespace poreshock {

/// Groups of two and more of the compared runs whose scenes differ in the seed and the title only,
/// with mean and standard deviation of what was found; `scenes` holds the scene text of each run,
/// empty where there is none. Not collective.
std::vector<SeedGroup> group_by_seed(const std::vector<ComparedRun>& runs,
                                     const std::vector<std::string>& scenes);

/// Prints a table of the groups.
void print_groups(const Comparison& comparison);

}  // namespace poreshock
