// Corners against the mean over all mirror images, energy and momentum to round-off, mirrors and
// slabs to the bit.

#include "physics/boundary_fields.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::test;

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
