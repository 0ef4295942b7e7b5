#pragma once
// Which rank owns which rows of cells.

#include <vector>

namespace poreshock {

/// Least rows a slab may have: first, inner and last rank.
struct SlabLimits {
  int first = 3;
  int inner = 2;
  int last = 5;
};

/// Starts of the contiguous row ranges of `parts` ranks: parts + 1 entries, 0 ... weights.size().
/// METIS and the exact chain partition both run; the one with the smaller heaviest slab wins.
/// Throws InputError when the rows do not suffice. Deterministic; not collective.
std::vector<int> partition_rows(const std::vector<double>& weights, int parts, SlabLimits limits);

/// Weight of the heaviest slab.
double heaviest(const std::vector<double>& weights, const std::vector<int>& starts);

}  // namespace poreshock
