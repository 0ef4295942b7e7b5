// The kernels against plain loops over particles and nodes.
#include <gtest/gtest.h>

#include "poreshock/transfer/average.hpp"
#include "poreshock/transfer/grid_to_particles.hpp"
#include "poreshock/transfer/node_lanes.hpp"
#include "poreshock/transfer/particles_to_grid.hpp"
#include "poreshock/transfer/sweep.hpp"
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
    if (lane == Lane::kinetic) return node.kinetic;
    return lane < Lane::force ? node.momentum[lane - Lane::momentum]
                              : node.force[lane - Lane::force];
  };
  for (int lane = 0; lane <= Lane::kinetic; ++lane) {
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
void compare_sums(const Choice& choice, double averaging) {
  SCOPED_TRACE(name(choice) + ", " + std::to_string(Dim) + "-D");
  Cloud<Dim> cloud = make_cloud<Dim>(choice);
  cloud.transfer.averaging = averaging;
  Slab<Dim> slab = make_slab(cloud, world);
  std::vector<double> pressure = cloud.particles.pressure;
  for (std::size_t p = 0; p < pressure.size(); ++p) {
    pressure[p] += cloud.particles.viscous_pressure[p];
  }
  if (averaging > 0.0) {
    average_pressure(slab.particles, slab.cells, cloud.transfer, *slab.averages);
    const auto mean = reference::average(cloud.shape, cloud.particles, pressure);
    for (std::size_t p = 0; p < pressure.size(); ++p) {
      pressure[p] = (1.0 - averaging) * pressure[p] + averaging * mean[p];
    }
  }
  particles_to_grid(slab.particles, slab.cells, cloud.transfer,
                    averaging > 0.0 ? slab.averages.get() : nullptr, *slab.grid);
  slab.grid->exchange();
  expect_sums(*slab.grid, reference::particles_to_grid(cloud.shape, cloud.particles, pressure,
                                                       projects(choice.velocity)));
}

TEST(ParticlesToGrid, GivesTheSumsOfTheTextbook) {
  for (const Choice& choice : all_choices) {
    compare_sums<2>(choice, 0.0);
    compare_sums<3>(choice, 0.0);
  }
}

TEST(ParticlesToGrid, TakesTheAveragedPressureWithAveraging) {
  compare_sums<2>(all_choices[3], 1.0);
  compare_sums<3>(all_choices[1], 0.5);
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
  Worst velocity, position, affine, gradient, rate, heat;
};

template <int Dim>
void add_particle(const Slab<Dim>& slab, std::size_t local,
                  const reference::Gathered<Dim>& expected, const Vector<Dim>& position,
                  Comparison& worst) {
  constexpr int plane[3][2] = {{0, 0}, {1, 1}, {0, 1}};
  constexpr int space[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
  for (int a = 0; a < Dim; ++a) {
    worst.velocity.add(slab.particles.velocity[a][local], expected.velocity[a]);
    worst.position.add(slab.particles.position[a][local], position[a]);
    for (int k = 0; k < Dim; ++k) {
      worst.gradient.add(slab.step.gradient[a * Dim + k][local], expected.gradient(a, k));
      if (slab.particles.options.affine) {
        worst.affine.add(slab.particles.affine[a * Dim + k][local], expected.affine(a, k));
      }
    }
  }
  for (int c = 0; c < rate_size<Dim>; ++c) {
    const auto& index = Dim == 2 ? plane[c] : space[c];
    worst.rate.add(slab.step.rate[c][local], expected.middle_rate(index[0], index[1]));
  }
  worst.heat.add(slab.step.heat[local], expected.node_heat + expected.lost);
}

template <int Dim>
void compare_gather(const Choice& choice, double damping) {
  SCOPED_TRACE(name(choice) + ", " + std::to_string(Dim) + "-D");
  constexpr double dt = 2e-9;
  Cloud<Dim> cloud = make_cloud<Dim>(choice);
  cloud.transfer.damping = damping;
  Slab<Dim> slab = make_slab(cloud, world);
  const auto motion = random_motion<Dim>(cloud.shape, 5);
  set_motion(motion, *slab.grid);
  const double damped = damping * dt / (1.0 + damping * dt);
  EXPECT_EQ(damped_share(cloud.transfer, dt), damped);
  Vector<Dim> grid_velocity = Vector<Dim>::Zero();
  grid_velocity[Dim - 1] = -300.0;
  prepare_gather<Dim>(cloud.transfer, damped, *slab.grid);
  grid_to_particles<Dim>(*slab.grid, nullptr, slab.cells, all_rows(*slab.grid), cloud.transfer,
                         grid_velocity, dt, 1.0, slab.particles, slab.step, slab.filter_heat);
  store_like_particles(slab);
  Comparison worst;
  for (std::size_t local = 0; local < slab.particles.size(); ++local) {
    const auto p = static_cast<std::size_t>(slab.particles.id[local]);
    const auto expected = reference::grid_to_particle<Dim>(cloud.shape, motion, cloud.particles, p,
                                                           choice.velocity, damped);
    const Vector<Dim> position =
        reference::position(cloud.particles, p) + dt * (expected.transport - grid_velocity);
    add_particle(slab, local, expected, position, worst);
  }
  for (const Worst& w :
       {worst.velocity, worst.position, worst.affine, worst.gradient, worst.rate, worst.heat}) {
    EXPECT_LE(w.error, tolerance * w.largest);
  }
}

TEST(GridToParticles, TakesWhatTheTextbookTakes) {
  for (const Choice& choice : all_choices) {
    compare_gather<2>(choice, 0.0);
    compare_gather<3>(choice, 0.0);
  }
}

TEST(GridToParticles, DampsTheNoiseOfFlip) {
  for (const Choice& choice : all_choices) {
    if (choice.velocity != VelocityTransfer::flip) continue;
    compare_gather<2>(choice, 5e7);
    compare_gather<3>(choice, 5e8);
  }
}

}  // namespace
}  // namespace poreshock
