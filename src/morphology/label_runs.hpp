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

/// Sets of runs that touch, and the paths found in them that wind.
struct Labels {
  struct Winding {
    std::uint32_t run;
    Crossings crossings;
  };
  DisjointSets sets;
  std::vector<Winding> windings;

  explicit Labels(std::size_t count) : sets(count) {}
};

/// Joins the sets of two runs; b is reached from a with `step` crossings.
void join(std::size_t a, std::size_t b, Crossings step, Labels& labels);

/// Joins all runs of a slab that touch, over corners or over faces only, and settles the labels.
void label(const Slab& slab, const Runs& runs, bool corners, Labels& labels);

/// Makes labels.sets.place() right once all is joined.
void settle(Labels& labels);

/// Around which axes the sets wind, at their roots. After settle().
std::vector<std::array<std::uint8_t, 2>> find_winding(const Labels& labels, std::size_t count);

}  // namespace poreshock
