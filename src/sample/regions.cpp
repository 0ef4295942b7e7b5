#include "regions.hpp"

#include <algorithm>
#include <numeric>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"

namespace poreshock {
namespace {

/// Disjoint sets; the smallest number of a set represents it.
class Sets {
 public:
  explicit Sets(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  /// Representative, with path halving.
  std::size_t root(std::size_t i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }
  void join(std::size_t a, std::size_t b) {
    const std::size_t root_a = root(a), root_b = root(b);
    parent_[std::max(root_a, root_b)] = std::min(root_a, root_b);
  }

 private:
  std::vector<std::size_t> parent_;
};

/// Calls visit(i, j) for runs i of one row and j of another that share a face.
template <class Visit>
void for_each_contact(const Runs& a, std::int64_t row_a, const Runs& b, std::int64_t row_b,
                      Visit&& visit) {
  std::size_t i = a.row_start[static_cast<std::size_t>(row_a)];
  std::size_t j = b.row_start[static_cast<std::size_t>(row_b)];
  const std::size_t end_a = a.row_start[static_cast<std::size_t>(row_a) + 1];
  const std::size_t end_b = b.row_start[static_cast<std::size_t>(row_b) + 1];
  while (i < end_a && j < end_b) {
    const Run& one = a.runs[i];
    const Run& other = b.runs[j];
    if (one.begin < other.end && other.begin < one.end && one.label == other.label) visit(i, j);
    one.end < other.end ? ++i : ++j;
  }
}

/// Joins the runs of one row that touch each other, at its ends across the periodic side.
void join_in_row(const Runs& runs, std::int64_t row, const RowOrder& order, Sets& sets) {
  const std::size_t first = runs.row_start[static_cast<std::size_t>(row)];
  const std::size_t end = runs.row_start[static_cast<std::size_t>(row) + 1];
  if (!order.periodic[0] || end - first < 2) return;
  const Run& low = runs.runs[first];
  const Run& high = runs.runs[end - 1];
  if (low.begin == 0 && high.end == order.row_length && low.label == high.label) {
    sets.join(first, end - 1);
  }
}

/// Numbers the regions of this rank alone by their first run and returns them.
std::vector<ConnectedRegion> find_own_regions(const RowOrder& order, std::int64_t first_layer,
                                              Runs& runs) {
  Sets sets(runs.runs.size());
  const auto join = [&](std::size_t i, std::size_t j) { sets.join(i, j); };
  const std::int64_t per_layer = order.rows_per_layer;
  for (std::int64_t row = 0; row < runs.rows(); ++row) {
    join_in_row(runs, row, order, sets);
    if (row >= per_layer) for_each_contact(runs, row, runs, row - per_layer, join);
    const std::int64_t j = row % per_layer;
    if (j > 0) for_each_contact(runs, row, runs, row - 1, join);
    const bool across = order.periodic[1] && j > 0 && j == per_layer - 1;
    if (across) for_each_contact(runs, row, runs, row - j, join);
  }
  std::vector<ConnectedRegion> regions;
  for (std::int64_t row = 0; row < runs.rows(); ++row) {
    const auto r = static_cast<std::size_t>(row);
    for (std::size_t i = runs.row_start[r]; i < runs.row_start[r + 1]; ++i) {
      Run& run = runs.runs[i];
      // The root is the first run of its region, so it has been numbered before.
      const std::size_t root = sets.root(i);
      run.region = root == i ? static_cast<std::int32_t>(regions.size()) : runs.runs[root].region;
      if (root == i) {
        const std::int64_t rows = first_layer * per_layer + row;
        regions.push_back({.cells = 0, .first = rows * order.row_length + run.begin});
      }
      regions[static_cast<std::size_t>(run.region)].cells += run.end - run.begin;
    }
  }
  return regions;
}

/// Regions of two ranks that are one.
struct SamePair {
  std::int32_t below = 0, above = 0;
  auto operator<=>(const SamePair&) const = default;
};

/// The pairs of regions that touch between this rank's last layer and the next layer, which some
/// rank above has as its first. Collective.
std::vector<SamePair> pairs_above(const RowOrder& order, const Runs& runs, std::int64_t first_layer,
                                  MPI_Comm communicator) {
  const std::int64_t layers = runs.rows() / order.rows_per_layer;
  const Runs next = fetch_layers(
      order, runs, {first_layer, first_layer + layers},
      {first_layer + layers, first_layer + layers + (layers > 0 ? 1 : 0)}, communicator);
  std::vector<SamePair> pairs;
  for (std::int64_t row = 0; row < next.rows(); ++row) {
    const std::int64_t below = runs.rows() - order.rows_per_layer + row;
    for_each_contact(runs, below, next, row, [&](std::size_t i, std::size_t j) {
      pairs.push_back({runs.runs[i].region, next.runs[j].region});
    });
  }
  std::sort(pairs.begin(), pairs.end());
  pairs.erase(std::unique(pairs.begin(), pairs.end()), pairs.end());
  return pairs;
}

/// What regions of single ranks are called among those of all.
struct Renumbering {
  std::vector<std::int32_t> ids;    ///< regions that meet others across slabs, ascending
  std::vector<std::int32_t> roots;  ///< of each: the first region that it is one with
  std::vector<std::int32_t> gone;   ///< those that are not their own root, ascending

