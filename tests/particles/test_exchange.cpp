// Particles change ranks without a lost, doubled or altered one.
#include <gtest/gtest.h>

#include <algorithm>

#include "particles/numbered.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/particles/exchange.hpp"

namespace poreshock {
namespace {

using test::first_wrong_number;
using test::numbered_particles;

const MPI_Comm world = MPI_COMM_WORLD;
constexpr std::int64_t total = 200;

/// A number below n that follows from an id and a seed.
int choice(std::int64_t id, std::uint64_t seed, int n) {
  reference::Random random{static_cast<std::uint64_t>(id) * 31 + seed};
  return random.below(n);
}

std::vector<std::int64_t> ids_where(const std::vector<int>& owner, int wanted) {
  std::vector<std::int64_t> ids;
  for (std::int64_t id = 0; id < total; ++id) {
    if (owner[static_cast<std::size_t>(id)] == wanted) ids.push_back(id);
  }
  return ids;
}

template <int Dim>
void expect_exactly(std::vector<std::int64_t> ids, const Particles<Dim>& particles) {
  std::vector<std::int64_t> found = particles.id;
  std::sort(found.begin(), found.end());
  EXPECT_EQ(found, ids);
  EXPECT_EQ(first_wrong_number(particles), "");
}

/// Sends particles to random ranks a few times; a tenth of them is dropped each time.
template <int Dim>
void scatter_at_random(ParticleOptions options) {
  const int ranks = size(world);
  std::vector<int> owner(static_cast<std::size_t>(total), 0);
  for (std::int64_t id = 0; id < total; ++id) owner[id] = choice(id, 0, ranks);
  Particles<Dim> particles = numbered_particles<Dim>(options, ids_where(owner, rank(world)));
  for (std::uint64_t round = 1; round < 5; ++round) {
    for (std::int64_t id = 0; id < total; ++id) {
      if (owner[id] >= 0)
        owner[id] = choice(id, round, 10) == 0 ? -1 : choice(id, 100 + round, ranks);
    }
    std::vector<int> destination;
    for (const std::int64_t id : particles.id) destination.push_back(owner[id]);
    redistribute(destination, particles, world);
    expect_exactly(ids_where(owner, rank(world)), particles);
  }
}

TEST(Redistribute, KeepsEveryParticleOnceBitForBit) {
  scatter_at_random<2>({true, true, true});
  scatter_at_random<3>({true, true, false});
  scatter_at_random<3>({true, false, false});
  scatter_at_random<3>({false, false, true});
}

TEST(Redistribute, BringsEverythingToOneRankAndBack) {
  const int ranks = size(world), me = rank(world), last = ranks - 1;
  std::vector<std::int64_t> mine, all;
  for (std::int64_t id = 0; id < total; ++id) {
    all.push_back(id);
    if (id % ranks == me) mine.push_back(id);
  }
  Particles<2> particles = numbered_particles<2>({true, true, false}, mine);
  redistribute(std::vector<int>(particles.size(), last), particles, world);
  expect_exactly(me == last ? all : std::vector<std::int64_t>{}, particles);
  std::vector<int> home;
  for (const std::int64_t id : particles.id) home.push_back(static_cast<int>(id % ranks));
  redistribute(home, particles, world);
  expect_exactly(mine, particles);
}

/// Random walks of particles over the ranks: down, up, out, or stay.
template <int Dim>
void walk_at_random(ParticleOptions options) {
  const int ranks = size(world), me = rank(world);
  std::vector<int> owner(static_cast<std::size_t>(total), 0);
  for (std::int64_t id = 0; id < total; ++id) owner[id] = choice(id, 0, ranks);
  Particles<Dim> particles = numbered_particles<Dim>(options, ids_where(owner, me));
  for (std::uint64_t round = 1; round < 6; ++round) {
    std::vector<std::uint32_t> down, up, gone;
    const auto moves = [&](std::int64_t id, int from) {
      const int move = choice(id, round, 8);
      if (move == 0 && from > 0) return -1;
      if (move == 1 && from + 1 < ranks) return 1;
      return move == 2 ? 2 : 0;
    };
    for (std::uint32_t p = 0; p < particles.size(); ++p) {
      const int move = moves(particles.id[p], me);
      if (move == -1) down.push_back(p);
      if (move == 1) up.push_back(p);
      if (move == 2) gone.push_back(p);
    }
    for (int& from : owner) {
      if (from < 0) continue;
      const int move = moves(&from - owner.data(), from);
      from = move == 2 ? -1 : from + move;
    }
    exchange_with_neighbours(down, up, gone, particles, world);
    expect_exactly(ids_where(owner, me), particles);
  }
}

TEST(Neighbours, KeepEveryParticleOnceBitForBit) {
  walk_at_random<2>({true, true, false});
  walk_at_random<2>({false, false, false});
  walk_at_random<3>({true, true, true});
}

TEST(Neighbours, MayExchangeAllTheyHave) {
  // Every rank sends all it has to one side, so some receive nothing and some lose everything.
  const int ranks = size(world), me = rank(world);
  const std::vector<std::int64_t> ids = {10 * me, 10 * me + 1, 10 * me + 2};
  Particles<3> particles = numbered_particles<3>({true, true, true}, ids);
  if (me + 1 < ranks) {
    exchange_with_neighbours({}, {0, 1, 2}, {}, particles, world);
  } else {
    exchange_with_neighbours({}, {}, {0, 1, 2}, particles, world);
  }
  const std::int64_t below = 10 * (me - 1);
  expect_exactly(
      me > 0 ? std::vector<std::int64_t>{below, below + 1, below + 2} : std::vector<std::int64_t>{},
      particles);
}

TEST(Neighbours, HolesAreFilledFromTheEnd) {
  Particles<2> particles = numbered_particles<2>({true, true, false}, {0, 1, 2, 3, 4, 5, 6});
  exchange_with_neighbours({}, {}, {1, 4, 6}, particles, MPI_COMM_SELF);
  EXPECT_EQ(particles.id, (std::vector<std::int64_t>{0, 5, 2, 3}));
  EXPECT_EQ(first_wrong_number(particles), "");
}

}  // namespace
}  // namespace poreshock
