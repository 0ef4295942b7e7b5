// Momentum balance at the nodes and the work of a body force.

#include <cmath>
#include <limits>

#include "physics/node_fields.hpp"
#include "poreshock/physics/momentum.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::test;

constexpr double dt = 2.0e-9;

/// Sums of a node: mass, momentum, force. Every seventh node or so is empty.
template <int Dim>
Lanes random_sums(const NodeIndex<Dim>& index) {
  using Sum = SumLane<Dim>;
  reference::Random random = random_at<Dim>(index, 5);
  Lanes sums{};
  if (random.below(7) == 0) return sums;
  sums[Sum::mass] = 1.0e-6 * (0.01 + random.uniform());
  for (int a = 0; a < Dim; ++a) {
    sums[Sum::momentum + a] = sums[Sum::mass] * 3000.0 * (random.uniform() - 0.5);
    sums[Sum::force + a] = 1.0e6 * (random.uniform() - 0.5);
  }
  return sums;
}

template <int Dim>
std::unique_ptr<SlabGrid> summed_grid(const std::array<int, Dim>& cells, MPI_Comm communicator) {
  auto grid = make_grid(shape_of<Dim>(cells), communicator);
  grid->clear();
  for_each_node<Dim>(
      *grid, [](const NodeIndex<Dim>& index, Lanes& node) { node = random_sums<Dim>(index); });
  return grid;
}

// v = p/m, v' = v + dt (f/m + b); no heat, whatever lay in the lanes beyond the sums.
template <int Dim>
void follows_newton(const std::array<int, Dim>& cells) {
  using Sum = SumLane<Dim>;
  using Motion = MotionLane<Dim>;
  const auto grid = summed_grid<Dim>(cells, MPI_COMM_SELF);
  Vector<Dim> body = Vector<Dim>::Constant(-3.0e9);
  body[0] = 1.0e9;
  for_each_node<Dim>(*grid, [](const NodeIndex<Dim>&, Lanes& node) {
    for (int k = SumLane<Dim>::count; k < lane_count; ++k) node[k] = 1.0e30;
  });
  integrate_momentum<Dim>(body, dt, *grid);
  int empty = 0, full = 0;
  for_each_node<Dim>(*grid, [&](const NodeIndex<Dim>& index, const Lanes& node) {
    const Lanes sums = random_sums<Dim>(index);
    const double mass = sums[Sum::mass];
    if (!(mass > 0.0)) {
      ++empty;
      for (int k = 0; k < lane_count; ++k) EXPECT_EQ(node[k], 0.0);
      return;
    }
    ++full;
    for (int a = 0; a < Dim; ++a) {
      const double v = sums[Sum::momentum + a] / mass;
      EXPECT_NEAR(node[Motion::start_velocity + a], v, 1e-15 * 1500.0);
      EXPECT_NEAR(node[Motion::end_velocity + a], v + dt * (sums[Sum::force + a] / mass + body[a]),
                  1e-15 * (1500.0 + dt * 5.0e13));
    }
    EXPECT_EQ(node[Motion::mass], mass);
    EXPECT_EQ(node[Motion::heat], 0.0);
  });
  EXPECT_GT(empty, 5);
  EXPECT_GT(full, 50);
}

TEST(Momentum, FollowsNewton) {
  follows_newton<2>({7, 11});
  follows_newton<3>({4, 3, 9});
}

// A particle without a finite mass must not vanish with its nodes: its neighbours show it to the
// stress update.
TEST(Momentum, AMassThatIsNoNumberGoesOn) {
  const auto grid = summed_grid<2>({6, 8}, MPI_COMM_SELF);
  const auto poisoned = [](const NodeIndex<2>& index) { return index[0] == 3 && index[1] == 4; };
  for_each_node<2>(*grid, [&](const NodeIndex<2>& index, Lanes& node) {
    if (poisoned(index)) node[SumLane<2>::mass] = std::numeric_limits<double>::quiet_NaN();
  });
  integrate_momentum<2>(Vector<2>::Zero(), dt, *grid);
  for_each_node<2>(*grid, [&](const NodeIndex<2>& index, const Lanes& node) {
    for (int a = 0; a < 2; ++a) {
      EXPECT_EQ(std::isfinite(node[MotionLane<2>::end_velocity + a]), !poisoned(index));
    }
  });
}

