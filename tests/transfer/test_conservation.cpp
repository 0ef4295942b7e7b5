// What a transfer to the nodes and back must keep: mass, momentum, energy with its heats, rigid
// motion; and what it must not see: the frame.
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
using test::NodeGain;
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
  particles_to_grid(slab.particles, slab.cells, cloud.transfer, nullptr, *slab.grid);
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

/// Kinetic energy plus all heats changes by the work of the kicks and nothing else; momentum by
/// nothing when there are none.
template <int Dim, class Kick>
void expect_energy_closes(const Choice& choice, double damping, bool kicked, Kick&& kick) {
  SCOPED_TRACE(name(choice) + ", " + std::to_string(Dim) + "-D, damping " +
               std::to_string(damping));
  Cloud<Dim> cloud = make_cloud<Dim>(choice);
  cloud.transfer.damping = damping;
  Slab<Dim> slab = make_slab(cloud, world);
  const double before = kinetic_energy(cloud.shape, cloud.particles);
  const double quantum = power_of_two_below(std::ldexp(before, -60));
  const NodeGain gain = transfer_cycle(cloud, 1.0 / quantum, kick, world, slab);
  const Particles<Dim> particles = all_particles(cloud, slab, world);
  const std::vector<double> heats = by_id(slab.particles, slab.step.heat, particles.size(), world);
  const double after = kinetic_energy(cloud.shape, particles);
  const double heat = total(particles.mass, heats);
  EXPECT_NEAR(after + heat - gain.work, before, 1e-14 * before);
  std::vector<Int128> booked = {slab.filter_heat};
  sum(booked, world);
  EXPECT_NEAR(static_cast<double>(booked[0]) * quantum, heat - gain.heat, 1e-14 * before);
  if (damping == 0.0 || !kicked) {
    EXPECT_GE(*std::min_element(heats.begin(), heats.end()), 0.0);
  }
  if (!kicked) {
    const Vector<Dim> change = momentum(particles) - momentum(cloud.particles);
    double size = 0.0;
    for (std::size_t p = 0; p < particles.size(); ++p) {
      size += particles.mass[p] * reference::velocity(particles, p).norm();
    }
    EXPECT_LE(change.norm(), 1e-15 * size);
  }
}

TEST(Conservation, EnergyClosesWithoutForces) {
  for (const Choice& choice : all_choices) {
    const bool flip = choice.velocity == VelocityTransfer::flip;
    expect_energy_closes<2>(choice, flip ? 1e8 : 0.0, false, no_kick<2>);
    expect_energy_closes<3>(choice, flip ? 1e8 : 0.0, false, no_kick<3>);
  }
}

TEST(Conservation, EnergyGrowsByTheWorkOfTheForces) {
  for (const Choice& choice : all_choices) {
    expect_energy_closes<2>(choice, 0.0, true, random_kick<2>);
    expect_energy_closes<3>(choice, 0.0, true, random_kick<3>);
    if (choice.velocity != VelocityTransfer::flip) continue;
    expect_energy_closes<2>(choice, 3e8, true, random_kick<2>);
    expect_energy_closes<3>(choice, 3e8, true, random_kick<3>);
  }
}

TEST(Conservation, FlipWithoutForcesAndDampingChangesNoBitOfTheVelocity) {
  const Cloud<2> cloud = make_cloud<2>({ShapeFunction::cubic, VelocityTransfer::flip, true});
  Slab<2> slab = make_slab(cloud, world);
  const auto before = slab.particles.velocity;
  transfer_cycle(cloud, 1.0, no_kick<2>, world, slab);
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
  transfer_cycle(cloud, 1.0, random_kick<Dim>, world, resting);
  transfer_cycle(cloud, 1.0, random_kick<Dim>, world, moving);
  const double rounding = 1e-14 * (700.0 * 700.0 + 1100.0 * 1100.0);
  for (std::size_t p = 0; p < resting.step.heat.size(); ++p) {
    EXPECT_NEAR(moving.step.heat[p], resting.step.heat[p], rounding);
  }
}

TEST(Conservation, HeatDoesNotSeeTheFrame) {
  for (const Choice& choice : all_choices) {
    expect_heat_does_not_see_the_frame<2>(choice, 2e8);
    expect_heat_does_not_see_the_frame<3>(choice, 2e8);
  }
}

/// A cloud that moves as one field v = v0 + A x.
template <int Dim>
void set_linear_velocity(const Vector<Dim>& v0, const Matrix<Dim>& slope, Cloud<Dim>& cloud) {
  for (std::size_t p = 0; p < cloud.particles.size(); ++p) {
    const Vector<Dim> v = v0 + slope * reference::position(cloud.particles, p);
    for (int a = 0; a < Dim; ++a) cloud.particles.velocity[a][p] = v[a];
    for (int k = 0; k < Dim * Dim && cloud.particles.options.affine; ++k) {
      cloud.particles.affine[k][p] = slope(k / Dim, k % Dim);
    }
  }
}

