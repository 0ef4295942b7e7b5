#include "label_runs.hpp"

#include <algorithm>
#include <limits>

namespace poreshock {

void join(std::size_t a, std::size_t b, Crossings step, Labels& labels) {
  const auto joined =
      labels.sets.join(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b), step);
  const bool winds = joined.root == joined.absorbed && !(joined.winding == Crossings{});
  if (winds) labels.windings.push_back({joined.root, joined.winding});
}

void settle(Labels& labels) {
  labels.sets.flatten();
}

std::vector<std::array<std::uint8_t, 2>> find_winding(const Labels& labels) {
  std::vector<std::array<std::uint8_t, 2>> winds(labels.sets.size());
  for (const Labels::Winding& path : labels.windings) {
    auto& at_root = winds[labels.sets.place(path.label).root];
    at_root[0] |= static_cast<std::uint8_t>(path.crossings.x != 0 ? 1 : 0);
    at_root[1] |= static_cast<std::uint8_t>(path.crossings.y != 0 ? 1 : 0);
  }
  return winds;
}

namespace {

/// Larger than any label, with all bits set.
constexpr std::uint32_t unlabelled = std::numeric_limits<std::uint32_t>::max();

/// Calls visit(i, j, touch) for runs i of one row and j of another, all that touch among them, in
/// an order in which neither falls. Without branches on what noise decides: half of them would go
/// wrong.
template <std::int32_t Reach, class Visit>
void for_each_overlap(std::span<const Run> a, std::span<const Run> b, Visit visit) {
  const std::size_t end_a = a.size();
  const std::size_t end_b = b.size();
  const Run* const runs_a = a.data();
  const Run* const runs_b = b.data();
  for (std::size_t i = 0, j = 0; i < end_a && j < end_b;) {
    const Run one = runs_a[i];
    const Run other = runs_b[j];
    visit(i, j, (one.first <= other.last + Reach) & (other.first <= one.last + Reach));
    const std::size_t next = one.last < other.last ? 1 : 0;
    i += next;
    j += 1 - next;
  }
}

template <class Visit>
void for_each_overlap(std::span<const Run> a, std::span<const Run> b, bool corners, Visit visit) {
  if (corners) {
    for_each_overlap<1>(a, b, visit);
  } else {
    for_each_overlap<0>(a, b, visit);
  }
}

/// The rows before a row, in their order, that touch it inside the map, as steps along y and z.
struct RowStep {
  int dy;
  int dz;
};
constexpr std::array<RowStep, 4> rows_before = {{{-1, -1}, {0, -1}, {1, -1}, {-1, 0}}};

/// Calls use(y, z, step) for every row and every row before it that joins it.
template <class Use>
void for_each_pair_of_rows(const Slab& slab, bool corners, Use use) {
  const bool deep = slab.ny > 1 || slab.periodic_y;
  for (int z = 0; z < slab.stored; ++z) {
    for (int y = 0; y < slab.ny; ++y) {
      for (const RowStep& step : rows_before) {
        const bool across = step.dy != 0 && step.dz != 0;
        if ((step.dy != 0 && !deep) || (across && !corners) || z + step.dz < 0) continue;
        use(y, z, step);
      }
    }
  }
}

std::size_t row_at(const Slab& slab, int y, int z) {
  return static_cast<std::size_t>(z) * static_cast<std::size_t>(slab.ny) +
         static_cast<std::size_t>(y);
}

/// Labels the runs of a row by those of rows before that they touch inside the map.
void label_row(const Slab& slab, const Runs& runs, int y, int z, bool corners, Labels& labels,
               std::vector<std::uint32_t>& label) {
  const std::size_t row = row_at(slab, y, z);
  std::uint32_t* own = label.data() + runs.starts[row];
  for (const RowStep& step : rows_before) {
    const int other_y = y + step.dy;
    const bool across = step.dy != 0 && step.dz != 0;
    if (other_y < 0 || other_y >= slab.ny || z + step.dz < 0 || (across && !corners)) continue;
    const std::size_t other = row_at(slab, other_y, z + step.dz);
    const std::uint32_t* before = label.data() + runs.starts[other];
    const auto visit = [own, before, &labels](std::size_t i, std::size_t j, bool touch) {
      const std::uint32_t mine = own[i];
      const std::uint32_t theirs = before[j] | (touch ? 0 : unlabelled);
      own[i] = std::min(mine, theirs);
      if ((std::max(mine, theirs) != unlabelled) & (mine != theirs)) join(mine, theirs, {}, labels);
    };
    for_each_overlap(runs.row(row), runs.row(other), corners, visit);
  }
  for (std::size_t i = 0; i < runs.row(row).size(); ++i) {
    // The label above in its tree stands for it: so most runs of a domain have the same one, and
    // few are left to join in the next row. No label is displaced before sides are crossed.
    own[i] = own[i] == unlabelled ? labels.sets.add() : labels.sets.parent(own[i]);
  }
}

/// A row of runs with their labels.
struct LabelledRow {
  std::span<const Run> runs;
  const std::uint32_t* label;
};

/// Joins the labels of two rows that touch across periodic sides; b is reached from a with `step`
/// crossings.
void join_across(const Slab& slab, const LabelledRow& row_a, const LabelledRow& row_b,
                 Crossings step, bool corners, Labels& labels) {
  const auto [a, label_a] = row_a;
  const auto [b, label_b] = row_b;
  if (a.empty() || b.empty()) return;
  if (step.y != 0) {
    for_each_overlap(a, b, corners, [&](std::size_t i, std::size_t j, bool touch) {
      if (touch) join(row_a.label[i], row_b.label[j], step, labels);
    });
  }
  if (!corners || !slab.periodic_x) return;
  const std::int32_t end = slab.nx - 1;
  if (a.back().last == end && b.front().first == 0) {
    join(label_a[a.size() - 1], label_b[0], step + Crossings{1, 0}, labels);
  }
  if (a.front().first == 0 && b.back().last == end) {
    join(label_a[0], label_b[b.size() - 1], step + Crossings{-1, 0}, labels);
  }
}

/// Joins all labels that touch across periodic sides.
void join_sides(const Slab& slab, const Runs& runs, bool corners,
                std::span<const std::uint32_t> label, Labels& labels) {
  const auto labelled = [&](std::size_t row) {
    return LabelledRow{runs.row(row), label.data() + runs.starts[row]};
  };
  for (std::size_t row = 0; slab.periodic_x && row + 1 < runs.starts.size(); ++row) {
    const std::span<const Run> here = runs.row(row);
    if (here.empty() || here.front().first != 0 || here.back().last != slab.nx - 1) continue;
    join(label[runs.starts[row + 1] - 1], label[runs.starts[row]], {1, 0}, labels);
  }
  for_each_pair_of_rows(slab, corners, [&](int y, int z, const RowStep& to) {
    int other = y + to.dy;
    Crossings step;
    if (other < 0 || other >= slab.ny) {
      if (!slab.periodic_y) return;
      step.y = other < 0 ? -1 : 1;
      other -= step.y * slab.ny;
    }
    join_across(slab, labelled(row_at(slab, y, z)), labelled(row_at(slab, other, z + to.dz)), step,
                corners, labels);
  });
}

}  // namespace

std::vector<std::uint32_t> label(const Slab& slab, const Runs& runs, bool corners, Labels& labels) {
  std::vector<std::uint32_t> label(runs.runs.size(), unlabelled);
  for (int z = 0; z < slab.stored; ++z) {
    for (int y = 0; y < slab.ny; ++y) label_row(slab, runs, y, z, corners, labels, label);
  }
  if (slab.periodic_x || slab.periodic_y) join_sides(slab, runs, corners, label, labels);
  settle(labels);
  return label;
}

}  // namespace poreshock
