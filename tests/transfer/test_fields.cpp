// Velocity fields that a transfer to the nodes and back must keep: rigid motion, linear and
// quadratic fields; and the angular momentum of any motion.
#include <gtest/gtest.h>

#include <algorithm>

#include "transfer/cycle.hpp"

namespace poreshock {
namespace {

using test::all_choices;
using test::all_particles;
using test::angular_momentum;
using test::Choice;
using test::Cloud;
using test::cycle_motion;
using test::make_cloud;
using test::make_slab;
using test::no_kick;
using test::Slab;
using test::time_step;
using test::transfer_cycle;
using test::world;

/// A velocity field v_a = v0_a + (A x)_a + x . B_a x, B symmetric.
template <int Dim>
struct Field {
  Vector<Dim> constant = Vector<Dim>::Zero();
  Matrix<Dim> slope = Matrix<Dim>::Zero();
  std::array<Matrix<Dim>, Dim> curvature{};
};

/// No field at all.
template <int Dim>
Field<Dim> no_field() {
  Field<Dim> field;
  field.curvature.fill(Matrix<Dim>::Zero());
  return field;
}

/// Gives the particles the modes of a field: with x_i = x + h r it is v(x) + h grad v r + h^2 r.B
/// r, and r_a^2 is its mean h^2 D and what is orthogonal to 1, whose norm is 2/9 - f^2 (1 - f)^2.
template <int Dim>
void set_field(const Field<Dim>& field, Cloud<Dim>& cloud) {
  constexpr int second = second_modes<Dim>;
  Particles<Dim>& particles = cloud.particles;
  const double h = cloud.shape.cell;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const Vector<Dim> x = reference::position(particles, p);
    for (int a = 0; a < Dim; ++a) {
      const Matrix<Dim>& B = field.curvature[static_cast<std::size_t>(a)];
      particles.velocity[a][p] = field.constant[a] + field.slope.row(a).dot(x) + x.dot(B * x) +
                                 reference::inertia(cloud.shape) * B.trace();
      const Vector<Dim> gradient = field.slope.row(a).transpose() + 2.0 * B * x;
      for (int k = 0; k < Dim && particles.options.affine; ++k) {
        particles.affine[a * Dim + k][p] = gradient[k];
      }
      for (int k = 0; k < Dim && particles.options.quadratic; ++k) {
        const double f = x[k] / h - std::floor(x[k] / h), product = f * (1.0 - f);
        particles.quadratic[a * second + k][p] =
            h * h * B(k, k) * std::sqrt(2.0 / 9.0 - product * product);
        if (Dim == 2 && k == 1) continue;
        particles.quadratic[a * second + Dim + k][p] = h * h * 2.0 / 3.0 * B(k, (k + 1) % Dim);
      }
    }
  }
}

/// Largest changes of the modes of a slab since the cloud, and the largest heat.
struct Deviation {
  double velocity = 0.0, affine = 0.0, quadratic = 0.0, heat = 0.0;
};

template <int Dim>
Deviation deviation(const Cloud<Dim>& cloud, const Slab<Dim>& slab) {
  Deviation worst;
  const auto compare = [&](const auto& found, const auto& expected, double& largest) {
    for (std::size_t k = 0; k < found.size(); ++k) {
      for (std::size_t p = 0; p < found[k].size(); ++p) {
        const auto id = static_cast<std::size_t>(slab.particles.id[p]);
        largest = std::max(largest, std::abs(found[k][p] - expected[k][id]));
      }
    }
  };
  compare(slab.particles.velocity, cloud.particles.velocity, worst.velocity);
  compare(slab.particles.affine, cloud.particles.affine, worst.affine);
  compare(slab.particles.quadratic, cloud.particles.quadratic, worst.quadratic);
  for (const double heat : slab.step.heat) worst.heat = std::max(worst.heat, std::abs(heat));
  return worst;
}

/// Largest deviation of the velocity gradient, 1/s.
template <int Dim>
double gradient_error(const Matrix<Dim>& slope, const Slab<Dim>& slab) {
  double worst = 0.0;
  for (int k = 0; k < Dim * Dim; ++k) {
    for (const double value : slab.step.gradient[static_cast<std::size_t>(k)]) {
      worst = std::max(worst, std::abs(value - slope(k / Dim, k % Dim)));
    }
  }
  return worst;
}

template <int Dim>
void expect_translation_stays(const Choice& choice) {
  SCOPED_TRACE(name(choice) + ", " + std::to_string(Dim) + "-D");
  constexpr double speed = 1100.0;
  Cloud<Dim> cloud = make_cloud<Dim>(choice);
  cloud.transfer.damping = 0.2;
  Field<Dim> field = no_field<Dim>();
  field.constant.fill(-speed);
  set_field(field, cloud);
  Slab<Dim> slab = make_slab(cloud, world);
  transfer_cycle(cloud, no_kick<Dim>, world, slab);
  const Deviation worst = deviation<Dim>(cloud, slab);
  EXPECT_LE(worst.velocity, 1e-15 * speed);
  EXPECT_LE(gradient_error<Dim>(field.slope, slab), 1e-15 * speed / cloud.shape.cell);
  EXPECT_LE(worst.affine, 1e-15 * speed / cloud.shape.cell);
  EXPECT_LE(worst.quadratic, 2e-15 * speed);
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

/// Transfers over no time, in which nothing turns, and without periodic sides.
template <int Dim>
void expect_field_stays(const Choice& choice, const Field<Dim>& field) {
  SCOPED_TRACE(name(choice) + ", " + std::to_string(Dim) + "-D");
  Cloud<Dim> cloud = make_cloud<Dim>({choice.shape, choice.velocity, false});
  cloud.transfer.damping = 0.2;
  set_field(field, cloud);
  Slab<Dim> slab = make_slab(cloud, world);
  transfer_cycle(cloud, cycle_motion<Dim>(cloud.transfer, 0.0), no_kick<Dim>, world, slab);
  double speed = 0.0;
  for (std::size_t p = 0; p < cloud.particles.size(); ++p) {
    speed = std::max(speed, reference::velocity(cloud.particles, p).norm());
  }
  EXPECT_GT(speed, 100.0);
  const Deviation worst = deviation<Dim>(cloud, slab);
  EXPECT_LE(worst.velocity, 1e-14 * speed);
  EXPECT_LE(worst.affine, 1e-14 * speed / cloud.shape.cell);
  EXPECT_LE(worst.quadratic, 1e-14 * speed);
  EXPECT_LE(worst.heat, 1e-14 * speed * speed);
}

template <int Dim>
Field<Dim> linear_field() {
  Field<Dim> field = no_field<Dim>();
  field.constant = Vector<Dim>::LinSpaced(-300.0, 200.0);
  for (int k = 0; k < Dim * Dim; ++k) field.slope(k / Dim, k % Dim) = 2e6 * std::cos(3.0 * k + 1.0);
  return field;
}

TEST(Fields, LinearOnesPassTransfersWithAffineModes) {
  for (const Choice& choice : all_choices) {
    if (scheme_of(choice.velocity).modes == Modes::constant) continue;
    expect_field_stays<2>(choice, linear_field<2>());
    expect_field_stays<3>(choice, linear_field<3>());
  }
}

template <int Dim>
Field<Dim> quadratic_field() {
  Field<Dim> field = linear_field<Dim>();
  for (int a = 0; a < Dim; ++a) {
    for (int k = 0; k < Dim * Dim; ++k) {
      const int i = std::min(k / Dim, k % Dim), j = std::max(k / Dim, k % Dim);
      field.curvature[static_cast<std::size_t>(a)](k / Dim, k % Dim) =
          5e10 * std::sin(2.0 * a + 5.0 * i + 7.0 * j + 1.0);
    }
  }
  return field;
}

TEST(Fields, QuadraticOnesPassTransfersWithSecondModes) {
  for (const Choice& choice : all_choices) {
    if (scheme_of(choice.velocity).modes != Modes::quadratic) continue;
    expect_field_stays<2>(choice, quadratic_field<2>());
    expect_field_stays<3>(choice, quadratic_field<3>());
  }
}

/// The particles' angular momentum is the same after a cycle of length dt, at their new places.
template <int Dim>
void expect_angular_momentum_stays(const Cloud<Dim>& cloud, double dt) {
  Slab<Dim> slab = make_slab(cloud, world);
  transfer_cycle(cloud, cycle_motion<Dim>(cloud.transfer, dt), no_kick<Dim>, world, slab);
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

// Where all modes keep the same share the transfer itself is exact. Where they keep none the motion
// of the particles is too: each moves with its own velocity.
TEST(RigidMotion, AngularMomentumStaysWithEqualShares) {
  for (const Choice& choice : all_choices) {
    const TransferScheme& scheme = scheme_of(choice.velocity);
    if (scheme.modes == Modes::constant || scheme.keeps == Keeps::velocity) continue;
    const Choice open = {choice.shape, choice.velocity, false};
    SCOPED_TRACE(name(open));
    Cloud<2> plane = make_cloud<2>(open);
    Cloud<3> space = make_cloud<3>(open);
    for (const double damping : {0.0, 0.5}) {
      plane.transfer.damping = space.transfer.damping = damping;
      expect_angular_momentum_stays(plane, 0.0);
      expect_angular_momentum_stays(space, 0.0);
    }
    if (scheme.keeps != Keeps::nothing) continue;
    expect_angular_momentum_stays(plane, time_step);
    expect_angular_momentum_stays(space, time_step);
  }
}

template <int Dim>
void expect_rotation_stays(const Choice& choice) {
  SCOPED_TRACE(name(choice) + ", " + std::to_string(Dim) + "-D");
  Cloud<Dim> cloud = make_cloud<Dim>({choice.shape, choice.velocity, false});
  Field<Dim> field = no_field<Dim>();
  field.slope = 20.0 * spin<Dim>();
  set_field(field, cloud);
  Slab<Dim> slab = make_slab(cloud, world);
  transfer_cycle(cloud, no_kick<Dim>, world, slab);
  const double rate = field.slope.norm();
  const double speed = rate * cloud.shape.cell * cloud.shape.rows;
  EXPECT_LE(deviation<Dim>(cloud, slab).velocity, 1e-14 * speed);
  EXPECT_LE(gradient_error<Dim>(field.slope, slab), 1e-14 * speed / cloud.shape.cell);
  // With a residual that lives on the affine part turns with the material and keeps its size.
  const bool turns = scheme_of(choice.velocity).keeps == Keeps::all;
  const Matrix<Dim> half = 0.5 * time_step * field.slope, one = Matrix<Dim>::Identity();
  const Matrix<Dim> rotation = (one - half).inverse() * (one + half);
  const Matrix<Dim> expected =
      turns ? Matrix<Dim>(field.slope * rotation.transpose()) : field.slope;
  EXPECT_EQ((expected - field.slope).norm() > 0.01 * rate, turns);
  for (std::size_t p = 0; p < slab.particles.size(); ++p) {
    const Matrix<Dim> affine = reference::affine(slab.particles, p);
    EXPECT_LE((affine - expected).norm(), 1e-14 * speed / cloud.shape.cell);
    EXPECT_NEAR(affine.norm(), rate, 1e-14 * speed / cloud.shape.cell);
  }
}

TEST(RigidMotion, RotationPassesTransfersWithAffineModes) {
  for (const Choice& choice : all_choices) {
    if (scheme_of(choice.velocity).modes == Modes::constant) continue;
    expect_rotation_stays<2>(choice);
    expect_rotation_stays<3>(choice);
  }
}

}  // namespace
}  // namespace poreshock