/// Largest deviations of a slab from the field v = v0 + A x0: velocity, gradients, heat.
struct Deviation {
  double velocity = 0.0, gradient = 0.0, affine = 0.0, heat = 0.0;
};

template <int Dim>
Deviation deviation(const Cloud<Dim>& cloud, const Matrix<Dim>& slope, const Slab<Dim>& slab) {
  Deviation worst;
  const auto grow = [](double& largest, double value) {
    largest = std::max(largest, std::abs(value));
  };
  for (std::size_t p = 0; p < slab.particles.size(); ++p) {
    const auto id = static_cast<std::size_t>(slab.particles.id[p]);
    for (int a = 0; a < Dim; ++a) {
      grow(worst.velocity, slab.particles.velocity[a][p] - cloud.particles.velocity[a][id]);
    }
    for (int k = 0; k < Dim * Dim; ++k) {
      grow(worst.gradient, slab.step.gradient[k][p] - slope(k / Dim, k % Dim));
      if (!cloud.particles.options.affine) continue;
      grow(worst.affine, slab.particles.affine[k][p] - slope(k / Dim, k % Dim));
    }
    grow(worst.heat, slab.step.heat[p]);
  }
  return worst;
}

template <int Dim>
void expect_translation_stays(const Choice& choice) {
  SCOPED_TRACE(name(choice) + ", " + std::to_string(Dim) + "-D");
  constexpr double speed = 1100.0;
  Cloud<Dim> cloud = make_cloud<Dim>(choice);
  cloud.transfer.damping = 1e8;
  set_linear_velocity<Dim>(Vector<Dim>::Constant(-speed), Matrix<Dim>::Zero(), cloud);
  Slab<Dim> slab = make_slab(cloud, world);
  transfer_cycle(cloud, 1.0, no_kick<Dim>, world, slab);
  const Deviation worst = deviation<Dim>(cloud, Matrix<Dim>::Zero(), slab);
  EXPECT_LE(worst.velocity, 1e-15 * speed);
  EXPECT_LE(worst.gradient, 1e-15 * speed / cloud.shape.cell);
  EXPECT_LE(worst.affine, 1e-15 * speed / cloud.shape.cell);
  EXPECT_LE(worst.heat, 1e-15 * Dim * speed * speed);
}

TEST(RigidMotion, TranslationKeepsItsVelocityAndMakesNoGradient) {
  for (const Choice& choice : all_choices) {
    expect_translation_stays<2>(choice);
    expect_translation_stays<3>(choice);
  }
}

template <int Dim>
Matrix<Dim> spin() {
  Matrix<Dim> w = Matrix<Dim>::Zero();
  for (int a = 0; a < Dim; ++a) {
    for (int b = a + 1; b < Dim; ++b) {
      w(a, b) = 1e6 * (a + b);
      w(b, a) = -w(a, b);
    }
  }
  return w;
}

template <int Dim>
void expect_angular_momentum_stays(const Cloud<Dim>& cloud, Slab<Dim>& slab) {
  transfer_cycle(cloud, 1.0, no_kick<Dim>, world, slab);
  const Particles<Dim> particles = all_particles(cloud, slab, world);
  const Matrix<Dim> change =
      angular_momentum(cloud.shape, particles) - angular_momentum(cloud.shape, cloud.particles);
  double size = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    size += particles.mass[p] * reference::position(cloud.particles, p).norm() *
            reference::velocity(cloud.particles, p).norm();
  }
  EXPECT_LE(change.norm(), 1e-13 * size);
}

template <int Dim>
void expect_rotation_stays(ShapeFunction shape) {
  Cloud<Dim> cloud = make_cloud<Dim>({shape, VelocityTransfer::apic, false});
  Slab<Dim> random = make_slab(cloud, world);
  expect_angular_momentum_stays(cloud, random);
  const Matrix<Dim> slope = spin<Dim>();
  set_linear_velocity<Dim>(Vector<Dim>::Zero(), slope, cloud);
  Slab<Dim> rotating = make_slab(cloud, world);
  expect_angular_momentum_stays(cloud, rotating);
  const double speed = slope.norm() * cloud.shape.cell * cloud.shape.rows;
  const Deviation worst = deviation<Dim>(cloud, slope, rotating);
  EXPECT_LE(worst.velocity, 1e-14 * speed);
  EXPECT_LE(worst.gradient, 1e-14 * speed / cloud.shape.cell);
  EXPECT_LE(worst.affine, 1e-14 * speed / cloud.shape.cell);
}

TEST(RigidMotion, RotationKeepsItsAngularMomentumWithApic) {
  for (const ShapeFunction shape : {ShapeFunction::quadratic, ShapeFunction::cubic}) {
    expect_rotation_stays<2>(shape);
    expect_rotation_stays<3>(shape);
  }
}

}  // namespace
}  // namespace poreshock
