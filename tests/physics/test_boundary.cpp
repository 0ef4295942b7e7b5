// Single walls and symmetry planes against closed forms.

#include "physics/boundary_fields.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::test;

/// A wall at the low side under pairs of mirror nodes: nodes 0 and 2 with normal velocities u0, u2.
struct Pair {
  double mass0, mass2, u0, u2, slip0, slip2;
};

// A pair is pushed when u0 + u2 < 0, by the impulse -2 m0 m2 (u0 + u2)/(m0 + m2), else untouched.
TEST(Wall, PushesOnly) {
  const std::array<Pair, 6> pairs = {{{1e-6, 3e-6, -500.0, -700.0, 100.0, -40.0},
                                      {2e-6, 1e-6, 900.0, -1000.0, 0.0, 70.0},
                                      {2e-6, 1e-6, 1000.0, -900.0, 30.0, 70.0},
                                      {1e-6, 1e-6, 5.0, 6.0, -20.0, 20.0},
                                      {5e-7, 2e-6, -200.0, 200.000001, 1.0, 2.0},
                                      {5e-7, 2e-6, -200.0, 199.999999, 1.0, 2.0}}};
  const auto motion = [&](const NodeIndex<2>& i) {
    Lanes node = random_motion<2>(i, 3);
    const Pair& pair = pairs[static_cast<std::size_t>(i[0]) % 6];
    const bool low = i[1] == 0;
    if (i[1] > 2) return node;
    // The node on the plane moves like node 2.
    node[0] = low ? pair.slip0 : pair.slip2;
    node[1] = low ? pair.u0 : pair.u2;
    node[5] = low ? pair.mass0 : pair.mass2;
    return node;
  };
  const auto grid = grid_of<2>({8, 9}, motion);
  NodeLedger ledger = fine_ledger();
  apply_boundaries<2>(sides(SideKind::wall, SideKind::free), {0.0, 0.0}, *grid, ledger);
  double impulse = 0.0;
  for_each_node<2>(*grid, [&](const NodeIndex<2>& i, const Lanes& node) {
    const Lanes before = motion(i);
    const Pair& p = pairs[static_cast<std::size_t>(i[0]) % 6];
    const bool on_plane = i[1] == 1, pushed = on_plane ? p.u2 < 0.0 : p.u0 + p.u2 < 0.0;
    if (i[1] > 2 || !pushed) return expect_unchanged<2>(node, before);
    if (on_plane) {
      EXPECT_EQ(node[1], 0.0);
      EXPECT_EQ(node[0], before[0]);
      impulse -= before[5] * p.u2;
      return;
    }
    const double mass = p.mass0 + p.mass2;
    const double end = (p.mass2 * p.u2 - p.mass0 * p.u0) / mass;
    EXPECT_NEAR(node[1], i[1] == 2 ? end : -end, 1e-12);
    EXPECT_NEAR(node[0], (p.mass2 * p.slip2 + p.mass0 * p.slip0) / mass, 1e-13);
    if (i[1] == 2) impulse -= 2.0 * p.mass0 * p.mass2 * (p.u0 + p.u2) / mass;
  });
  EXPECT_NEAR(momentum(ledger.wall_impulse[1], ledger), impulse, 1e-14 * impulse);
  EXPECT_NEAR(momentum(ledger.wall_impulse[0], ledger), 0.0, 1e-14 * impulse);
  EXPECT_TRUE(ledger.wall_work == 0);
}

// The same at the high side, where the wall pushes down.
TEST(Wall, PushesDownAtTheTop) {
  for (const double v : {300.0, -300.0}) {
    const auto motion = [&](const NodeIndex<2>& i) {
      Lanes node = random_motion<2>(i, 8);
      node[1] = v;
      return node;
    };
    const auto grid = grid_of<2>({5, 9}, motion);
    NodeLedger ledger = fine_ledger();
    apply_boundaries<2>(sides(SideKind::free, SideKind::wall), {0.0, 0.0}, *grid, ledger);
    for_each_node<2>(*grid, [&](const NodeIndex<2>& i, const Lanes& node) {
      if (v < 0.0 || i[1] < 9) return expect_unchanged<2>(node, motion(i));
      const double expected = i[1] == 10 ? 0.0 : -node_at<2>(*grid, {i[0], 20 - i[1]})[1];
      EXPECT_EQ(node[1], expected);
    });
    EXPECT_EQ(ledger.wall_impulse[1]<0, v> 0.0);
  }
}

