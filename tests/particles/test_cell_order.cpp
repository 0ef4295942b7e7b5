// The canonical order (cell, grain, id) does not know how particles are stored.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

#include "poreshock/particles/cell_order.hpp"
#include "support/shuffle.hpp"

namespace poreshock {
namespace {

using test::natural_order;
using test::shuffled;

/// The three sort keys of some particles, in storage order.
struct Keys {
  std::vector<std::uint32_t> cell;
  std::vector<std::int32_t> grain;
  std::vector<std::int64_t> id;

  auto key(std::uint32_t p) const { return std::tuple(cell[p], grain[p], id[p]); }
};

Keys random_keys(int count, int cells, std::uint64_t seed) {
  reference::Random random{seed};
  Keys keys;
  for (int p = 0; p < count; ++p) {
    keys.cell.push_back(static_cast<std::uint32_t>(random.below(cells)));
    keys.grain.push_back(random.below(3) - 1);
    // Distinct, without order, above 2^32 and below 0.
    keys.id.push_back((std::int64_t{p} * 7919 % 1000003) * 1000000007 - 5000000000);
  }
  return keys;
}

Keys stored_as(const std::vector<std::uint32_t>& order, const Keys& keys) {
  Keys result;
  for (const std::uint32_t p : order) {
    result.cell.push_back(keys.cell[p]);
    result.grain.push_back(keys.grain[p]);
    result.id.push_back(keys.id[p]);
  }
  return result;
}

std::vector<std::int64_t> ids_in_order(const Keys& keys, std::size_t cells, CellOrder& result) {
  sort_by_cell(keys.cell, cells, keys.grain, keys.id, result);
  std::vector<std::int64_t> ids;
  for (const std::uint32_t p : result.order) ids.push_back(keys.id[p]);
  return ids;
}

TEST(CellOrder, SortsByCellThenGrainThenId) {
  constexpr std::size_t cells = 37;
  const Keys keys = random_keys(500, static_cast<int>(cells) - 2, 3);
  CellOrder result;
  sort_by_cell(keys.cell, cells, keys.grain, keys.id, result);
  std::vector<std::uint32_t> expected = natural_order(keys.id.size());
  std::sort(expected.begin(), expected.end(),
            [&](std::uint32_t a, std::uint32_t b) { return keys.key(a) < keys.key(b); });
  EXPECT_EQ(result.order, expected);
  ASSERT_EQ(result.start.size(), cells + 1);
  for (std::uint32_t c = 0; c <= cells; ++c) {
    EXPECT_EQ(result.start[c], static_cast<std::uint32_t>(
                                   std::count_if(keys.cell.begin(), keys.cell.end(),
                                                 [c](std::uint32_t cell) { return cell < c; })));
  }
}

TEST(CellOrder, DoesNotDependOnStorage) {
  constexpr std::size_t cells = 20;
  const Keys keys = random_keys(400, static_cast<int>(cells), 5);
  // One result object for all: nothing of an earlier sort may stay in it.
  CellOrder result;
  const std::vector<std::int64_t> expected = ids_in_order(keys, cells, result);
  const std::vector<std::uint32_t> start = result.start;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const Keys other = stored_as(shuffled(keys.id.size(), seed), keys);
    EXPECT_EQ(ids_in_order(other, cells, result), expected);
    EXPECT_EQ(result.start, start);
  }
}

TEST(CellOrder, LeavesOutWhatRests) {
  constexpr std::size_t cells = 20;
  const Keys keys = random_keys(400, static_cast<int>(cells), 7);
  CellOrder all, some;
  some.resting = {30, 150};
  sort_by_cell(keys.cell, cells, keys.grain, keys.id, all);
  sort_by_cell(keys.cell, cells, keys.grain, keys.id, some);
  std::erase_if(all.order, [](std::uint32_t p) { return p < 150; });
  EXPECT_EQ(some.order, all.order);
  EXPECT_EQ(some.start.back(), 250U);
}

TEST(CellOrder, OfNoParticlesIsEmpty) {
  CellOrder result;
  result.start = {1, 2, 3}, result.order = {4, 5};
  sort_by_cell({}, 3, {}, {}, result);
  EXPECT_EQ(result.start, (std::vector<std::uint32_t>{0, 0, 0, 0}));
  EXPECT_TRUE(result.order.empty());
}

}  // namespace
}  // namespace poreshock
