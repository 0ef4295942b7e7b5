// The kernels against plain loops over particles and nodes.
#include <gtest/gtest.h>

#include "poreshock/transfer/grid_to_particles.hpp"
#include "poreshock/transfer/node_lanes.hpp"
#include "poreshock/transfer/particles_to_grid.hpp"
#include "poreshock/transfer/sweep.hpp"
#include "support/scalar_limiter.hpp"
#include "support/scalar_transfer.hpp"
#include "transfer/cloud.hpp"
#include "transfer/motion.hpp"

namespace poreshock {
namespace {

using test::all_choices;
using test::Choice;
using test::Cloud;
using test::make_cloud;
using test::make_slab;
using test::random_motion;
using test::set_motion;
using test::Slab;
using test::world;

constexpr double tolerance = 1e-13;

/// Compares the complete rows of this rank with the reference, each lane to 1e-13 of its largest
/// value on the grid.
template <int Dim>
void expect_sums(const SlabGrid& grid, const std::vector<reference::NodeSums<Dim>>& nodes) {
  using Lane = SumLane<Dim>;
  const auto expected = [&](const reference::NodeSums<Dim>& node, int lane) {
    if (lane == Lane::mass) return node.mass;
    return lane < Lane::force ? node.momentum[lane - Lane::momentum]
                              : node.force[lane - Lane::force];
  };
  for (int lane = 0; lane < Lane::count; ++lane) {
    double largest = 0.0, error = 0.0;
    for (const auto& node : nodes) largest = std::max(largest, std::abs(expected(node, lane)));
    for (int row = grid.first_row(); row < grid.node_end(); ++row) {
      for (int i = 0; i < grid.shape().row_size; ++i) {
        const double value = expected(nodes[row * grid.shape().row_size + i], lane);
        error = std::max(error, std::abs(grid.row(row)[i][lane] - value));
      }
    }
    EXPECT_LE(error, tolerance * largest) << "lane " << lane;
  }
}

template <int Dim>
void compare_sums(const Choice& choice) {
  SCOPED_TRACE(name(choice) + ", " + std::to_string(Dim) + "-D");
  const Cloud<Dim> cloud = make_cloud<Dim>(choice);
  Slab<Dim> slab = make_slab(cloud, world);
  particles_to_grid(slab.particles, slab.cells, cloud.transfer, *slab.grid);
  slab.grid->exchange();
  expect_sums(*slab.grid,
              reference::particles_to_grid(cloud.shape, choice.velocity, cloud.particles));
}

TEST(ParticlesToGrid, GivesTheSumsOfTheTextbook) {
  for (const Choice& choice : all_choices) {
    compare_sums<2>(choice);
    compare_sums<3>(choice);
  }
}

/// Largest difference of two columns over all particles of this rank.
struct Worst {
  double error = 0.0, largest = 0.0;
  void add(double found, double expected) {
    error = std::max(error, std::abs(found - expected));
    largest = std::max(largest, std::abs(expected));
  }
};

/// One comparison per kind of result, since each has a scale of its own.
struct Comparison {
  Worst velocity, position, affine, quadratic, gradient, rate, heat;
};

template <int Dim>
void add_modes(const Slab<Dim>& slab, std::size_t local, double cell,
               const reference::Gathered<Dim>& expected, Comparison& worst) {
  const Particles<Dim>& particles = slab.particles;
  for (int a = 0; a < Dim; ++a) {
    worst.velocity.add(particles.velocity[a][local], expected.modes(a, 0));
    for (int k = 0; k < Dim && particles.options.affine; ++k) {
      worst.affine.add(particles.affine[a * Dim + k][local], expected.modes(a, 1 + k) / cell);
    }
    constexpr int second = second_modes<Dim>;
    for (int k = 0; k < second && particles.options.quadratic; ++k) {
      const int mode = 1 + Dim + k;
      worst.quadratic.add(particles.quadratic[a * second + k][local],
                          std::sqrt(expected.norm[mode]) * expected.modes(a, mode));
    }
  }
}

template <int Dim>
void add_particle(const Slab<Dim>& slab, std::size_t local,
                  const reference::Gathered<Dim>& expected, const Vector<Dim>& position,
                  Comparison& worst) {
  constexpr int plane[3][2] = {{0, 0}, {1, 1}, {0, 1}};
  constexpr int space[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
  for (int a = 0; a < Dim; ++a) {
    worst.position.add(slab.particles.position[a][local], position[a]);
    for (int k = 0; k < Dim; ++k) {
      worst.gradient.add(slab.step.gradient[a * Dim + k][local], expected.gradient(a, k));
    }
  }
  for (int c = 0; c < rate_size<Dim>; ++c) {
    const auto& index = Dim == 2 ? plane[c] : space[c];
    worst.rate.add(slab.step.rate[c][local], expected.middle_rate(index[0], index[1]));
  }
  worst.heat.add(slab.step.heat[local], expected.node_heat + expected.lost);
}

template <int Dim>
void compare_gather(const Choice& choice, double lost) {
  SCOPED_TRACE(name(choice) + ", " + std::to_string(Dim) + "-D, lost " + std::to_string(lost));
  const Cloud<Dim> cloud = make_cloud<Dim>(choice);
  Slab<Dim> slab = make_slab(cloud, world);
  const auto motion = random_motion<Dim>(cloud.shape, 5);
  set_motion(motion, *slab.grid);
  ParticleMotion<Dim> how;
  how.dt = 2e-9;
  how.lost = lost;
  how.grid_velocity[Dim - 1] = -300.0;
  how.inverse_energy_quantum = 0x1p60;
  prepare_gather<Dim>(lost, *slab.grid);
  slab.report += grid_to_particles<Dim>(*slab.grid, slab.cells, all_rows(*slab.grid),
                                        cloud.transfer, how, slab.particles, slab.step);
  store_like_particles(slab);
  Comparison worst;
  double heat = 0.0, largest_heat = 0.0;
  std::int64_t shortened = 0;
  for (std::size_t local = 0; local < slab.particles.size(); ++local) {
    const auto p = static_cast<std::size_t>(slab.particles.id[local]);
    const auto expected = reference::grid_to_particle<Dim>(cloud.shape, motion, cloud.particles, p,
                                                           choice.velocity, lost, how.dt);
    const Vector<Dim> position =
        reference::position(cloud.particles, p) + how.dt * (expected.transport - how.grid_velocity);
    add_modes(slab, local, cloud.shape.cell, expected, worst);
    add_particle(slab, local, expected, position, worst);
    heat += cloud.particles.mass[p] * expected.lost;
    largest_heat += cloud.particles.mass[p] * 1e6;
    shortened += expected.shortened_to < 0.9 ? 1 : 0;
  }
  for (const Worst& w : {worst.velocity, worst.position, worst.affine, worst.quadratic,
                         worst.gradient, worst.rate, worst.heat}) {
    EXPECT_LE(w.error, tolerance * w.largest);
  }
  EXPECT_NEAR(static_cast<double>(slab.report.heat) / how.inverse_energy_quantum, heat,
              tolerance * largest_heat);
  EXPECT_EQ(slab.report.shortened, shortened);
  EXPECT_EQ(slab.report.negative, 0);
}

TEST(GridToParticles, TakesWhatTheTextbookTakes) {
  for (const Choice& choice : all_choices) {
    const bool keeps = scheme_of(choice.velocity).keeps != Keeps::nothing;
    for (const double lost : {0.0, 0.1, 0.7, 1.0}) {
      if (!keeps && lost < 1.0) continue;
      compare_gather<2>(choice, lost);
      compare_gather<3>(choice, lost);
    }
  }
}

// The decay of the residual while sound crosses a cell makes the share that a step takes.
TEST(LostShare, FollowsFromTheTimeInWhichSoundCrossesACell) {
  Transfer transfer;
  transfer.velocity = VelocityTransfer::polyflip;
  transfer.damping = 0.25;
  EXPECT_DOUBLE_EQ(lost_share(transfer, 5000.0, 1e-5, 4e-9), 0.5 / 1.5);
  EXPECT_EQ(lost_share(transfer, 5000.0, 1e-5, 0.0), 0.0);
  transfer.damping = 0.0;
  EXPECT_EQ(lost_share(transfer, 5000.0, 1e-5, 4e-9), 0.0);
  for (const VelocityTransfer none :
       {VelocityTransfer::pic, VelocityTransfer::apic, VelocityTransfer::polypic}) {
    transfer.velocity = none;
    EXPECT_EQ(lost_share(transfer, 5000.0, 1e-5, 4e-9), 1.0);
  }
}

/// A wavy motion with some noise, in which many limiters lie between their bounds.
template <int Dim>
std::vector<reference::NodeMotion<Dim>> wavy_motion(const GridShape& shape) {
  auto motion = random_motion<Dim>(shape, 9);
  for (std::size_t i = 0; i < motion.size(); ++i) {
    int rest = static_cast<int>(i);
    for (int a = 0; a < Dim; rest /= shape.nodes[a], ++a) {
      motion[i].end[a] = 0.02 * motion[i].end[a] + 300.0 * std::sin(0.8 * (rest % shape.nodes[a]));
    }
  }
  return motion;
}

template <int Dim>
void compare_shares(VelocityTransfer velocity, bool periodic) {
  const Cloud<Dim> cloud = make_cloud<Dim>({ShapeFunction::cubic, velocity, periodic});
  Slab<Dim> slab = make_slab(cloud, world);
  const auto motion = wavy_motion<Dim>(cloud.shape);
  set_motion(motion, *slab.grid);
  ParticleMotion<Dim> how;
  how.limited = true;
  prepare_gather<Dim>(1.0, *slab.grid);
  slab.report += grid_to_particles<Dim>(*slab.grid, slab.cells, all_rows(*slab.grid),
                                        cloud.transfer, how, slab.particles, slab.step);
  store_like_particles(slab);
  int between = 0;
  for (std::size_t local = 0; local < slab.particles.size(); ++local) {
    const auto p = static_cast<std::size_t>(slab.particles.id[local]);
    Matrix<Dim> gradient;
    for (int k = 0; k < Dim * Dim; ++k) {
      gradient(k / Dim, k % Dim) = slab.step.gradient[static_cast<std::size_t>(k)][local];
    }
    const auto expected = reference::viscous_shares<Dim>(
        cloud.shape, motion, reference::position(cloud.particles, p), gradient);
    EXPECT_NEAR(slab.step.viscous_linear[local], expected.linear, 1e-11);
    EXPECT_NEAR(slab.step.viscous_quadratic[local], expected.quadratic, 1e-11);
    between += expected.linear > 0.0 && expected.linear < 1.0 ? 1 : 0;
  }
  MPI_Allreduce(MPI_IN_PLACE, &between, 1, MPI_INT, MPI_SUM, world);
  EXPECT_GT(between, 50);
}

TEST(ViscousShares, AreThoseOfTheTextbook) {
  for (const bool periodic : {false, true}) {
    compare_shares<2>(VelocityTransfer::polyflip, periodic);
    compare_shares<3>(VelocityTransfer::polyflip, periodic);
    compare_shares<2>(VelocityTransfer::flip, periodic);
    compare_shares<3>(VelocityTransfer::aflip, periodic);
  }
}

}  // namespace
}  // namespace poreshock
