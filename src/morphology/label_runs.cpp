#include "label_runs.hpp"

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

std::vector<std::array<std::uint8_t, 2>> find_winding(const Labels& labels, std::size_t count) {
  std::vector<std::array<std::uint8_t, 2>> winds(count);
  for (const Labels::Winding& path : labels.windings) {
    auto& at_root = winds[labels.sets.place(path.run).root];
    at_root[0] |= static_cast<std::uint8_t>(path.crossings.x != 0 ? 1 : 0);
    at_root[1] |= static_cast<std::uint8_t>(path.crossings.y != 0 ? 1 : 0);
  }
  return winds;
}

namespace {

/// Joins the runs of two rows that touch; b is reached from a with `step` crossings.
void join_rows(const Runs& runs, std::size_t row_a, std::size_t row_b, Crossings step, bool corners,
               const Slab& slab, Labels& labels) {
  const std::span<const Run> a = runs.row(row_a);
  const std::span<const Run> b = runs.row(row_b);
  if (a.empty() || b.empty()) return;
  const std::size_t first_a = runs.starts[row_a];
  const std::size_t first_b = runs.starts[row_b];
  const std::int32_t reach = corners ? 1 : 0;
  std::size_t i = 0;
  std::size_t j = 0;
  while (i < a.size() && j < b.size()) {
    if (a[i].first <= b[j].last + reach && b[j].first <= a[i].last + reach) {
      join(first_a + i, first_b + j, step, labels);
    }
    (a[i].last < b[j].last ? i : j) += 1;
  }
  if (!corners || !slab.periodic_x) return;
  const std::int32_t end = slab.nx - 1;
  if (a.back().last == end && b.front().first == 0) {
    join(first_a + a.size() - 1, first_b, step + Crossings{1, 0}, labels);
  }
  if (a.front().first == 0 && b.back().last == end) {
    join(first_a, first_b + b.size() - 1, step + Crossings{-1, 0}, labels);
  }
}

}  // namespace

void label(const Slab& slab, const Runs& runs, bool corners, Labels& labels) {
  const auto rows_between = [&](int y, int z, int dy, int dz) {
    int other = y + dy;
    Crossings step;
    if (other < 0 || other >= slab.ny) {
      if (!slab.periodic_y) return;
      step.y = other < 0 ? -1 : 1;
      other -= step.y * slab.ny;
    }
    const int away = (dy != 0 ? 1 : 0) + (dz != 0 ? 1 : 0);
    if (away > 1 && !corners) return;
    join_rows(runs, static_cast<std::size_t>(z * slab.ny + y),
              static_cast<std::size_t>((z + dz) * slab.ny + other), step, corners, slab, labels);
  };
  const bool deep = slab.ny > 1 || slab.periodic_y;
  for (int z = 0; z < slab.stored; ++z) {
    for (int y = 0; y < slab.ny; ++y) {
      const auto row = static_cast<std::size_t>(z * slab.ny + y);
      const std::span<const Run> here = runs.row(row);
      if (slab.periodic_x && !here.empty() && here.front().first == 0 &&
          here.back().last == slab.nx - 1) {
        join(runs.starts[row + 1] - 1, runs.starts[row], {1, 0}, labels);
      }
      if (deep) rows_between(y, z, -1, 0);
      for (int dy = deep ? -1 : 0; z > 0 && dy <= (deep ? 1 : 0); ++dy) {
        rows_between(y, z, dy, -1);
      }
    }
  }
  settle(labels);
}

}  // namespace poreshock
