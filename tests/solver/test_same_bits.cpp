// The same scene gives the same bits on any number of ranks, with or without restart or rebalance.
#include <gtest/gtest.h>

#include "support/same_bits.hpp"

namespace poreshock::test {
namespace {

constexpr std::int64_t steps = 200;

template <int Dim>
void expect_same_on_all_ranks(const Scene& scene, std::int64_t last) {
  const std::uint64_t alone = checksum_after<Dim>(scene, 1, last);
  for (int ranks = 2; ranks <= size(MPI_COMM_WORLD); ++ranks) {
    EXPECT_EQ(checksum_after<Dim>(scene, ranks, last), alone) << ranks << " ranks";
  }
}

TEST(SameBits, EveryTransferOnAllRanks) {
  for (const auto& transfer : all_transfers()) {
    SCOPED_TRACE(transfer.front());
    expect_same_on_all_ranks<2>(scene_of(porous_text(), transfer), steps);
  }
}

TEST(SameBits, QuadraticSplinesPaperMode) {
  for (const char* transfer : {"transfer.velocity=apic", "transfer.velocity=aflip"}) {
    SCOPED_TRACE(transfer);
    expect_same_on_all_ranks<2>(
        scene_of(porous_text(), {"transfer.shape=quadratic", transfer, "thermal=paper"}), steps);
  }
}

TEST(SameBits, CubicFlipDampedKinematicPlainViscosity) {
  expect_same_on_all_ranks<2>(
      scene_of(porous_text(), {"transfer.velocity=flip", "transfer.damping=0.2",
                               "viscosity.limited=false", "material.0.kinematic_share=0.5"}),
      steps);
}

TEST(SameBits, GimpFlip) {
  expect_same_on_all_ranks<2>(scene_of(porous_text(), {"transfer.preset=lineage"}), 200);
}

TEST(SameBits, LinearHats) {
  // Hats ring too much for a strong shock; a weak one will do.
  expect_same_on_all_ranks<2>(
      scene_of(porous_text(),
               {"transfer.shape=linear", "transfer.velocity=flip", "loading.velocity=50.0"}),
      200);
}

const std::vector<std::string> conduction = {"conduction.on=true", "material.0.conductivity=2e4"};

TEST(SameBits, HeatConduction) {
  expect_same_on_all_ranks<2>(scene_of(porous_text(), conduction), steps);
  std::vector<std::string> paper = conduction;
  paper.insert(paper.end(), {"thermal=paper", "transfer.shape=quadratic"});
  expect_same_on_all_ranks<2>(scene_of(porous_text(), paper), steps);
}

TEST(SameBits, WallsAllAroundAndMovingPiston) {
  Scene scene = scene_of(porous_text(), {"domain.periodic=false", "boundary.lateral=wall",
                                         "boundary.low={kind='wall', velocity=300.0}"});
  expect_same_on_all_ranks<2>(scene, steps);
}

TEST(SameBits, OpenSidesAndLeavingParticles) {
  Scene scene = scene_of(porous_text(),
                         {"domain.periodic=false", "boundary.low=free", "loading.velocity=3000.0"});
  expect_same_on_all_ranks<2>(scene, steps);
}

TEST(SameBits, SlabsAsThinAsAllowed) {
  // 15 rows of nodes on 4 ranks: 3 + 3 + 3 + 6, the least that the cubic spline allows.
  const Scene scene =
      scene_of(porous_text(), {"domain.size=[0.2e-3, 0.12e-3]", "sample.height=0.11e-3",
                               "sample.porosity=0.1", "sample.void_radius=20e-6"});
  if (size(MPI_COMM_WORLD) == 4) {
    on_ranks(4, [&](MPI_Comm part) {
      const Simulation<2> sim = start<2>(scene, part);
      EXPECT_EQ(sim.grid->starts(), (std::vector<int>{0, 3, 6, 9, 15}));
    });
  }
  expect_same_on_all_ranks<2>(scene, steps);
}

TEST(SameBits, RebalanceChangesNothing) {
  const Scene scene = scene_of(porous_text());
  const int ranks = size(MPI_COMM_WORLD);
  EXPECT_EQ(checksum_after<2>(scene, ranks, steps, 7), checksum_after<2>(scene, 1, steps));
}

std::string porous_3d_text() {
  return std::string(R"(
title = "porous block in 3-D"
[domain]
size = [80e-6, 80e-6, 200e-6]
cell = 10e-6
periodic = true
[boundary]
low = "wall"
high = "free"
[sample]
kind = "random_voids"
height = 180e-6
porosity = 0.1
void_radius = 20e-6
[loading]
velocity = 1100
[time]
end = 1e-6
)") + aluminium_text;
}

TEST(SameBits, PorousBlockIn3D) {
  for (const char* transfer : {"transfer.velocity=polyflip", "transfer.velocity=aflip"}) {
    SCOPED_TRACE(transfer);
    expect_same_on_all_ranks<3>(scene_of(porous_3d_text(), {transfer}), 60);
  }
}

TEST(SameBits, RestartMidShockOnOtherRanks) {
  const Scene scene = scene_of(porous_text());
  const std::uint64_t straight = checksum_after<2>(scene, 1, steps);
  const int all = size(MPI_COMM_WORLD);
  for (const int readers : {1, 2}) {
    if (readers > all) continue;
    EXPECT_EQ(checksum_with_restart<2>(scene, all, readers, 150, steps), straight)
        << all << " -> " << readers << " ranks";
  }
}

// All that a particle carries from step to step is in a checkpoint.
TEST(SameBits, RestartOfEveryTransfer) {
  for (const auto& transfer : all_transfers()) {
    const Scene scene = scene_of(porous_text(), transfer);
    EXPECT_EQ(checksum_with_restart<2>(scene, size(MPI_COMM_WORLD), 1, 80, 120),
              checksum_after<2>(scene, 1, 120))
        << transfer.front();
  }
}

TEST(SameBits, RestartWithHeatConduction) {
  std::vector<std::string> paper = conduction;
  paper.push_back("thermal=paper");
  const Scene scene = scene_of(porous_text(), paper);
  EXPECT_EQ(checksum_with_restart<2>(scene, size(MPI_COMM_WORLD), 1, 100, 200),
            checksum_after<2>(scene, 1, 200));
}

TEST(SameBits, RestartIn3D) {
  const Scene scene = scene_of(porous_3d_text());
  EXPECT_EQ(checksum_with_restart<3>(scene, size(MPI_COMM_WORLD), 1, 20, 40),
            checksum_after<3>(scene, 1, 40));
}

// Grains lie across slabs, meet at walls and at periodic sides, and are coloured anew many times.
TEST(SameBits, GrainsOnAllRanks) {
  expect_same_on_all_ranks<2>(scene_of(grains_text()), 120);
  expect_same_on_all_ranks<2>(scene_of(grains_text(), {"transfer.gradient=moments"}), 120);
  expect_same_on_all_ranks<2>(
      scene_of(grains_text(), {"transfer.velocity=flip", "transfer.shape=quadratic",
                               "boundary.low={kind='wall', friction=0.5}"}),
      80);
}

TEST(SameBits, GrainsWithRestartAndRebalance) {
  const Scene scene = scene_of(grains_text());
  const int all = size(MPI_COMM_WORLD);
  const std::uint64_t straight = checksum_after<2>(scene, 1, 120);
  EXPECT_EQ(checksum_after<2>(scene, all, 120, 7), straight);
  EXPECT_EQ(checksum_with_restart<2>(scene, all, 1, 80, 120), straight);
  EXPECT_EQ(checksum_with_restart<2>(scene, 1, all, 81, 120), straight);
  const Scene parted = scene_of(grains_text(), {"contact.normal=regression"});
  EXPECT_EQ(checksum_with_restart<2>(parted, all, 1, 50, 80), checksum_after<2>(parted, 1, 80));
}

// Voids collapse across slabs, and their walls face each other.
TEST(SameBits, SelfContactOnAllRanks) {
  const Scene scene = scene_of(porous_text(), {"contact.self=true", "contact.friction=0.3"});
  const int all = size(MPI_COMM_WORLD);
  const std::uint64_t straight = checksum_after<2>(scene, 1, 110);
  for (int ranks = 2; ranks <= all; ++ranks) {
    EXPECT_EQ(checksum_after<2>(scene, ranks, 110), straight) << ranks << " ranks";
  }
  EXPECT_EQ(checksum_after<2>(scene, all, 110, 7), straight);
  EXPECT_EQ(checksum_with_restart<2>(scene, all, 1, 80, 110), straight);
  EXPECT_EQ(checksum_with_restart<2>(scene, 1, all, 81, 110), straight);
}

TEST(SameBits, BallsIn3D) {
  const Scene scene =
      scene_of(porous_3d_text(),
               {"sample.kind=packed_grains", "sample.porosity=0.5", "sample.grain_radius=25e-6",
                "contact.friction=0.3", "contact.normal=regression"});
  expect_same_on_all_ranks<3>(scene, 40);
}

TEST(SameBits, LedgerAndHistoryRow) {
  // The exact sums behind a history row must not depend on the ranks either.
  const Scene scene = scene_of(porous_text());
  const auto row_on = [&](int ranks) {
    HistoryRow row;
    on_ranks(ranks, [&](MPI_Comm part) {
      Simulation<2> sim = start<2>(scene, part);
      advance_to(200, 0, sim);
      row = stock(sim);
    });
    return from_rank_zero(row);
  };
  const HistoryRow alone = row_on(1);
  const HistoryRow together = row_on(size(MPI_COMM_WORLD));
  EXPECT_EQ(history_line(alone, 2), history_line(together, 2));
}

}  // namespace
}  // namespace poreshock::test
