// Every bit of a step's transfers is the same on any number of ranks and for any storage order.
#include <gtest/gtest.h>

#include <cstring>

#include "grid/rows.hpp"
#include "transfer/cycle.hpp"

namespace poreshock {
namespace {

using test::all_choices;
using test::by_id;
using test::Choice;
using test::Cloud;
using test::different_rows;
using test::kinetic_energy;
using test::make_cloud;
using test::make_slab;
using test::random_kick;
using test::shuffled;
using test::Slab;
using test::transfer_cycle;
using test::world;

template <int Dim>
std::vector<const std::vector<double>*> results(const Slab<Dim>& slab) {
  std::vector<const std::vector<double>*> columns = {&slab.step.heat, &slab.step.viscous_linear,
                                                     &slab.step.viscous_quadratic};
  for (const auto& column : slab.particles.position) columns.push_back(&column);
  for (const auto& column : slab.particles.velocity) columns.push_back(&column);
  for (const auto& column : slab.step.gradient) columns.push_back(&column);
  for (const auto& column : slab.step.rate) columns.push_back(&column);
  for (const auto& column : slab.particles.affine) {
    if (slab.particles.options.affine) columns.push_back(&column);
  }
  for (const auto& column : slab.particles.quadratic) {
    if (slab.particles.options.quadratic) columns.push_back(&column);
  }
  return columns;
}

template <int Dim>
void expect_same_bits(const Choice& choice) {
  SCOPED_TRACE(name(choice) + ", " + std::to_string(Dim) + "-D");
  Cloud<Dim> cloud = make_cloud<Dim>(choice);
  cloud.transfer.damping = 0.2;
  const std::size_t count = cloud.particles.size();
  ParticleMotion<Dim> motion = test::cycle_motion<Dim>(cloud.transfer, test::time_step);
  motion.inverse_energy_quantum =
      1.0 / power_of_two_below(std::ldexp(kinetic_energy(cloud.shape, cloud.particles), -60));
  Slab<Dim> serial = make_slab(cloud, MPI_COMM_SELF);
  transfer_cycle(cloud, motion, random_kick<Dim>, MPI_COMM_SELF, serial);
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    Slab<Dim> slab = make_slab(cloud, shuffled(count, seed), world);
    transfer_cycle(cloud, motion, random_kick<Dim>, world, slab);
    EXPECT_EQ(different_rows(*slab.grid, *serial.grid), std::vector<int>{});
    const auto found = results(slab), expected = results(serial);
    for (std::size_t c = 0; c < found.size(); ++c) {
      const auto a = by_id(slab.particles, *found[c], count, world);
      const auto b = by_id(serial.particles, *expected[c], count, MPI_COMM_SELF);
      EXPECT_EQ(std::memcmp(a.data(), b.data(), count * sizeof(double)), 0) << "column " << c;
    }
    std::vector<Int128> sums = {slab.report.heat, slab.report.shortened, slab.report.negative};
    sum(sums, world);
    EXPECT_TRUE(sums[0] == serial.report.heat);
    EXPECT_TRUE(sums[0] != 0);
    EXPECT_TRUE(sums[1] == serial.report.shortened);
    EXPECT_TRUE(sums[2] == serial.report.negative);
  }
}

TEST(SameBits, OnAnyNumberOfRanksAndInAnyStorageOrder) {
  for (const Choice& choice : all_choices) {
    expect_same_bits<2>(choice);
    expect_same_bits<3>(choice);
  }
}

}  // namespace
}  // namespace poreshock
