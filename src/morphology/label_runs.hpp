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

/// Sets of labels that belong together, and the paths found in them that wind.
struct Labels {
  struct Winding {
    std::uint32_t label;
    Crossings crossings;
  };
  DisjointSets sets;
  std::vector<Winding> windings;

  explicit Labels(std::size_t count) : sets(count) {}
};

/// Joins the sets of two labels; b is reached from a with `step` crossings.
void join(std::size_t a, std::size_t b, Crossings step, Labels& labels);

/// Labels all runs of a slab, joins the labels of those that touch, over corners or over faces
/// only, and settles them. Returns the label of each run. A run takes the label of one that it
/// touches in a row before, so that there are far fewer labels than runs; all runs of a label are
/// reached from one another without crossings. `labels` comes empty.
std::vector<std::uint32_t> label(const Slab& slab, const Runs& runs, bool corners, Labels& labels);

/// Makes labels.sets.place() right once all is joined.
void settle(Labels& labels);

/// Around which axes the sets wind, at their roots. After settle().
std::vector<std::array<std::uint8_t, 2>> find_winding(const Labels& labels);

}  // namespace poreshock
