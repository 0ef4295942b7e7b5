// The remapped velocity of MUSL: against plain loops.
#include "poreshock/transfer/remap.hpp"

#include <gtest/gtest.h>

#include "transfer/cycle.hpp"

namespace poreshock {
namespace {

using test::Choice;
using test::Cloud;
using test::make_cloud;
using test::make_slab;
using test::Slab;
using test::world;

/// Gradient of the mass-weighted nodal velocity, places moved by the transport.
template <int Dim>
void expect_textbook(const Choice& choice) {
  SCOPED_TRACE(name(choice) + ", " + std::to_string(Dim) + "-D");
  constexpr double dt = 2e-9;
  const Cloud<Dim> cloud = make_cloud<Dim>(choice);
  Slab<Dim> slab = make_slab(cloud, world);
  for (int a = 0; a < Dim; ++a) {
    slab.step.transport[a].assign(slab.particles.size(), 100.0 * (a + 1));
  }
  remap_velocity<Dim>(slab.particles, slab.cells, cloud.transfer, *slab.grid);
  slab.grid->exchange();
  test::kick_nodes<Dim>(false, test::no_kick<Dim>, *slab.grid);
  slab.grid->fill_periodic_images();
  const Vector<Dim> grid_velocity = Vector<Dim>::Constant(-300.0);
  resize_ordered(slab.particles.size(), false, slab.step);
  gather_remapped<Dim>(*slab.grid, slab.cells, cloud.transfer, grid_velocity, dt, slab.particles,
                       slab.step);
  store_like_particles(slab);
  for (int a = 0; a < Dim; ++a) {
    const auto mean =
        reference::nodal_mean(cloud.shape, cloud.particles, cloud.particles.velocity[a]);
    for (std::size_t local = 0; local < slab.particles.size(); ++local) {
      const auto p = static_cast<std::size_t>(slab.particles.id[local]);
      Vector<Dim> gradient = Vector<Dim>::Zero();
      reference::for_each_node<Dim>(
          cloud.shape, reference::position(cloud.particles, p),
          [&](int i, double, const auto& slope, const auto&) { gradient += mean[i] * slope; });
      const double rounding = 1e-13 * 500.0 / cloud.shape.cell;
      for (int k = 0; k < Dim; ++k) {
        EXPECT_NEAR(slab.step.gradient[a * Dim + k][local], gradient[k], rounding);
      }
      EXPECT_NEAR(slab.step.rate[a][local], gradient[a], rounding);
      EXPECT_NEAR(slab.particles.position[a][local],
                  cloud.particles.position[a][p] + dt * (100.0 * (a + 1) + 300.0),
                  1e-15 * cloud.shape.cell * cloud.shape.rows);
    }
  }
}

TEST(Remap, IsThatOfTheTextbook) {
  expect_textbook<2>({ShapeFunction::linear, VelocityTransfer::flip, true});
  expect_textbook<2>({ShapeFunction::gimp, VelocityTransfer::flip, false});
  expect_textbook<3>({ShapeFunction::gimp, VelocityTransfer::flip, true});
}

}  // namespace
}  // namespace poreshock