// Friction takes mu times the push from what slides, at most all of it; its heat stands by itself.
TEST(Wall, RubsLikeCoulomb) {
  for (const double slip : {500.0, 30.0}) {
    const double mass = 2e-6, push = 200.0, friction = 0.4;
    const auto motion = [&](const NodeIndex<2>& i) {
      Lanes node{};
      node[0] = node[2] = slip;
      node[1] = -push;
      node[5] = i[1] == 1 ? mass : 0.0;
      return node;
    };
    const auto grid = grid_of<2>({5, 9}, motion);
    NodeLedger ledger = fine_ledger();
    Boundary boundary = sides(SideKind::wall, SideKind::free);
    boundary.low.friction = friction;
    apply_boundaries<2>(boundary, {0.0, 0.0}, *grid, ledger);
    const double end = std::max(slip - friction * push, 0.0);
    double nodes = 0.0;
    for_each_node<2>(*grid, [&](const NodeIndex<2>& i, const Lanes& node) {
      if (i[1] != 1) return;
      EXPECT_NEAR(node[0], end, 1e-12);
      EXPECT_EQ(node[1], 0.0);
      ++nodes;
    });
    EXPECT_NEAR(momentum(ledger.wall_impulse[0], ledger), nodes * mass * (end - slip),
                1e-13 * nodes * mass * slip);
    const double heat = nodes * mass * (slip - end) * 0.5 * (slip + end);
    EXPECT_NEAR(energy(ledger.friction_heat, ledger), heat, 1e-12 * heat);
  }
}

TEST(SymmetryPlane, HoldsBothWays) {
  for (const double v : {300.0, -300.0}) {
    const auto motion = [&](const NodeIndex<2>& i) {
      Lanes node = random_motion<2>(i, 8);
      node[1] = v;
      return node;
    };
    const auto grid = grid_of<2>({5, 9}, motion);
    NodeLedger ledger = fine_ledger();
    apply_boundaries<2>(sides(SideKind::symmetry, SideKind::free), {0.0, 0.0}, *grid, ledger);
    for (int x = 0; x < 8; ++x) {
      EXPECT_EQ(node_at<2>(*grid, {x, 1})[1], 0.0);
      EXPECT_EQ(node_at<2>(*grid, {x, 0})[1], -node_at<2>(*grid, {x, 2})[1]);
      EXPECT_EQ(node_at<2>(*grid, {x, 0})[0], node_at<2>(*grid, {x, 2})[0]);
    }
    EXPECT_EQ(ledger.wall_impulse[1] > 0, v < 0.0);
  }
}

// One node on a moving wall: impulse m (w - u), work w times that, heat m (u - w)^2/2 without
// forces.
TEST(Wall, MovingWallDoesWork) {
  const double mass = 2.0e-6, u = 100.0, w = 400.0;
  const auto motion = [&](const NodeIndex<2>& i) {
    Lanes node{};
    if (i == NodeIndex<2>{3, 1}) node = Lanes{7.0, u, 7.0, u, 50.0, mass};
    return node;
  };
  const auto grid = grid_of<2>({5, 9}, motion);
  NodeLedger ledger = fine_ledger();
  apply_boundaries<2>(sides(SideKind::wall, SideKind::free), {0.0, w}, *grid, ledger);
  const Lanes node = node_at<2>(*grid, {3, 1});
  const double heat = 0.5 * (u - w) * (u - w);
  EXPECT_EQ(node[1], w);
  EXPECT_EQ(node[0], 7.0);
  EXPECT_NEAR(node[4], 50.0 + heat, 1e-14 * heat);
  EXPECT_NEAR(momentum(ledger.wall_impulse[1], ledger), mass * (w - u), 1e-14 * mass * w);
  EXPECT_NEAR(energy(ledger.wall_work, ledger), mass * (w - u) * w, 1e-14 * mass * w * w);
  EXPECT_NEAR(energy(ledger.wall_heat, ledger), mass * heat, 1e-14 * mass * w * w);
}

// Walls and material seen from a frame that moves: the same result, moved.
TEST(Wall, FrameDoesNotMatter) {
  const Vector<2> frame = {250.0, -1100.0};
  const auto still = [](const NodeIndex<2>& i) { return random_motion<2>(i, 77); };
  const auto moved = [&](const NodeIndex<2>& i) {
    Lanes node = still(i);
    for (int k = 0; k < 4; ++k) node[k] += frame[k % 2];
    return node;
  };
  const auto a = grid_of<2>({7, 9}, still), b = grid_of<2>({7, 9}, moved);
  NodeLedger first = fine_ledger(), second = fine_ledger();
  const Boundary boundary = sides(SideKind::wall, SideKind::symmetry, SideKind::wall);
  apply_boundaries<2>(boundary, {0.0, 0.0}, *a, first);
  apply_boundaries<2>(boundary, frame, *b, second);
  for_each_node<2>(*a, [&](const NodeIndex<2>& i, const Lanes& node) {
    const Lanes other = node_at<2>(*b, i);
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(other[k] - frame[k % 2], node[k], 1e-11);
    EXPECT_NEAR(other[4], node[4], 1e-14 * 1e7);
  });
  EXPECT_NEAR(energy(second.wall_heat, second), energy(first.wall_heat, first), 1e-14 * 100.0);
}

}  // namespace
