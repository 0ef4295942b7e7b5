// What a transfer to the nodes and back must keep: mass, momentum, energy with its heat; and
// what it must not see: the frame.
#include <gtest/gtest.h>

#include <algorithm>

#include "transfer/cycle.hpp"

namespace poreshock {
namespace {

using test::all_choices;
using test::all_particles;
using test::angular_momentum;
using test::by_id;
using test::Choice;
using test::Cloud;
using test::kinetic_energy;
using test::make_cloud;
using test::make_slab;
using test::momentum;
using test::no_kick;
using test::random_kick;
using test::Slab;
using test::total;
using test::transfer_cycle;
using test::world;

template <int Dim>
void expect_nodes_hold_mass_and_momentum(const Choice& choice) {
  SCOPED_TRACE(name(choice) + ", " + std::to_string(Dim) + "-D");
  using Lane = SumLane<Dim>;
  const Cloud<Dim> cloud = make_cloud<Dim>(choice);
  Slab<Dim> slab = make_slab(cloud, world);
  particles_to_grid(slab.particles, slab.cells, cloud.transfer, *slab.grid);
  slab.grid->exchange();
  // Longer than the numbers under test, so that only their own rounding counts.
  std::array<long double, lane_count> sums{}, sizes{};
  for (int row = slab.grid->first_row(); row < slab.grid->last_row(); ++row) {
    for (int i = 0; i < cloud.shape.row_size; ++i) {
      const Lanes& node = slab.grid->row(row)[i];
      for (int lane = 0; lane < lane_count; ++lane) {
        sums[lane] += node[lane];
        sizes[lane] += std::abs(node[lane]);
      }
    }
  }
  MPI_Allreduce(MPI_IN_PLACE, sums.data(), lane_count, MPI_LONG_DOUBLE, MPI_SUM, world);
  MPI_Allreduce(MPI_IN_PLACE, sizes.data(), lane_count, MPI_LONG_DOUBLE, MPI_SUM, world);
  const auto expect_sum = [&](int lane, double expected) {
    const double rounding = 1e-15 * static_cast<double>(sizes[lane]);
    EXPECT_NEAR(static_cast<double>(sums[lane]), expected, rounding) << "lane " << lane;
  };
  const std::vector<double> ones(cloud.particles.size(), 1.0);
  expect_sum(Lane::mass, total(cloud.particles.mass, ones));
  const Vector<Dim> expected = momentum(cloud.particles);
  for (int a = 0; a < Dim; ++a) {
    expect_sum(Lane::momentum + a, expected[a]);
    expect_sum(Lane::force + a, 0.0);  // internal forces are in balance
  }
}

TEST(Conservation, NodesHoldAllMassAndMomentum) {
  for (const Choice& choice : all_choices) {
    expect_nodes_hold_mass_and_momentum<2>(choice);
    expect_nodes_hold_mass_and_momentum<3>(choice);
  }
}

/// Sum of m |v|, kg m/s.
template <int Dim>
double momentum_size(const Particles<Dim>& particles) {
  double size = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    size += particles.mass[p] * reference::velocity(particles, p).norm();
  }
  return size;
}

/// Kinetic energy plus heat changes by the work of the kicks and nothing else, momentum by their
/// impulse, and no particle has negative heat. Returns the number of shortened particles.
template <int Dim, class Kick>
std::int64_t expect_energy_closes(const Choice& choice, double damping, Kick&& kick) {
  SCOPED_TRACE(name(choice) + ", " + std::to_string(Dim) + "-D, damping " +
               std::to_string(damping));
  Cloud<Dim> cloud = make_cloud<Dim>(choice);
  cloud.transfer.damping = damping;
  Slab<Dim> slab = make_slab(cloud, world);
  const double before = kinetic_energy(cloud.shape, cloud.particles);
  const double quantum = power_of_two_below(std::ldexp(before, -60));
  auto motion = test::cycle_motion<Dim>(cloud.transfer, test::time_step);
  motion.inverse_energy_quantum = 1.0 / quantum;
  const auto gain = transfer_cycle(cloud, motion, kick, world, slab);
  const Particles<Dim> particles = all_particles(cloud, slab, world);
  const std::vector<double> heats = by_id(slab.particles, slab.step.heat, particles.size(), world);
  const double after = kinetic_energy(cloud.shape, particles);
  const double heat = total(particles.mass, heats);
  const double size = std::max(before, after);
  EXPECT_NEAR(after + heat - gain.work, before, 1e-14 * size);
  std::vector<Int128> booked = {slab.report.heat, slab.report.negative, slab.report.shortened};
  sum(booked, world);
  EXPECT_NEAR(static_cast<double>(booked[0]) * quantum, heat, 1e-14 * size);
  EXPECT_TRUE(booked[1] == 0);
  const double speed2 = size / total(particles.mass, std::vector<double>(particles.size(), 1.0));
  EXPECT_GE(*std::min_element(heats.begin(), heats.end()), -1e-13 * speed2);
  EXPECT_GT(*std::max_element(heats.begin(), heats.end()), -1e-13 * speed2);
  const Vector<Dim> change = momentum(particles) - momentum(cloud.particles) - gain.impulse;
  EXPECT_LE(change.norm(), 1e-15 * (momentum_size(particles) + momentum_size(cloud.particles)));
  return static_cast<std::int64_t>(booked[2]);
}

bool keeps_something(const Choice& choice) {
  return scheme_of(choice.velocity).keeps != Keeps::nothing;
}

TEST(Conservation, EnergyAndMomentumStayWithoutForces) {
  for (const Choice& choice : all_choices) {
    for (const double damping : {0.0, 0.3}) {
      if (damping > 0.0 && !keeps_something(choice)) continue;
      expect_energy_closes<2>(choice, damping, no_kick<2>);
      expect_energy_closes<3>(choice, damping, no_kick<3>);
    }
  }
}

TEST(Conservation, EnergyAndMomentumGrowByTheForces) {
  for (const Choice& choice : all_choices) {
    for (const double damping : {0.0, 0.3}) {
      if (damping > 0.0 && !keeps_something(choice)) continue;
      expect_energy_closes<2>(choice, damping, random_kick<2>);
      expect_energy_closes<3>(choice, damping, random_kick<3>);
    }
  }
}

/// Kicks of up to `strength` (m/s) that follow from the node and a seed.
template <int Dim>
auto strong_kick(std::uint64_t seed, double strength) {
  return [=](int node) {
    reference::Random random{seed * 100003 + static_cast<std::uint64_t>(node)};
    Vector<Dim> kick;
    for (int a = 0; a < Dim; ++a) kick[a] = strength * (2.0 * random.uniform() - 1.0);
    return kick;
  };
}

// However the nodes are kicked and however little is damped. Without shortening the velocity, which
// keeps its residual beside modes that do not, would gain energy on some particles.
TEST(Conservation, NoParticleHasNegativeHeatUnderStrongKicks) {
  for (const Choice& choice : all_choices) {
    std::int64_t shortened = 0;
    for (const std::uint64_t seed : {1, 2, 3}) {
      for (const double damping : {0.0, 0.02, 1.0, 10.0}) {
        if (damping > 0.0 && !keeps_something(choice)) continue;
        const double strength = seed == 1 ? 300.0 : 3000.0;
        shortened += expect_energy_closes<2>(choice, damping, strong_kick<2>(seed, strength));
        if (seed == 1) {
          shortened += expect_energy_closes<3>(choice, damping, strong_kick<3>(seed, strength));
        }
      }
    }
    const TransferScheme& scheme = scheme_of(choice.velocity);
    const bool shortens = scheme.modes != Modes::constant && scheme.keeps == Keeps::velocity;
    EXPECT_EQ(shortened > 0, shortens) << name(choice);
  }
}

TEST(Conservation, FlipWithoutForcesAndDampingChangesNoBitOfTheVelocity) {
  Cloud<2> cloud = make_cloud<2>({ShapeFunction::cubic, VelocityTransfer::flip, true});
  cloud.transfer.damping = 0.0;
  Slab<2> slab = make_slab(cloud, world);
  const auto before = slab.particles.velocity;
  transfer_cycle(cloud, no_kick<2>, world, slab);
  EXPECT_EQ(slab.particles.velocity, before);
  EXPECT_EQ(slab.step.heat, std::vector<double>(slab.particles.size(), 0.0));
}

template <int Dim>
void expect_heat_does_not_see_the_frame(const Choice& choice, double damping) {
  SCOPED_TRACE(name(choice) + ", " + std::to_string(Dim) + "-D");
  Cloud<Dim> cloud = make_cloud<Dim>(choice);
  cloud.transfer.damping = damping;
  Slab<Dim> resting = make_slab(cloud, world);
  for (double& v : cloud.particles.velocity[0]) v += 700.0;
  for (double& v : cloud.particles.velocity[Dim - 1]) v -= 1100.0;
  Slab<Dim> moving = make_slab(cloud, world);
  transfer_cycle(cloud, random_kick<Dim>, world, resting);
  transfer_cycle(cloud, random_kick<Dim>, world, moving);
  const double rounding = 1e-14 * (700.0 * 700.0 + 1100.0 * 1100.0);
  for (std::size_t p = 0; p < resting.step.heat.size(); ++p) {
    EXPECT_NEAR(moving.step.heat[p], resting.step.heat[p], rounding);
  }
  const double speed = 1e-14 * 2000.0;
  const auto expect_same = [](const auto& found, const auto& expected, double tolerance) {
    for (std::size_t k = 0; k < found.size(); ++k) {
      for (std::size_t p = 0; p < found[k].size(); ++p) {
        EXPECT_NEAR(found[k][p], expected[k][p], tolerance);
      }
    }
  };
  expect_same(moving.particles.affine, resting.particles.affine, 10.0 * speed / cloud.shape.cell);
  expect_same(moving.particles.quadratic, resting.particles.quadratic, 10.0 * speed);
}

TEST(Conservation, HeatAndModesDoNotSeeTheFrame) {
  for (const Choice& choice : all_choices) {
    for (const double damping : {0.0, 0.4}) {
      expect_heat_does_not_see_the_frame<2>(choice, damping);
      expect_heat_does_not_see_the_frame<3>(choice, damping);
    }
  }
}

}  // namespace
}  // namespace poreshock
