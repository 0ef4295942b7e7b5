// Sides of a node: which parts of one grain face each other.
#include <gtest/gtest.h>

#include "poreshock/physics/self_contact.hpp"
#include "poreshock/transfer/node_lanes.hpp"

namespace {

using namespace poreshock;

/// Sums of a quarter of volume 1: mean direction and place relative to the node.
Lanes quarter(double gx, double gy, double x, double y) {
  using Surface = SurfaceLane<2>;
  Lanes lanes{};
  lanes[Surface::volume] = 1.0;
  lanes[Surface::facing] = gx;
  lanes[Surface::facing + 1] = gy;
  lanes[Surface::place] = x;
  lanes[Surface::place + 1] = y;
  return lanes;
}

const Lanes nothing{};

TEST(SidesOfNode, QuartersAreToldByTheLargerComponent) {
  EXPECT_EQ(facing_quarter(0.0, 0.0), 0);
  EXPECT_EQ(facing_quarter(0.1, -0.9), 0);
  EXPECT_EQ(facing_quarter(0.1, 0.9), 1);
  EXPECT_EQ(facing_quarter(-0.9, 0.1), 2);
  EXPECT_EQ(facing_quarter(0.9, -0.1), 3);
}

TEST(SidesOfNode, AnEmptyNodeHasNoneAndOneQuarterIsOne) {
  EXPECT_EQ(sides_of_node(QuarterSums{nothing, nothing, nothing, nothing}), (NodeSides{0, 0}));
  EXPECT_EQ(sides_of_node(QuarterSums{nothing, nothing, quarter(-1, 0, 0, 0), nothing}),
            (NodeSides{4, 0}));
}

TEST(SidesOfNode, WallsThatFaceEachOtherAreTwo) {
  // Down above, up below.
  EXPECT_EQ(
      sides_of_node(QuarterSums{quarter(0.2, -1, 0, 1), quarter(0.1, 1, 0, -1), nothing, nothing}),
      (NodeSides{2, 1}));
  // Left on the right side, right on the left one.
  EXPECT_EQ(
      sides_of_node(QuarterSums{nothing, nothing, quarter(-1, 0.2, 1, 0), quarter(1, 0.1, -1, 0)}),
      (NodeSides{8, 4}));
}

TEST(SidesOfNode, FacesOfALigamentAreOne) {
  EXPECT_EQ(
      sides_of_node(QuarterSums{quarter(0, -1, 0, -1), quarter(0, 1, 0, 1), nothing, nothing}),
      (NodeSides{3, 0}));
}

TEST(SidesOfNode, CornersAndRoundWallsAreOne) {
  EXPECT_EQ(sides_of_node(QuarterSums{nothing, quarter(0, 1, 0, 1), nothing, quarter(1, 0, 1, 0)}),
            (NodeSides{10, 0}));
  // The floor of a round void with both its flanks.
  EXPECT_EQ(sides_of_node(QuarterSums{nothing, quarter(0, 1, 0, -1), quarter(-0.7, 0.7, 1, 0.2),
                                      quarter(0.7, 0.7, -1, 0.2)}),
            (NodeSides{14, 0}));
}

// A void that has closed from all sides: its flanks go with the half they look along with.
TEST(SidesOfNode, ACollapsedVoidHasTwoHalves) {
  EXPECT_EQ(sides_of_node(QuarterSums{quarter(0, -1, 0, 1), quarter(0, 1, 0, -1),
                                      quarter(-0.9, -0.3, 1, 0.1), quarter(0.9, 0.3, -1, -0.1)}),
            (NodeSides{10, 5}));
}

// What faces nothing stays with what it touches as long as nothing else closes.
TEST(SidesOfNode, MaterialFarFromSurfacesChangesNothing) {
  EXPECT_EQ(sides_of_node(QuarterSums{quarter(0, 0, 0, -1), quarter(0, 1, 0, 0), nothing, nothing}),
            (NodeSides{3, 0}));
}

}  // namespace