// Nothing may come out of a node without mass, whatever its other sums hold.
TEST(Momentum, EmptyNodesStayZero) {
  const auto grid = make_grid(shape_of<2>({5, 9}), MPI_COMM_SELF);
  for_each_node<2>(*grid, [](const NodeIndex<2>&, Lanes& node) {
    node = Lanes{0.0, 1.0, -2.0, 3.0, -4.0, 5.0, 6.0, 7.0};
  });
  integrate_momentum<2>({0.0, -9.81}, dt, *grid);
  for_each_node<2>(*grid, [](const NodeIndex<2>&, const Lanes& node) {
    for (int k = 0; k < lane_count; ++k) EXPECT_EQ(node[k], 0.0);
  });
}

// Without other forces the work of the body force is the kinetic energy gained, and its impulse the
// momentum.
template <int Dim>
void body_work_is_kinetic_energy(const std::array<int, Dim>& cells) {
  using Motion = MotionLane<Dim>;
  const auto grid = make_grid(shape_of<Dim>(cells), MPI_COMM_SELF);
  for_each_node<Dim>(*grid, [](const NodeIndex<Dim>& index, Lanes& node) {
    node = random_sums<Dim>(index);
    for (int a = 0; a < Dim; ++a) node[SumLane<Dim>::force + a] = 0.0;
  });
  const Vector<Dim> body = Vector<Dim>::LinSpaced(-4.0e10, 2.0e10);
  NodeLedger ledger = fine_ledger();
  integrate_momentum<Dim>(body, dt, *grid);
  add_body_work<Dim>(body, dt, *grid, ledger);
  double gained = 0.0, scale = 0.0, mass = 0.0;
  std::array<double, Dim> impulse{};
  for_each_node<Dim>(*grid, [&](const NodeIndex<Dim>&, const Lanes& node) {
    mass += node[Motion::mass];
    for (int a = 0; a < Dim; ++a) {
      const double start = node[Motion::start_velocity + a], end = node[Motion::end_velocity + a];
      gained += 0.5 * node[Motion::mass] * (end * end - start * start);
      scale += 0.5 * node[Motion::mass] * (end * end + start * start);
      impulse[a] += node[Motion::mass] * (end - start);
    }
  });
  EXPECT_GT(std::abs(gained), 1e-4 * scale);
  EXPECT_NEAR(energy(ledger.body_work, ledger), gained, 1e-14 * scale);
  for (int a = 0; a < Dim; ++a) {
    const double expected = mass * body[a] * dt;
    EXPECT_NEAR(momentum(ledger.body_impulse[a], ledger), expected, 1e-13 * std::abs(expected));
    EXPECT_NEAR(impulse[a], expected, 1e-13 * mass * 1500.0);
  }
}

TEST(Momentum, BodyWorkIsKineticEnergy) {
  body_work_is_kinetic_energy<2>({7, 11});
  body_work_is_kinetic_energy<3>({4, 3, 9});
}

// Slabs hold the bits of the whole grid, in the rows they share too, and book each node once.
TEST(Momentum, SameBitsInSlabs) {
  const std::array<int, 2> cells = {6, 17};
  const auto slabs = summed_grid<2>(cells, MPI_COMM_WORLD);
  const auto whole = summed_grid<2>(cells, MPI_COMM_SELF);
  const Vector<2> body = {1.0e9, -2.0e9};
  NodeLedger ledger = fine_ledger(), expected = fine_ledger();
  integrate_momentum<2>(body, dt, *slabs);
  integrate_momentum<2>(body, dt, *whole);
  add_body_work<2>(body, dt, *slabs, ledger);
  add_body_work<2>(body, dt, *whole, expected);
  expect_same_nodes<2>(*slabs, *whole);
  EXPECT_TRUE(totals(ledger, MPI_COMM_WORLD) == totals(expected, MPI_COMM_SELF));
}

}  // namespace
