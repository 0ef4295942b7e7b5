// Which share of the artificial viscosity acts on particles among nodes in given motion.
#include <gtest/gtest.h>

#include "transfer/cycle.hpp"
#include "transfer/jump_limiter.hpp"

namespace poreshock {
namespace {

using test::Cloud;
using test::make_cloud;
using test::make_slab;
using test::Slab;
using test::world;

/// Sets the end velocities of all nodes, velocity(x), and gathers. x in cells.
template <int Dim, class Velocity>
Slab<Dim> gathered(const Cloud<Dim>& cloud, Velocity&& velocity) {
  using Lane = MotionLane<Dim>;
  Slab<Dim> slab = make_slab(cloud, world);
  for (int row = slab.grid->first_row(); row < slab.grid->node_end(); ++row) {
    for (int i = 0; i < cloud.shape.row_size; ++i) {
      Vector<Dim> x;
      x[0] = i % cloud.shape.nodes[0] - 1;
      if constexpr (Dim == 3) x[1] = i / cloud.shape.nodes[0] - 1;
      x[Dim - 1] = row - 1;
      const Vector<Dim> v = velocity(x);
      Lanes& node = slab.grid->row(row)[i];
      node = Lanes{};
      for (int a = 0; a < Dim; ++a) node[Lane::end_velocity + a] = v[a];
    }
  }
  ParticleMotion<Dim> motion;
  motion.limited = true;
  prepare_gather<Dim>(1.0, *slab.grid);
  slab.report += grid_to_particles<Dim>(*slab.grid, slab.cells, all_rows(*slab.grid),
                                        cloud.transfer, motion, slab.particles, slab.step);
  store_like_particles(slab);
  return slab;
}

template <int Dim>
Cloud<Dim> open_cloud() {
  return make_cloud<Dim>({ShapeFunction::cubic, VelocityTransfer::polyflip, false});
}

template <int Dim>
void expect_no_viscosity(const Matrix<Dim>& slope, const Vector<Dim>& frame) {
  const Slab<Dim> slab = gathered(
      open_cloud<Dim>(), [&](const Vector<Dim>& x) { return Vector<Dim>(frame + slope * x); });
  for (std::size_t p = 0; p < slab.particles.size(); ++p) {
    // Ratios of equal jumps are 1 - 9e-12, by the floor under the middle one.
    EXPECT_NEAR(slab.step.viscous_linear[p], 0.0, 1e-11);
    EXPECT_NEAR(slab.step.viscous_quadratic[p], 0.0, 4e-11);
  }
}

TEST(JumpLimiter, UniformStretchAndRotationMeetNoViscosity) {
  Matrix<2> plane = Matrix<2>::Zero();
  plane(0, 0) = -70.0;
  plane(1, 1) = -30.0;
  expect_no_viscosity<2>(plane, {100.0, -200.0});
  plane << -20.0, -90.0, 110.0, -50.0;
  expect_no_viscosity<2>(plane, {0.0, 0.0});
  Matrix<3> space;
  space << -20.0, -90.0, 15.0, 110.0, -50.0, 40.0, -10.0, 60.0, -30.0;
  expect_no_viscosity<3>(space, {10.0, -20.0, 30.0});
  // Small whole numbers turn without rounding: a rotation closes along no axis.
  plane << 0.0, -8.0, 8.0, 0.0;
  const Slab<2> turning =
      gathered(open_cloud<2>(), [&](const Vector<2>& x) { return Vector<2>(plane * x); });
  for (std::size_t p = 0; p < turning.particles.size(); ++p) {
    EXPECT_NEAR(turning.step.viscous_linear[p] * turning.step.gradient[0][p], 0.0, 1e-15 * 8e5);
  }
}

/// Cell of a coordinate.
int cell_of(double x, double cell) {
  return static_cast<int>(std::floor(x * (1.0 / cell)));
}

// Along the shock axis the nodes at 7 and above approach those below: full viscosity between.
template <int Dim>
void expect_single_jump(const Vector<Dim>& frame) {
  const Cloud<Dim> cloud = open_cloud<Dim>();
  const Slab<Dim> slab = gathered(cloud, [&](const Vector<Dim>& x) {
    Vector<Dim> v = frame;
    if (x[Dim - 1] > 2.5) v[Dim - 1] -= 300.0;
    return v;
  });
  int inside = 0, beside = 0;
  for (std::size_t p = 0; p < slab.particles.size(); ++p) {
    const auto id = static_cast<std::size_t>(slab.particles.id[p]);
    const int at = cell_of(cloud.particles.position[Dim - 1][id], cloud.shape.cell);
    if (at == 2) {
      EXPECT_NEAR(slab.step.viscous_linear[p], 1.0, 1e-11);
      EXPECT_NEAR(slab.step.viscous_quadratic[p], 1.0, 1e-11);
      ++inside;
    }
    if ((at == 1 || at == 3) && frame.norm() == 0.0) {
      // The jump lies in the cell beside, but the particle sees a part of it.
      EXPECT_NEAR(slab.step.viscous_linear[p], 1.0, 1e-11);
      EXPECT_NEAR(slab.step.viscous_quadratic[p], 1.0, 1e-11);
      ++beside;
    }
  }
  std::vector<int> seen = {inside, beside};
  MPI_Allreduce(MPI_IN_PLACE, seen.data(), 2, MPI_INT, MPI_SUM, world);
  EXPECT_GT(seen[0], 10);
  EXPECT_TRUE(seen[1] > 10 || frame.norm() > 0.0);
}

TEST(JumpLimiter, JumpThatIsAloneMeetsAllViscosity) {
  expect_single_jump<2>({0.0, 0.0});
  expect_single_jump<3>({0.0, 0.0, 0.0});
  expect_single_jump<2>({900.0, -1500.0});
  expect_single_jump<3>({900.0, 100.0, -1500.0});
}

// Jumps alone along x with a closing rate a that particles see, uniform along y with the rate b:
// a/(a + b) acts.
TEST(JumpLimiter, AxesCountAsFastAsTheyClose) {
  const Cloud<2> cloud = open_cloud<2>();
  const Slab<2> slab = gathered(
      cloud, [](const Vector<2>& x) { return Vector<2>(x[0] > 2.5 ? -300.0 : 0.0, -50.0 * x[1]); });
  int seen = 0;
  for (std::size_t p = 0; p < slab.particles.size(); ++p) {
    const auto id = static_cast<std::size_t>(slab.particles.id[p]);
    if (cell_of(cloud.particles.position[0][id], cloud.shape.cell) != 2) continue;
    const double f = cloud.particles.position[0][id] / cloud.shape.cell - 2.0;
    // Slope of a step that is smoothed by cubic splines: the integral spline at the particle.
    const double a = 300.0 * (0.75 - (f - 0.5) * (f - 0.5));
    EXPECT_NEAR(slab.step.viscous_linear[p], a / (a + 50.0), 1e-11);
    EXPECT_NEAR(slab.step.viscous_quadratic[p], a / (a + 50.0), 4e-11);
    ++seen;
  }
  MPI_Allreduce(MPI_IN_PLACE, &seen, 1, MPI_INT, MPI_SUM, world);
  EXPECT_GT(seen, 10);
}

template <int Dim>
void expect_same_in_any_frame() {
  const auto velocity = [](const Vector<Dim>& x) {
    Vector<Dim> v;
    for (int a = 0; a < Dim; ++a) v[a] = 300.0 * std::sin(1.3 * x[a] + 0.7 * x[(a + 1) % Dim] + a);
    return v;
  };
  const Slab<Dim> resting = gathered(open_cloud<Dim>(), velocity);
  const Slab<Dim> moving = gathered(open_cloud<Dim>(), [&](const Vector<Dim>& x) {
    return Vector<Dim>(velocity(x) + Vector<Dim>::Constant(-1000.0));
  });
  int between = 0;
  for (std::size_t p = 0; p < resting.particles.size(); ++p) {
    const double linear = resting.step.viscous_linear[p];
    EXPECT_NEAR(moving.step.viscous_linear[p], linear, 1e-10);
    EXPECT_NEAR(moving.step.viscous_quadratic[p], resting.step.viscous_quadratic[p], 1e-10);
    between += linear > 0.0 && linear < 1.0 ? 1 : 0;
  }
  MPI_Allreduce(MPI_IN_PLACE, &between, 1, MPI_INT, MPI_SUM, world);
  EXPECT_GT(between, 10);
}

TEST(JumpLimiter, DoesNotSeeTheFrame) {
  expect_same_in_any_frame<2>();
  expect_same_in_any_frame<3>();
}

TEST(JumpLimiter, FormulaAtWholeRatios) {
  const auto expect = [](double before, double own, double after, double linear, double quadratic) {
    const JumpLimiters found = jump_limiters(before, own, after);
    EXPECT_NEAR(found.linear, linear, 1e-10) << before << ' ' << own << ' ' << after;
    EXPECT_NEAR(found.quadratic, quadratic, 1e-10) << before << ' ' << own << ' ' << after;
  };
  expect(-2.0, -2.0, -2.0, 1.0, 1.0);
  expect(-1.0, -2.0, -3.0, 1.0, 0.0625);        // mean 1, least 1/2
  expect(-1.0, -4.0, -7.0, 0.75, 0.00390625);   // three times the least, 1/4
  expect(-1.0, -4.0, -2.0, 0.375, 0.00390625);  // mean of 1/4 and 1/2
  expect(0.0, -4.0, -4.0, 0.0, 0.0);            // a front behind which all is still
  expect(1.0, -4.0, -4.0, 0.0, 0.0);
  expect(0.0, -4.0, 0.0, 0.0, 0.0);
  expect(-8.0, -4.0, -8.0, 1.0, 1.0);
  expect(3.0, 0.0, 3.0, 0.0, 0.0);  // a jump that vanishes between others
  expect(0.0, 0.0, 0.0, 1.0, 1.0);  // nothing moves: nothing acts
}

// The mirror image turns the order of the jumps and keeps their sign; not a bit may change.
TEST(JumpLimiter, MirrorImagesHaveTheSameBits) {
  reference::Random random{3};
  for (int k = 0; k < 10000; ++k) {
    const double a = random.uniform() - 0.5, b = random.uniform() - 0.5, c = random.uniform() - 0.5;
    const JumpLimiters one = jump_limiters(a, b, c), image = jump_limiters(c, b, a);
    EXPECT_EQ(one.linear, image.linear);
    EXPECT_EQ(one.quadratic, image.quadratic);
    const JumpLimiters turned = jump_limiters(-a, -b, -c);
    EXPECT_EQ(one.linear, turned.linear);
    EXPECT_EQ(one.quadratic, turned.quadratic);
  }
}

}  // namespace
}  // namespace poreshock
