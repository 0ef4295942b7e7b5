// The averaging operator: its values, and the symmetry on which the energy balance rests.
#include <gtest/gtest.h>

#include "poreshock/transfer/average.hpp"
#include "transfer/cycle.hpp"

namespace poreshock {
namespace {

using test::all_choices;
using test::by_id;
using test::Choice;
using test::Cloud;
using test::make_cloud;
using test::make_slab;
using test::random_motion;
using test::set_motion;
using test::Slab;
using test::world;

/// Averages `values` with the kernels, over all ranks; in the order of ids. Collective.
template <int Dim>
std::vector<double> averaged(const Cloud<Dim>& cloud, const std::vector<double>& values) {
  Cloud<Dim> copy = cloud;
  copy.particles.pressure = values;
  copy.particles.viscous_pressure.assign(values.size(), 0.0);
  copy.transfer.averaging = 1.0;
  Slab<Dim> slab = make_slab(copy, world);
  average_pressure(slab.particles, slab.cells, copy.transfer, *slab.averages);
  return by_id(slab.particles, averaged_pressure(copy, slab), values.size(), world);
}

/// Sum of volume times a times b.
template <int Dim>
double product(const Particles<Dim>& particles, const std::vector<double>& a,
               const std::vector<double>& b) {
  long double sum = 0.0;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    sum += particles.mass[p] / particles.density[p] * a[p] * b[p];
  }
  return static_cast<double>(sum);
}

template <int Dim>
void expect_near(const std::vector<double>& found, const std::vector<double>& expected) {
  double error = 0.0, largest = 0.0;
  ASSERT_EQ(found.size(), expected.size());
  for (std::size_t p = 0; p < found.size(); ++p) {
    error = std::max(error, std::abs(found[p] - expected[p]));
    largest = std::max(largest, std::abs(expected[p]));
  }
  EXPECT_LE(error, 1e-13 * largest);
}

std::vector<double> mixed(double share, const std::vector<double>& own,
                          const std::vector<double>& average) {
  std::vector<double> result;
  for (std::size_t p = 0; p < own.size(); ++p) {
    result.push_back((1.0 - share) * own[p] + share * average[p]);
  }
  return result;
}

template <int Dim>
void compare_pressure(const Choice& choice, double share) {
  SCOPED_TRACE(name(choice) + ", " + std::to_string(Dim) + "-D");
  Cloud<Dim> cloud = make_cloud<Dim>(choice);
  cloud.transfer.averaging = share;
  Slab<Dim> slab = make_slab(cloud, world);
  average_pressure(slab.particles, slab.cells, cloud.transfer, *slab.averages);
  std::vector<double> pressure = cloud.particles.pressure;
  for (std::size_t p = 0; p < pressure.size(); ++p) {
    pressure[p] += cloud.particles.viscous_pressure[p];
  }
  expect_near<Dim>(
      by_id(slab.particles, averaged_pressure(cloud, slab), pressure.size(), world),
      mixed(share, pressure, reference::average(cloud.shape, cloud.particles, pressure)));
}

TEST(Average, OfThePressureIsThatOfTheTextbook) {
  for (const Choice& choice : all_choices) {
    compare_pressure<2>(choice, 1.0);
    compare_pressure<3>(choice, 0.3);
  }
}

template <int Dim>
void compare_dilatation(const Choice& choice, double share) {
  SCOPED_TRACE(name(choice) + ", " + std::to_string(Dim) + "-D");
  Cloud<Dim> cloud = make_cloud<Dim>(choice);
  cloud.transfer.averaging = share;
  Slab<Dim> slab = make_slab(cloud, world);
  const auto motion = random_motion<Dim>(cloud.shape, 8);
  set_motion(motion, *slab.grid);
  prepare_gather<Dim>(cloud.transfer, 0.0, *slab.grid);
  average_dilatation(slab.particles, slab.cells, cloud.transfer, *slab.grid, *slab.averages);
  grid_to_particles<Dim>(*slab.grid, slab.averages.get(), slab.cells, all_rows(*slab.grid),
                         cloud.transfer, Vector<Dim>::Zero(), test::time_step, 1.0, slab.particles,
                         slab.step, slab.filter_heat);
  store_like_particles(slab);
  std::vector<double> end, middle;
  for (std::size_t p = 0; p < cloud.particles.size(); ++p) {
    const auto g = reference::grid_to_particle<Dim>(cloud.shape, motion, cloud.particles, p,
                                                    cloud.transfer.velocity, 0.0);
    end.push_back(g.gradient.trace());
    middle.push_back(g.middle_rate.trace());
  }
  const auto average = [&](const std::vector<double>& own) {
    return mixed(share, own, reference::average(cloud.shape, cloud.particles, own));
  };
  const std::size_t count = end.size();
  expect_near<Dim>(by_id(slab.particles, slab.step.dilatation_end, count, world), average(end));
  expect_near<Dim>(by_id(slab.particles, slab.step.dilatation_mid, count, world), average(middle));
}

TEST(Average, OfTheDilatationIsThatOfTheTextbook) {
  for (const Choice& choice : all_choices) {
    compare_dilatation<2>(choice, 0.6);
    compare_dilatation<3>(choice, 1.0);
  }
}

template <int Dim>
void expect_symmetry(const Choice& choice) {
  SCOPED_TRACE(name(choice) + ", " + std::to_string(Dim) + "-D");
  Cloud<Dim> cloud = make_cloud<Dim>(choice);
  cloud.transfer.averaging = 1.0;
  const Particles<Dim>& particles = cloud.particles;
  const std::size_t count = particles.size();
  const std::vector<double> constant = averaged(cloud, std::vector<double>(count, 1e10));
  for (const double value : constant) EXPECT_NEAR(value, 1e10, 1e-14 * 1e10);

  const std::vector<double>& a = particles.pressure;
  const std::vector<double>& b = particles.deviator[0];
  const std::vector<double> average_a = averaged(cloud, a), average_b = averaged(cloud, b);
  const double size = std::sqrt(product(particles, a, a) * product(particles, b, b));
  EXPECT_NEAR(product(particles, a, average_b), product(particles, b, average_a), 1e-14 * size);
  // It keeps the integral and never adds energy.
  const std::vector<double> ones(count, 1.0);
  EXPECT_NEAR(product(particles, ones, average_a), product(particles, ones, a),
              1e-14 * product(particles, ones, ones) * 1e10);
  EXPECT_LT(product(particles, a, average_a), product(particles, a, a));
  EXPECT_GT(product(particles, b, average_b), 0.0);
}

TEST(Average, KeepsConstantsAndIsSelfAdjoint) {
  for (const Choice& choice : all_choices) {
    expect_symmetry<2>(choice);
    expect_symmetry<3>(choice);
  }
}

}  // namespace
}  // namespace poreshock
