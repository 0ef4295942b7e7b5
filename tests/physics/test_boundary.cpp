// Walls and symmetry planes: single planes against closed forms, corners against the mean over all
// mirror images, energy and momentum to round-off, mirrors and slabs to the bit.

#include <map>

#include "physics/node_fields.hpp"
#include "poreshock/physics/boundary.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::test;

template <int Dim>
using Field = std::map<NodeIndex<Dim>, Lanes>;

/// Random motion of a node: mass, start and end velocities, some heat.
template <int Dim>
Lanes random_motion(const NodeIndex<Dim>& index, std::uint64_t seed) {
  using Motion = MotionLane<Dim>;
  reference::Random random = random_at<Dim>(index, seed);
  Lanes node{};
  node[Motion::mass] = 1.0e-6 * (0.05 + random.uniform());
  for (int a = 0; a < 2 * Dim; ++a) node[a] = 3000.0 * (random.uniform() - 0.5);
  node[Motion::heat] = 100.0 * random.uniform();
  return node;
}

template <int Dim>
std::unique_ptr<SlabGrid> grid_of(const std::array<int, Dim>& cells, const auto& motion,
                                  MPI_Comm communicator = MPI_COMM_SELF) {
  auto grid = make_grid(shape_of<Dim>(cells), communicator);
  grid->clear();
  for_each_node<Dim>(*grid,
                     [&](const NodeIndex<Dim>& index, Lanes& node) { node = motion(index); });
  return grid;
}

template <int Dim>
Field<Dim> field_of(SlabGrid& grid) {
  Field<Dim> field;
  for_each_node<Dim>(grid, [&](const NodeIndex<Dim>& i, const Lanes& node) { field[i] = node; });
  return field;
}

Boundary sides(SideKind low, SideKind high, SideKind lateral = SideKind::free) {
  Boundary boundary;
  boundary.low.kind = low;
  boundary.high.kind = high;
  boundary.lateral = {lateral, lateral};
  return boundary;
}

template <int Dim>
void expect_unchanged(const Lanes& found, const Lanes& expected) {
  for (int k = 0; k < lane_count; ++k) EXPECT_EQ(found[k], expected[k]) << "lane " << k;
}

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
                                      {5e-7, 2e-6, -200.0, 201.0, 1.0, 2.0},
                                      {5e-7, 2e-6, -200.0, 199.0, 1.0, 2.0}}};
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

/// The mean over all images in the planes of the axes that hold, weighted by mass: what a symmetric
/// field near these planes must be. A node on a plane is its own image.
template <int Dim>
std::array<double, Dim> mean_of_images(const Field<Dim>& before, const NodeIndex<Dim>& index,
                                       const std::array<bool, Dim>& holds,
                                       const std::array<int, 3>& nodes) {
  std::array<double, Dim> sum{};
  double mass = 0.0;
  for (int images = 0; images < 1 << Dim; ++images) {
    NodeIndex<Dim> at = index;
    bool exists = true;
    for (int a = 0; a < Dim; ++a) {
      if ((images >> a & 1) == 0) continue;
      const int last = nodes[a] - 1;
      const int image = index[a] <= 2 ? 2 - index[a] : 2 * (last - 1) - index[a];
      exists = exists && holds[a] && image >= 0 && image <= last &&
               (index[a] <= 2 || index[a] >= last - 2);
      at[a] = image;
    }
    if (!exists) continue;
    const Lanes& node = before.at(at);
    mass += node[MotionLane<Dim>::mass];
    for (int a = 0; a < Dim; ++a) {
      sum[a] += ((images >> a & 1) == 0 ? 1.0 : -1.0) * node[MotionLane<Dim>::mass] * node[a];
    }
  }
  for (double& x : sum) x /= mass;
  return sum;
}

/// Velocity into both walls of the axes that approach, away from those of the others, with noise.
template <int Dim>
Lanes towards_walls(const NodeIndex<Dim>& index, const std::array<bool, Dim>& approaches,
                    const std::array<int, 3>& nodes) {
  Lanes node = random_motion<Dim>(index, 31);
  for (int a = 0; a < Dim; ++a) {
    const double outward = 2 * index[a] < nodes[a] ? -1.0 : 1.0;
    node[a] = (approaches[a] ? 1.0 : -1.0) * outward * 1000.0 + 0.1 * node[a];
  }
  return node;
}

