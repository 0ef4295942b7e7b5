#pragma once
// Labels of the runs of white pixels of a slab. Private to the layer.

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "disjoint_sets.hpp"
#include "slab.hpp"
#include "white_runs.hpp"

namespace poreshock {

/// Sets of runs that touch, and around which axes each set winds (at any of its roots so far).
struct Labels {
  DisjointSets sets;
  std::vector<std::array<std::uint8_t, 2>> winds;

  explicit Labels(std::size_t count) : sets(count), winds(count) {}
};

/// Joins the sets of two runs; b is reached from a with `step` crossings.
void join(std::size_t a, std::size_t b, Crossings step, Labels& labels);

/// Joins all runs of a slab that touch, over corners or over faces only.
void label(const Slab& slab, const Runs& runs, bool corners, Labels& labels);

}  // namespace poreshock
