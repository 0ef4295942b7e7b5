// What holds where a scene says nothing.
#include <gtest/gtest.h>

#include <string>

#include "parsed_scene.hpp"

namespace poreshock {
namespace {

TEST(Defaults, OfAllKeys) {
  const Scene scene = parse(small_scene());
  EXPECT_EQ(scene.title, "");
  EXPECT_EQ(scene.dimension, 2);
  EXPECT_EQ(scene.thermal, Thermal::conserving);
  EXPECT_EQ(scene.domain.cells, (std::array<int, 3>{10, 20, 0}));
  EXPECT_EQ(scene.domain.periodic, (std::array<bool, 2>{false, false}));
  EXPECT_EQ(scene.boundary, Boundary{});
  EXPECT_EQ(scene.sample.height, 2e-4);
  EXPECT_EQ(scene.sample.particles_per_cell, 2);
  EXPECT_EQ(scene.materials[0].T0, 300.0);
  EXPECT_EQ(scene.time.cfl, 1.0);
  EXPECT_EQ(scene.transfer, (Transfer{.half_length = 0.25}));
  EXPECT_EQ(scene.viscosity, Viscosity{});
  EXPECT_FALSE(scene.conduction.on);
  EXPECT_FALSE(conducts_heat(scene));
  EXPECT_EQ(scene.output.beat, 5e-9);
  EXPECT_EQ(scene.output.history, 5e-9);
  EXPECT_EQ(scene.output.fields.size(), 14u);
  EXPECT_EQ(scene.morphology.pixel, 1e-5);
  EXPECT_EQ(scene.morphology.every, 0.0);
  EXPECT_EQ(scene.profile.every, 0.0);
  EXPECT_EQ(parse(small_scene(), {"output.snapshot=2e-8"}).profile.every, 2e-8);
  EXPECT_EQ(parse(small_scene(), {"output.snapshot=2e-8", "profile.every=0"}).profile.every, 0.0);
  EXPECT_EQ(scene.checkpoint, Checkpoint{});
}

// Each shape has its own best scheme, and each scheme its own damping and step.
TEST(Defaults, OfTheScheme) {
  const auto expect = [](const std::vector<std::string>& overrides, VelocityTransfer velocity,
                         double damping, double cfl) {
    const Scene scene = parse(small_scene(), overrides);
    EXPECT_EQ(scene.transfer.velocity, velocity) << overrides.front();
    EXPECT_EQ(scene.transfer.damping, damping) << overrides.front();
    EXPECT_EQ(scene.time.cfl, cfl) << overrides.front();
    expect_round_trip(scene);
  };
  using V = VelocityTransfer;
  expect({"transfer.shape=cubic"}, V::aflip, 0.05, 1.0);
  expect({"transfer.shape=quadratic"}, V::aflip, 0.05, 1.0);
  expect({"transfer.shape=gimp"}, V::flip, 0.0, 0.4);
  expect({"transfer.shape=linear"}, V::flip, 0.0, 0.4);
  expect({"transfer.velocity=pic"}, V::pic, 0.0, 0.5);
  expect({"transfer.velocity=flip"}, V::flip, 0.0, 0.4);
  expect({"transfer.velocity=apic"}, V::apic, 0.0, 1.0);
  expect({"transfer.velocity=aflip"}, V::aflip, 0.05, 1.0);
  expect({"transfer.velocity=iapic"}, V::iapic, 0.2, 1.0);
  expect({"transfer.velocity=polypic"}, V::polypic, 0.0, 1.0);
  expect({"transfer.velocity=polyflip"}, V::polyflip, 0.01, 1.0);
  expect({"transfer.velocity=ipolypic"}, V::ipolypic, 1.0, 1.0);
  expect({"transfer.velocity=aflip", "transfer.damping=10", "time.cfl=1.5"}, V::aflip, 10.0, 1.5);
}

TEST(Defaults, OfTheViscosity) {
  const auto viscosity = [](const std::vector<std::string>& overrides) {
    return parse(small_scene(), overrides).viscosity;
  };
  const Viscosity limited{.linear = 1.0, .quadratic = 5.0, .limited = true};
  const Viscosity plain{.linear = 0.6, .quadratic = 2.25, .limited = false};
  EXPECT_EQ(viscosity({}), limited);
  EXPECT_EQ(viscosity({"transfer.velocity=flip"}), limited);
  EXPECT_EQ(viscosity({"viscosity.limited=false"}), plain);
  for (const char* shape :
       {"transfer.shape=quadratic", "transfer.shape=gimp", "transfer.shape=linear"}) {
    EXPECT_EQ(viscosity({shape}), plain) << shape;
  }
  EXPECT_EQ(viscosity({"viscosity.limited=false", "viscosity.linear=0.3"}),
            (Viscosity{.linear = 0.3, .quadratic = 2.25, .limited = false}));
}

}  // namespace
}  // namespace poreshock