/// All sides are walls: those the material approaches hold, the others let go.
template <int Dim>
void corners_of_walls(const std::array<int, Dim>& cells, int approaching) {
  const std::array<int, 3> nodes = shape_of<Dim>(cells).nodes;
  std::array<bool, Dim> approaches;
  for (int a = 0; a < Dim; ++a) approaches[a] = (approaching >> a & 1) != 0;
  const auto grid = grid_of<Dim>(
      cells, [&](const NodeIndex<Dim>& i) { return towards_walls<Dim>(i, approaches, nodes); });
  const Field<Dim> before = field_of<Dim>(*grid);
  NodeLedger ledger = fine_ledger();
  apply_boundaries<Dim>(sides(SideKind::wall, SideKind::wall, SideKind::wall), Vector<Dim>::Zero(),
                        *grid, ledger);
  for_each_node<Dim>(*grid, [&](const NodeIndex<Dim>& i, const Lanes& node) {
    bool held = false;
    for (int a = 0; a < Dim; ++a) {
      held = held || (approaches[a] && (i[a] <= 2 || i[a] >= nodes[a] - 3));
    }
    if (!held) return expect_unchanged<Dim>(node, before.at(i));
    const auto expected = mean_of_images<Dim>(before, i, approaches, nodes);
    for (int a = 0; a < Dim; ++a) EXPECT_NEAR(node[a], expected[a], 1e-12);
  });
}

TEST(Corner, OfTwoWallsInThePlane) {
  for (int approaching = 0; approaching < 4; ++approaching) {
    corners_of_walls<2>({6, 9}, approaching);
  }
}

TEST(Corner, OfThreeWallsInSpace) {
  for (int approaching = 0; approaching < 8; ++approaching) {
    corners_of_walls<3>({5, 6, 9}, approaching);
  }
}

TEST(Corner, OfSymmetryPlanes) {
  const std::array<int, 3> cells = {5, 6, 9};
  const std::array<int, 3> nodes = shape_of<3>(cells).nodes;
  const auto grid =
      grid_of<3>(cells, [](const NodeIndex<3>& i) { return random_motion<3>(i, 12); });
  const Field<3> before = field_of<3>(*grid);
  NodeLedger ledger = fine_ledger();
  apply_boundaries<3>(sides(SideKind::symmetry, SideKind::symmetry, SideKind::symmetry),
                      Vector<3>::Zero(), *grid, ledger);
  for_each_node<3>(*grid, [&](const NodeIndex<3>& i, const Lanes& node) {
    const auto expected = mean_of_images<3>(before, i, {true, true, true}, nodes);
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(node[a], expected[a], 1e-12);
  });
}

/// What a random field and its ledger must obey with any kinds of sides and any velocity of them.
template <int Dim>
void energy_and_momentum(const std::array<int, Dim>& cells, const Boundary& boundary,
                         const Vector<Dim>& plane, bool forces, std::uint64_t seed) {
  using Motion = MotionLane<Dim>;
  const auto grid = grid_of<Dim>(cells, [&](const NodeIndex<Dim>& i) {
    Lanes node = random_motion<Dim>(i, seed);
    for (int a = 0; a < Dim && !forces; ++a) node[Motion::start_velocity + a] = node[a];
    return node;
  });
  const Field<Dim> before = field_of<Dim>(*grid);
  NodeLedger ledger = fine_ledger();
  apply_boundaries<Dim>(boundary, plane, *grid, ledger);
  double heat = 0.0, work = 0.0, gained = 0.0, kinetic = 0.0, size = 0.0;
  std::array<double, Dim> impulse{};
  for_each_node<Dim>(*grid, [&](const NodeIndex<Dim>& i, const Lanes& node) {
    const Lanes old = before.at(i);
    const double mass = node[Motion::mass];
    EXPECT_EQ(mass, old[Motion::mass]);
    heat += mass * (node[Motion::heat] - old[Motion::heat]);
    for (int a = 0; a < Dim; ++a) {
      const double start = node[Motion::start_velocity + a];
      EXPECT_EQ(start, old[Motion::start_velocity + a]);
      impulse[a] += mass * (node[a] - old[a]);
      size += mass * std::abs(old[a]);
      work += mass * (node[a] - old[a]) * 0.5 * (start + node[a]);
      gained += 0.5 * mass * (node[a] - old[a]) * (node[a] + old[a]);
      kinetic += 0.5 * mass * old[a] * old[a];
    }
  });
  const double booked_heat = energy(ledger.wall_heat, ledger);
  EXPECT_NEAR(booked_heat, heat, 1e-14 * kinetic);
  EXPECT_NEAR(energy(ledger.wall_work, ledger) - booked_heat, work, 1e-14 * kinetic);
  double work_of_planes = 0.0;
  for (int a = 0; a < Dim; ++a) {
    const double booked = momentum(ledger.wall_impulse[a], ledger);
    EXPECT_NEAR(booked, impulse[a], 1e-14 * size);
    work_of_planes += booked * plane[a];
  }
  EXPECT_NEAR(energy(ledger.wall_work, ledger), work_of_planes, 1e-14 * kinetic);
  if (!forces) {
    // Nothing but the planes acts: the kinetic energy lost is heat, less the work of the planes.
    EXPECT_NEAR(gained, energy(ledger.wall_work, ledger) - booked_heat, 1e-14 * kinetic);
    EXPECT_GT(booked_heat, 1e-3 * kinetic);
  }
}