  std::int32_t operator()(std::int32_t region) const {
    const auto at = std::lower_bound(ids.begin(), ids.end(), region);
    if (at != ids.end() && *at == region)
      region = roots[static_cast<std::size_t>(at - ids.begin())];
    return region - static_cast<std::int32_t>(std::lower_bound(gone.begin(), gone.end(), region) -
                                              gone.begin());
  }
};

Renumbering renumber(const std::vector<SamePair>& pairs) {
  Renumbering result;
  for (const SamePair& pair : pairs) result.ids.insert(result.ids.end(), {pair.below, pair.above});
  std::sort(result.ids.begin(), result.ids.end());
  result.ids.erase(std::unique(result.ids.begin(), result.ids.end()), result.ids.end());
  const auto place = [&](std::int32_t id) {
    return static_cast<std::size_t>(std::lower_bound(result.ids.begin(), result.ids.end(), id) -
                                    result.ids.begin());
  };
  Sets sets(result.ids.size());
  for (const SamePair& pair : pairs) sets.join(place(pair.below), place(pair.above));
  for (std::size_t i = 0; i < result.ids.size(); ++i) {
    result.roots.push_back(result.ids[sets.root(i)]);
    if (result.roots[i] != result.ids[i]) result.gone.push_back(result.ids[i]);
  }
  return result;
}

/// Regions of the ranks below this one, and of all. Throws InputError when they are too many.
std::pair<std::int64_t, std::int64_t> count_before(std::size_t own, MPI_Comm communicator) {
  const std::vector<std::int64_t> mine{static_cast<std::int64_t>(own)};
  const std::vector<std::int64_t> counts = gather_all(mine, communicator);
  const auto here = counts.begin() + rank(communicator);
  const std::int64_t all = std::accumulate(counts.begin(), counts.end(), std::int64_t{0});
  if (all > std::int64_t{1} << 30) {
    throw InputError(
        "The sample falls into more than 2^30 pieces. Allowed are fewer: set "
        "sample.regions = \"matrix\", or take noise out of the image.");
  }
  return {std::accumulate(counts.begin(), here, std::int64_t{0}), all};
}

}  // namespace

RowOrder row_order(const std::array<std::int64_t, 3>& size, int dimension,
                   const std::array<bool, 2>& periodic) {
  const bool deep = dimension == 3;
  return {size[0], deep ? size[1] : 1, {periodic[0], deep && periodic[1]}};
}

std::vector<ConnectedRegion> find_regions(const RowOrder& order, std::int64_t first_layer,
                                          MPI_Comm communicator, Runs& runs) {
  const std::vector<ConnectedRegion> own = find_own_regions(order, first_layer, runs);
  const auto [before, all] = count_before(own.size(), communicator);
  for (Run& run : runs.runs) run.region += static_cast<std::int32_t>(before);
  const Renumbering number =
      renumber(gather_all(pairs_above(order, runs, first_layer, communicator), communicator));
  for (Run& run : runs.runs) run.region = number(run.region);
  const std::size_t count = static_cast<std::size_t>(all) - number.gone.size();
  std::vector<std::int64_t> numbers(2 * count, 0);
  for (std::size_t i = 0; i < own.size(); ++i) {
    const auto region = static_cast<std::int32_t>(before) + static_cast<std::int32_t>(i);
    const auto at = static_cast<std::size_t>(number(region));
    numbers[2 * at] += own[i].cells;
    if (!std::binary_search(number.gone.begin(), number.gone.end(), region)) {
      numbers[2 * at + 1] = own[i].first;
    }
  }
  sum(numbers, communicator);
  std::vector<ConnectedRegion> regions(count);
  for (std::size_t i = 0; i < count; ++i) regions[i] = {numbers[2 * i], numbers[2 * i + 1]};
  return regions;
}

namespace {

/// Counts of items that go to and come from every rank, and where they begin.
struct Parcels {
  std::vector<int> counts, starts;
};

/// Sends to every rank its part of `items`, which lie in the order of the ranks. Collective.
template <class Item>
std::vector<Item> exchange(const std::vector<Item>& items, const std::vector<int>& counts,
                           MPI_Comm communicator) {
  const auto with_starts = [](const std::vector<int>& n) {
    Parcels parcels{n, std::vector<int>(n.size(), 0)};
    for (std::size_t r = 1; r < n.size(); ++r) parcels.starts[r] = parcels.starts[r - 1] + n[r - 1];
    return parcels;
  };
  std::vector<int> coming(counts.size());
  check_mpi(MPI_Alltoall(counts.data(), 1, MPI_INT, coming.data(), 1, MPI_INT, communicator),
            "MPI_Alltoall of counts");
  const Parcels to = with_starts(counts), from = with_starts(coming);
  std::vector<Item> received(static_cast<std::size_t>(from.starts.back() + from.counts.back()));
  MPI_Datatype unit = make_unit(sizeof(Item));
  check_mpi(MPI_Alltoallv(items.data(), to.counts.data(), to.starts.data(), unit, received.data(),
                          from.counts.data(), from.starts.data(), unit, communicator),
            "MPI_Alltoallv of items");
  MPI_Type_free(&unit);
  return received;
}

}  // namespace

Runs fetch_layers(const RowOrder& order, const Runs& runs, LatticeRange own, LatticeRange wanted,
                  MPI_Comm communicator) {
  std::vector<Run> sent;
  std::vector<std::int32_t> lengths;  // runs of each row sent
  std::vector<int> run_counts, row_counts;
  for (const LatticeRange& other : gather_all(std::vector<LatticeRange>{wanted}, communicator)) {
    const std::int64_t first = std::max(other.first, own.first);
    const std::int64_t last = std::max(first, std::min(other.last, own.last));
    const std::size_t runs_before = sent.size(), rows_before = lengths.size();
    for (std::int64_t row = (first - own.first) * order.rows_per_layer;
         first < last && row < (last - own.first) * order.rows_per_layer; ++row) {
      const auto r = static_cast<std::size_t>(row);
      lengths.push_back(static_cast<std::int32_t>(runs.row_start[r + 1] - runs.row_start[r]));
      sent.insert(sent.end(), runs.runs.begin() + static_cast<std::ptrdiff_t>(runs.row_start[r]),
                  runs.runs.begin() + static_cast<std::ptrdiff_t>(runs.row_start[r + 1]));
    }
    run_counts.push_back(static_cast<int>(sent.size() - runs_before));
    row_counts.push_back(static_cast<int>(lengths.size() - rows_before));
  }
  Runs result;
  result.runs = exchange(sent, run_counts, communicator);
  for (const std::int32_t length : exchange(lengths, row_counts, communicator)) {
    result.row_start.push_back(result.row_start.back() + static_cast<std::size_t>(length));
  }
  return result;
}

}  // namespace poreshock
