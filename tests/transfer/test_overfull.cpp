// Particles whose nodes grains overfill are compressed, and their heat pays for it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "poreshock/transfer/grid_to_particles.hpp"
#include "support/scalar_transfer.hpp"
#include "transfer/cloud.hpp"
#include "transfer/motion.hpp"

namespace poreshock {
namespace {

using test::Choice;
using test::Cloud;
using test::make_cloud;
using test::make_slab;
using test::random_motion;
using test::set_motion;
using test::Slab;
using test::world;

constexpr double dt = 2e-9, tolerance = 1e-12, stiffness = 5000.0 * 5000.0;

double excess_of(int node) {
  reference::Random random{static_cast<std::uint64_t>(node)};
  return std::max(0.0, 0.2 * random.uniform() - 0.05);
}

/// In the complete rows of this rank.
void set_excess(SlabGrid& grid) {
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    for (int i = 0; i < grid.shape().row_size; ++i) {
      grid.row(row)[i][MotionLane<2>::overfill] = excess_of(row * grid.shape().row_size + i);
    }
  }
}

/// Sum of N excess by its definition.
double overfill_of(const Cloud<2>& cloud, int order, std::size_t p) {
  const auto s =
      reference::surroundings<2>(cloud.shape, order, reference::position(cloud.particles, p));
  double sum = 0.0;
  for (std::size_t i = 0; i < s.node.size(); ++i) sum += s.weight[i] * excess_of(s.node[i]);
  return sum;
}

/// How many particles had enough heat, and how many had not.
struct Payers {
  int rich = 0, poor = 0;
};

void compare(const Choice& choice, double squeezed, Payers& payers) {
  SCOPED_TRACE(name(choice));
  const Cloud<2> cloud = make_cloud<2>(choice);
  Slab<2> slab = make_slab(cloud, world);
  const auto motion = random_motion<2>(cloud.shape, 5);
  set_motion(motion, *slab.grid);
  ParticleMotion<2> how;
  how.dt = dt;
  how.squeezed = squeezed;
  how.stiffness = stiffness;
  how.inverse_energy_quantum = 0x1p60;
  set_excess(*slab.grid);
  prepare_gather<2>(how.lost, *slab.grid);
  slab.report += grid_to_particles<2>(*slab.grid, slab.cells, all_rows(*slab.grid), cloud.transfer,
                                      how, slab.particles, slab.step);
  store_like_particles(slab);
  double squeezing = 0.0, largest = 0.0;
  for (std::size_t local = 0; local < slab.particles.size(); ++local) {
    const auto p = static_cast<std::size_t>(slab.particles.id[local]);
    const auto expected = reference::grid_to_particle<2>(cloud.shape, motion, cloud.particles, p,
                                                         choice.velocity, how.lost, dt);
    const double heat = expected.node_heat + expected.lost;
    EXPECT_NEAR(slab.step.heat[local], heat, tolerance * 1e6);
    const double start = cloud.particles.pressure[p] / cloud.particles.density[p];
    const int order = reference::kind_of(choice.velocity).order;
    const double wanted = squeezed * overfill_of(cloud, order, p);
    // (p/rho + c^2 s/2) s = heat
    const double root = std::sqrt(start * start + 2.0 * stiffness * heat);
    const double strain = start > 0.0 ? std::min(wanted, (root - start) / stiffness) : 0.0;
    for (int a = 0; a < 2; ++a) {
      EXPECT_NEAR(slab.step.gradient[3 * a][local], expected.gradient(a, a) - strain / (2.0 * dt),
                  tolerance / dt);
      EXPECT_NEAR(slab.step.rate[a][local], expected.middle_rate(a, a), tolerance / dt);
    }
    squeezing += cloud.particles.mass[p] * (start + 0.5 * stiffness * strain) * strain;
    largest += cloud.particles.mass[p] * heat;
    if (strain > 0.0) ++(strain < wanted ? payers.poor : payers.rich);
  }
  EXPECT_NEAR(static_cast<double>(slab.report.squeezing) / how.inverse_energy_quantum, squeezing,
              tolerance * largest);
}

TEST(OverfullNodes, CompressParticlesAsFarAsTheirHeatPays) {
  Payers payers;
  for (const ShapeFunction shape : {ShapeFunction::quadratic, ShapeFunction::cubic}) {
    for (const double squeezed : {0.02, 5.0}) {
      compare({shape, VelocityTransfer::apic, false}, squeezed, payers);
      compare({shape, VelocityTransfer::apic, true}, squeezed, payers);
    }
  }
  int counts[2] = {payers.rich, payers.poor};
  MPI_Allreduce(MPI_IN_PLACE, counts, 2, MPI_INT, MPI_SUM, world);
  EXPECT_GT(counts[0], 100);
  EXPECT_GT(counts[1], 100);
}

// What a step takes of the excess follows from the time in which sound crosses a cell.
TEST(SqueezedShare, FollowsFromTheTimeInWhichSoundCrossesACell) {
  EXPECT_DOUBLE_EQ(squeezed_share(5000.0, 1e-5, 2e-9), 0.5 / 1.5);
  EXPECT_EQ(squeezed_share(5000.0, 1e-5, 0.0), 0.0);
}

}  // namespace
}  // namespace poreshock
