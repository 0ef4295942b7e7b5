// The filter of FMPM: against plain loops, what it keeps, and what it must not touch.
#include "poreshock/transfer/velocity_filter.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "transfer/cycle.hpp"

namespace poreshock {
namespace {

using test::all_particles;
using test::by_id;
using test::Choice;
using test::Cloud;
using test::kinetic_energy;
using test::make_cloud;
using test::make_slab;
using test::momentum;
using test::Slab;
using test::total;
using test::world;

const std::array<Choice, 3> choices = {{{ShapeFunction::cubic, VelocityTransfer::fmpm, false},
                                        {ShapeFunction::quadratic, VelocityTransfer::fmpm, true},
                                        {ShapeFunction::gimp, VelocityTransfer::fmpm, true}}};

template <int Dim>
Slab<Dim> filtered(const Cloud<Dim>& cloud, double inverse_quantum) {
  Slab<Dim> slab = make_slab(cloud, world);
  const FilterField field = {&slab.cells, slab.grid.get()};
  filter_velocity<Dim>(std::span(&field, 1), {}, cloud.transfer, inverse_quantum, slab.particles,
                       slab.step, slab.filter_heat);
  return slab;
}

/// v - (1 - P)^k v, to round-off.
template <int Dim>
void expect_textbook(const Choice& choice, int order) {
  SCOPED_TRACE(name(choice) + ", order " + std::to_string(order));
  Cloud<Dim> cloud = make_cloud<Dim>(choice);
  cloud.transfer.order = order;
  const Slab<Dim> slab = filtered(cloud, 1.0);
  const Particles<Dim> found = all_particles(cloud, slab, world);
  for (int a = 0; a < Dim; ++a) {
    std::vector<double> rest = cloud.particles.velocity[a];
    for (int k = 0; k < order; ++k) rest = reference::residual(cloud.shape, cloud.particles, rest);
    for (std::size_t p = 0; p < rest.size(); ++p) {
      EXPECT_NEAR(found.velocity[a][p], cloud.particles.velocity[a][p] - rest[p], 1e-12 * 500.0);
    }
  }
}

TEST(VelocityFilter, IsThatOfTheTextbook) {
  for (const Choice& choice : choices) {
    for (const int order : {2, 3, 4, 5}) expect_textbook<2>(choice, order);
    expect_textbook<3>(choice, 3);
  }
}

/// Momentum stays; kinetic energy goes to the internal energy, all of it, and to the ledger.
template <int Dim>
void expect_conservation(const Choice& choice, int order, double frame) {
  SCOPED_TRACE(name(choice) + ", order " + std::to_string(order));
  Cloud<Dim> cloud = make_cloud<Dim>(choice);
  cloud.transfer.order = order;
  for (double& v : cloud.particles.velocity[0]) v += frame;
  const double before = kinetic_energy(cloud.shape, cloud.particles);
  const double quantum = power_of_two_below(std::ldexp(before, -60));
  const Slab<Dim> slab = filtered(cloud, 1.0 / quantum);
  const Particles<Dim> particles = all_particles(cloud, slab, world);
  const std::vector<double> heats =
      by_id(slab.particles, slab.particles.internal_energy, particles.size(), world);
  const double heat = total(particles.mass, heats);
  EXPECT_GE(*std::min_element(heats.begin(), heats.end()), 0.0);
  const double after = kinetic_energy(cloud.shape, particles);
  EXPECT_LT(after, before);
  EXPECT_NEAR(after + heat, before, 1e-14 * before);
  std::vector<Int128> booked = {slab.filter_heat};
  sum(booked, world);
  EXPECT_NEAR(static_cast<double>(booked[0]) * quantum, heat, 1e-14 * before);
  const Vector<Dim> change = momentum(particles) - momentum(cloud.particles);
  EXPECT_LE(change.norm(), 1e-13 * momentum(cloud.particles).norm() + 1e-13 * before / 500.0);
}

TEST(VelocityFilter, TurnsTheEnergyItTakesIntoHeat) {
  for (const Choice& choice : choices) {
    for (const int order : {2, 3, 4, 5}) expect_conservation<2>(choice, order, 0.0);
    expect_conservation<2>(choice, 3, 1000.0);
    expect_conservation<3>(choice, 2, 0.0);
    expect_conservation<3>(choice, 3, 0.0);
  }
}

TEST(VelocityFilter, DoesNotSeeTheFrame) {
  for (const int order : {2, 3, 4}) {
    Cloud<2> cloud = make_cloud<2>(choices[0]);
    cloud.transfer.order = order;
    const Slab<2> resting = filtered(cloud, 1.0);
    for (double& v : cloud.particles.velocity[0]) v += 1000.0;
    const Slab<2> moving = filtered(cloud, 1.0);
    for (std::size_t p = 0; p < resting.particles.size(); ++p) {
      EXPECT_NEAR(moving.particles.velocity[0][p] - 1000.0, resting.particles.velocity[0][p],
                  1e-14 * 1500.0 * order);
      EXPECT_NEAR(moving.particles.internal_energy[p], resting.particles.internal_energy[p],
                  1e-13 * 1500.0 * 1500.0);
    }
  }
}

TEST(VelocityFilter, LeavesUniformMotionAlone) {
  Cloud<2> cloud = make_cloud<2>(choices[0]);
  for (auto& column : cloud.particles.velocity) std::fill(column.begin(), column.end(), 1100.0);
  const Slab<2> slab = filtered(cloud, 1.0);
  for (std::size_t p = 0; p < slab.particles.size(); ++p) {
    EXPECT_NEAR(slab.particles.velocity[0][p], 1100.0, 1e-12);
    EXPECT_NEAR(slab.particles.internal_energy[p], 0.0, 1e-20 * 1100.0 * 1100.0);
  }
}

TEST(VelocityFilter, TakesLessWithHigherOrder) {
  double last = 0.0;
  for (const int order : {2, 3, 4, 6, 8}) {
    Cloud<2> cloud = make_cloud<2>(choices[0]);
    cloud.transfer.order = order;
    const Slab<2> slab = filtered(cloud, 1.0);
    const double kept = kinetic_energy(cloud.shape, all_particles(cloud, slab, world));
    EXPECT_GT(kept, last) << order;
    last = kept;
  }
}

}  // namespace
}  // namespace poreshock
