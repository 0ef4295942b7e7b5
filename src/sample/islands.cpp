#include "islands.hpp"

#include <numeric>

#include "poreshock/core/parallel.hpp"

namespace poreshock {
namespace {

/// Representative of a run, with path halving; the smallest run number of a piece represents it.
std::int32_t find_root(std::int32_t run, std::vector<std::int32_t>& parent) {
  while (parent[static_cast<std::size_t>(run)] != run) {
    std::int32_t& up = parent[static_cast<std::size_t>(run)];
    up = parent[static_cast<std::size_t>(up)];
    run = up;
  }
  return run;
}

void join(std::size_t a, std::size_t b, std::vector<std::int32_t>& parent) {
  const std::int32_t root_a = find_root(static_cast<std::int32_t>(a), parent);
  const std::int32_t root_b = find_root(static_cast<std::int32_t>(b), parent);
  parent[static_cast<std::size_t>(std::max(root_a, root_b))] = std::min(root_a, root_b);
}

/// Joins the runs of two neighbouring rows that share a site coordinate.
void join_rows(const Runs& runs, std::int64_t row_a, std::int64_t row_b,
               std::vector<std::int32_t>& parent) {
  std::size_t a = runs.row_start[static_cast<std::size_t>(row_a)];
  std::size_t b = runs.row_start[static_cast<std::size_t>(row_b)];
  const std::size_t end_a = runs.row_start[static_cast<std::size_t>(row_a) + 1];
  const std::size_t end_b = runs.row_start[static_cast<std::size_t>(row_b) + 1];
  while (a < end_a && b < end_b) {
    const Run& run_a = runs.runs[a];
    const Run& run_b = runs.runs[b];
    if (run_a.begin < run_b.end && run_b.begin < run_a.end) join(a, b, parent);
    if (run_a.end < run_b.end) {
      ++a;
    } else {
      ++b;
    }
  }
}

/// Joins the first and last run of a row that meet across the periodic side.
void join_ends(const Runs& runs, std::int64_t row, std::int64_t row_length,
               std::vector<std::int32_t>& parent) {
  const std::size_t first = runs.row_start[static_cast<std::size_t>(row)];
  const std::size_t end = runs.row_start[static_cast<std::size_t>(row) + 1];
  if (end - first < 2) return;
  if (runs.runs[first].begin == 0 && runs.runs[end - 1].end == row_length) {
    join(first, end - 1, parent);
  }
}

/// Runs of the sample's layers in `range`.
Runs runs_in(const Scene& scene, const std::vector<Void>& voids, const Lattice& lattice,
             LatticeRange range) {
  Runs runs;
  // A few million sites at a time keep the memory small.
  const std::int64_t slab =
      std::max(std::int64_t{1}, (std::int64_t{1} << 22) / lattice.layer_size());
  for (std::int64_t first = range.first; first < range.last; first += slab) {
    const LatticeRange some{first, std::min(first + slab, range.last)};
    std::vector<std::int32_t> owners = sample_owners(scene, voids, some);
    for (const Region& region : scene.voids) {
      give_region(lattice, some, region, owner_none, {}, owners);
    }
    append_runs(owners, lattice.sites[0], runs);
  }
  return runs;
}

/// Runs of all ranks, one after the other.
Runs gather_runs(const Runs& mine, MPI_Comm communicator) {
  std::vector<std::int32_t> counts;
  for (std::size_t r = 1; r < mine.row_start.size(); ++r) {
    counts.push_back(static_cast<std::int32_t>(mine.row_start[r] - mine.row_start[r - 1]));
  }
  Runs all;
  all.runs = gather_all(mine.runs, communicator);
  for (const std::int32_t count : gather_all(counts, communicator)) {
    all.row_start.push_back(all.row_start.back() + static_cast<std::size_t>(count));
  }
  return all;
}

}  // namespace

void append_runs(const std::vector<std::int32_t>& owners, std::int64_t row_length, Runs& runs) {
  for (std::size_t row = 0; row < owners.size(); row += static_cast<std::size_t>(row_length)) {
    std::int32_t begin = -1;
    for (std::int32_t i = 0; i <= row_length; ++i) {
      const bool filled = i < row_length && owners[row + static_cast<std::size_t>(i)] != owner_none;
      if (filled && begin < 0) begin = i;
      if (!filled && begin >= 0) {
        runs.runs.push_back({.begin = begin, .end = i});
        begin = -1;
      }
    }
    runs.row_start.push_back(runs.runs.size());
  }
}

std::vector<std::int64_t> find_pieces(const Lattice& lattice, const std::array<bool, 2>& periodic,
                                      Runs& runs) {
  const std::int64_t rows = static_cast<std::int64_t>(runs.row_start.size()) - 1;
  const std::int64_t rows_per_layer = lattice.dimension == 3 ? lattice.sites[1] : 1;
  std::vector<std::int32_t> parent(runs.runs.size());
  std::iota(parent.begin(), parent.end(), 0);
  for (std::int64_t row = 0; row < rows; ++row) {
    if (periodic[0]) join_ends(runs, row, lattice.sites[0], parent);
    if (row >= rows_per_layer) join_rows(runs, row, row - rows_per_layer, parent);
    if (lattice.dimension == 2) continue;
    const std::int64_t j = row % rows_per_layer;
    if (j > 0) join_rows(runs, row, row - 1, parent);
    if (periodic[1] && j == rows_per_layer - 1) join_rows(runs, row, row - j, parent);
  }
  std::vector<std::int64_t> sizes;
  for (std::size_t r = 0; r < runs.runs.size(); ++r) {
    const std::size_t root =
        static_cast<std::size_t>(find_root(static_cast<std::int32_t>(r), parent));
    // The root is the first run of its piece, so it has been numbered before.
    if (root == r) {
      runs.runs[r].piece = static_cast<std::int32_t>(sizes.size());
      sizes.push_back(0);
    } else {
      runs.runs[r].piece = runs.runs[root].piece;
    }
    sizes[static_cast<std::size_t>(runs.runs[r].piece)] += runs.runs[r].end - runs.runs[r].begin;
  }
  return sizes;
}

std::vector<Grain> grains_of_islands(const Scene& scene, const Lattice& lattice,
                                     const IslandPieces& islands) {
  double volume = 1.0;
  for (int axis = 0; axis < lattice.dimension; ++axis) volume *= lattice.spacing;
  std::vector<Grain> grains;
  for (std::size_t p = 0; p < islands.piece_size.size(); ++p) {
    if (static_cast<std::int32_t>(p) == islands.largest) continue;
    const double measure = static_cast<double>(islands.piece_size[p]) * volume;
    grains.push_back({.center = {}, .measure = measure, .material = scene.sample.material});
  }
  return grains;
}

IslandPieces find_islands(const Scene& scene, const std::vector<Void>& voids,
                          MPI_Comm communicator) {
  const Lattice lattice = make_lattice(scene);
  IslandPieces result;
  result.runs =
      gather_runs(runs_in(scene, voids, lattice, own_layers(lattice.sample_layers, communicator)),
                  communicator);
  result.piece_size = find_pieces(lattice, scene.domain.periodic, result.runs);
  for (std::size_t p = 0; p < result.piece_size.size(); ++p) {
    const bool larger =
        result.largest < 0 ||
        result.piece_size[p] > result.piece_size[static_cast<std::size_t>(result.largest)];
    if (larger) result.largest = static_cast<std::int32_t>(p);
  }
  return result;
}

}  // namespace poreshock