TEST(Ledger, EnergyAndMomentumClose) {
  using enum SideKind;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const bool forces = seed % 2 == 0;
    energy_and_momentum<2>({7, 9}, sides(wall, free), {0.0, 0.0}, forces, seed);
    energy_and_momentum<2>({7, 9}, sides(wall, wall, wall), {0.0, 0.0}, forces, seed);
    energy_and_momentum<2>({7, 9}, sides(symmetry, wall, symmetry), {-40.0, 350.0}, forces, seed);
    energy_and_momentum<2>({7, 9}, sides(wall, symmetry, wall), {0.0, -800.0}, forces, seed);
    energy_and_momentum<3>({5, 4, 9}, sides(wall, free, wall), {20.0, 10.0, 350.0}, forces, seed);
    energy_and_momentum<3>({5, 4, 9}, sides(symmetry, wall, symmetry), {0.0, 0.0, 0.0}, forces,
                           seed);
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

/// Reflects a random field along an axis; the result must be the reflected one, to the bit.
template <int Dim>
void mirrored_to_the_bit(const std::array<int, Dim>& cells, const Boundary& boundary, int axis,
                         std::uint64_t seed) {
  using Motion = MotionLane<Dim>;
  const std::array<int, 3> nodes = shape_of<Dim>(cells).nodes;
  const auto image = [&](NodeIndex<Dim> i) {
    i[axis] = nodes[axis] - 1 - i[axis];
    return i;
  };
  const auto reflect = [&](Lanes node) {
    node[Motion::end_velocity + axis] = -node[Motion::end_velocity + axis];
    node[Motion::start_velocity + axis] = -node[Motion::start_velocity + axis];
    return node;
  };
  const auto motion = [&](const NodeIndex<Dim>& i) { return random_motion<Dim>(i, seed); };
  const auto grid = grid_of<Dim>(cells, motion);
  const auto mirror =
      grid_of<Dim>(cells, [&](const NodeIndex<Dim>& i) { return reflect(motion(image(i))); });
  NodeLedger ledger = fine_ledger(), seen = fine_ledger();
  apply_boundaries<Dim>(boundary, Vector<Dim>::Zero(), *grid, ledger);
  apply_boundaries<Dim>(boundary, Vector<Dim>::Zero(), *mirror, seen);
  for_each_node<Dim>(*mirror, [&](const NodeIndex<Dim>& i, const Lanes& node) {
    expect_unchanged<Dim>(reflect(node), node_at<Dim>(*grid, image(i)));
  });
  EXPECT_TRUE(seen.wall_heat == ledger.wall_heat);
  EXPECT_TRUE(seen.wall_impulse[axis] == -ledger.wall_impulse[axis]);
  EXPECT_FALSE(ledger.wall_heat == 0);
}

TEST(Mirror, BoundariesAreSymmetricToTheBit) {
  using enum SideKind;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    for (int axis = 0; axis < 2; ++axis) {
      mirrored_to_the_bit<2>({7, 9}, sides(wall, wall, wall), axis, seed);
      mirrored_to_the_bit<2>({7, 10}, sides(symmetry, symmetry, wall), axis, seed);
    }
    for (int axis = 0; axis < 3; ++axis) {
      mirrored_to_the_bit<3>({5, 4, 9}, sides(wall, wall, wall), axis, seed);
    }
  }
}

/// A slab grid holds the bits of the whole one and books each node once. Collective.
template <int Dim>
void same_bits_in_slabs(const std::array<int, Dim>& cells, const Boundary& boundary) {
  const auto motion = [](const NodeIndex<Dim>& i) { return random_motion<Dim>(i, 5); };
  const auto slabs = grid_of<Dim>(cells, motion, MPI_COMM_WORLD);
  const auto whole = grid_of<Dim>(cells, motion, MPI_COMM_SELF);
  const Vector<Dim> plane = Vector<Dim>::LinSpaced(30.0, -120.0);
  NodeLedger ledger = fine_ledger(), expected = fine_ledger();
  apply_boundaries<Dim>(boundary, plane, *slabs, ledger);
  apply_boundaries<Dim>(boundary, plane, *whole, expected);
  expect_same_nodes<Dim>(*slabs, *whole);
  EXPECT_TRUE(totals(ledger, MPI_COMM_WORLD) == totals(expected, MPI_COMM_SELF));
}

TEST(Slabs, SameBits) {
  using enum SideKind;
  same_bits_in_slabs<2>({6, 12}, sides(wall, wall, wall));
  same_bits_in_slabs<2>({6, 13}, sides(symmetry, wall, symmetry));
  same_bits_in_slabs<2>({6, 25}, sides(wall, free));
  same_bits_in_slabs<3>({4, 3, 14}, sides(wall, symmetry, wall));
}

}  // namespace
