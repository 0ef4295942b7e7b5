#include <algorithm>

#include "domain_sweep.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/morphology/domains.hpp"
#include "ranks.hpp"
#include "slab.hpp"

namespace poreshock {
namespace {

/// The order in which the pixels of a slab turn from one colour to the other: `level` per stored
/// pixel, `levels` where it never does.
struct Order {
  std::size_t levels = 0;
  std::vector<std::uint32_t> level;
};

/// Pixels sorted by level, those that never turn left out.
std::vector<std::uint32_t> sorted_pixels(const Order& order, std::vector<std::size_t>& starts) {
  starts.assign(order.levels + 2, 0);
  for (const std::uint32_t level : order.level) ++starts[level + 1];
  for (std::size_t l = 0; l <= order.levels; ++l) starts[l + 1] += starts[l];
  std::vector<std::size_t> next(starts.begin(), starts.end() - 1);
  std::vector<std::uint32_t> pixels(starts[order.levels]);
  for (std::size_t i = 0; i < order.level.size(); ++i) {
    if (order.level[i] < order.levels) {
      pixels[next[order.level[i]]++] = static_cast<std::uint32_t>(i);
    }
  }
  return pixels;
}

/// Joins the domains that reach borders, on rank 0.
void join_borders(std::vector<BorderEvent> events, std::size_t border_pixels, Changes& changes) {
  std::stable_sort(events.begin(), events.end(),
                   [](const BorderEvent& a, const BorderEvent& b) { return a.level < b.level; });
  DisjointSets sets(border_pixels);
  std::vector<std::uint8_t> marks(border_pixels, 0);
  for (const BorderEvent& event : events) {
    const auto level = static_cast<std::size_t>(event.level);
    const auto joined = sets.join(event.a, event.b, event.step);
    const bool one_set = joined.root == joined.absorbed;
    count_marks(marks[joined.root], -1, level, changes);
    if (!one_set) count_marks(marks[joined.absorbed], -1, level, changes);
    if (!one_set) ++changes.joins[level];
    const bool winds = !(joined.winding == Crossings{});
    marks[joined.root] = static_cast<std::uint8_t>(marks[joined.root] | marks[joined.absorbed] |
                                                   event.marks | (winds ? mark_winds : 0));
    count_marks(marks[joined.root], 1, level, changes);
  }
}

/// Numbers of domains after each level, on every rank.
struct DomainSeries {
  std::vector<std::int64_t> domains, winding, touching;
};

DomainSeries sweep_domains(const Slab& slab, const Order& order, bool corners,
                           MPI_Comm communicator) {
  const auto layer = static_cast<std::uint32_t>(slab.layer_size());
  const auto me = static_cast<std::uint32_t>(rank(communicator));
  Sweep sweep(slab, corners, me * layer, order.levels);
  std::vector<std::size_t> starts;
  const std::vector<std::uint32_t> pixels = sorted_pixels(order, starts);
  for (std::size_t level = 0; level < order.levels; ++level) {
    for (std::size_t i = starts[level]; i < starts[level + 1]; ++i) sweep.turn(pixels[i], level);
  }
  std::vector<int> unused;
  const auto events = gather(sweep.events, unused, communicator);
  const std::size_t borders = static_cast<std::size_t>(size(communicator)) - 1;
  if (me == 0) join_borders(events, borders * layer, sweep.changes);

  Changes& changes = sweep.changes;
  std::vector<std::int64_t> packed;
  for (const auto* part : {&changes.pixels, &changes.joins, &changes.winding, &changes.touching}) {
    packed.insert(packed.end(), part->begin(), part->end());
  }
  sum(packed, communicator);
  const std::size_t levels = order.levels;
  DomainSeries series;
  std::int64_t domains = 0, winding = 0, touching = 0;
  for (std::size_t l = 0; l < levels; ++l) {
    series.domains.push_back(domains += packed[l] - packed[levels + l]);
    series.winding.push_back(winding += packed[2 * levels + l]);
    series.touching.push_back(touching += packed[3 * levels + l]);
  }
  return series;
}

/// Ranks of the stored pixels, and the levels of the two sweeps: white pixels appear as the
/// threshold falls, black ones as it rises.
struct Orders {
  Order white, black;
};

template <int Dim>
Orders make_orders(const PixelField<Dim>& map, std::size_t field,
                   std::span<const double> thresholds) {
  const RankTable table = make_rank_table(thresholds);
  const auto levels = static_cast<std::uint32_t>(thresholds.size());
  const std::size_t count = slab_of(map).stored_size();
  std::vector<std::uint32_t> ranks(count);
  rank_row(table, std::span(map.values.at(field)).first(count),
           std::span<const std::uint8_t>(map.solid).first(count), ranks.data());
  Orders orders{{levels, std::vector<std::uint32_t>(count)},
                {levels, std::vector<std::uint32_t>(count)}};
  for (std::size_t i = 0; i < count; ++i) {
    // A pixel of rank r is white at the first r thresholds.
    orders.white.level[i] = map.solid[i] != 0 ? levels - ranks[i] : levels;
    orders.black.level[i] = map.solid[i] != 0 ? ranks[i] : levels;
  }
  return orders;
}

}  // namespace

template <int Dim>
DomainCounts count_domains(const PixelField<Dim>& map, std::size_t field,
                           std::span<const double> thresholds, Joining joining,
                           MPI_Comm communicator) {
  const Slab slab = slab_of(map);
  const Orders orders = make_orders(map, field, thresholds);
  DomainSeries white = sweep_domains(slab, orders.white, joining == Joining::corners, communicator);
  DomainSeries black = sweep_domains(slab, orders.black, joining == Joining::faces, communicator);
  // White levels run from the highest threshold down.
  std::reverse(white.domains.begin(), white.domains.end());
  std::reverse(white.winding.begin(), white.winding.end());
  std::int64_t solid = 0;
  for (std::size_t i = 0; i < slab.layer_size() * static_cast<std::size_t>(slab.layers); ++i) {
    solid += map.solid[i] != 0 ? 1 : 0;
  }
  return {sum(solid, communicator),  std::move(white.domains), std::move(black.domains),
          std::move(black.touching), std::move(white.winding), std::move(black.winding)};
}

std::vector<double> chi_of_domains(const DomainCounts& counts) {
  std::vector<double> result(counts.n_W.size(), 0.0);
  for (std::size_t j = 0; counts.pixels > 0 && j < result.size(); ++j) {
    result[j] =
        static_cast<double>(counts.n_W[j] - counts.n_B[j]) / static_cast<double>(counts.pixels);
  }
  return result;
}

template DomainCounts count_domains<2>(const PixelField<2>&, std::size_t, std::span<const double>,
                                       Joining, MPI_Comm);
template DomainCounts count_domains<3>(const PixelField<3>&, std::size_t, std::span<const double>,
                                       Joining, MPI_Comm);

}  // namespace poreshock
