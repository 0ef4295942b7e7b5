// Derived fields against numbers computed by hand.
#include "poreshock/material/derived.hpp"

#include "output/scenes.hpp"
#include "output/support.hpp"

namespace poreshock {
namespace {

Particles<2> three_particles() {
  Particles<2> p;
  resize(p, 3);
  for (std::size_t i = 0; i < 3; ++i) p.density[i] = 2785.0;
  p.material = {0, 1, 0};
  p.velocity[0] = {3.0, 0.0, -6.0};
  p.velocity[1] = {4.0, -2.0, 8.0};
  p.pressure = {1e9, -2e6, 0.0};
  p.plastic_strain = {0.25, 0.0, 0.5};
  return p;
}

TEST(DeriveField, CopiesAndInvariants) {
  Particles<2> p = three_particles();
  // Uniaxial stress s: deviator (2, -1, -1) s / 3, von Mises s. Pure shear t: sqrt(3) t.
  p.deviator[0] = {2e6, 0.0, 0.0};
  p.deviator[1] = {-1e6, 0.0, 0.0};
  p.deviator[2] = {-1e6, 0.0, 0.0};
  p.deviator[3] = {0.0, 5e5, 0.0};
  const auto materials = test::small_materials();
  std::vector<double> out;
  EXPECT_EQ(derive_field("speed", p, materials, Thermal::paper, out), 0);
  EXPECT_EQ(out, (std::vector<double>{5.0, 2.0, 10.0}));
  derive_field("von_mises", p, materials, Thermal::paper, out);
  EXPECT_DOUBLE_EQ(out[0], 3e6);
  EXPECT_DOUBLE_EQ(out[1], std::sqrt(3.0) * 5e5);
  EXPECT_EQ(out[2], 0.0);
  derive_field("pressure", p, materials, Thermal::paper, out);
  EXPECT_EQ(out, p.pressure);
  derive_field("density", p, materials, Thermal::paper, out);
  EXPECT_EQ(out, p.density);
  derive_field("plastic_strain", p, materials, Thermal::paper, out);
  EXPECT_EQ(out, p.plastic_strain);
}

TEST(DeriveField, TemperatureOfBothModes) {
  Particles<2> p = three_particles();
  p.plastic_work = {880.0 * 50.0, 0.0, 0.0};
  p.internal_energy = {880.0 * 70.0, 880.0 * 20.0, 0.0};
  const auto materials = test::small_materials();
  std::vector<double> out;
  // At the reference density T_r is T0: paper adds W/cv, conserving E/cv.
  EXPECT_EQ(derive_field("temperature", p, materials, Thermal::paper, out), 0);
  EXPECT_NEAR(out[0], 350.0, 1e-6);
  EXPECT_NEAR(out[1], 500.0, 1e-6);
  EXPECT_NEAR(out[2], 300.0, 1e-6);
  EXPECT_EQ(derive_field("temperature", p, materials, Thermal::conserving, out), 0);
  EXPECT_NEAR(out[0], 370.0, 1e-6);
  EXPECT_NEAR(out[1], 520.0, 1e-6);
  // Elastic shear energy s:s/(4 G rho) is no heat.
  p.deviator[3][2] = 1e8;
  const double shear = 70e9 / (2.0 * 1.34);
  p.internal_energy[2] = 2.0 * 1e16 / (4.0 * shear * 2785.0);
  derive_field("temperature", p, materials, Thermal::conserving, out);
  EXPECT_NEAR(out[2], 300.0, 1e-6);
}

TEST(DeriveField, FloorIsCountedAndBadDensityIsNotANumber) {
  Particles<2> p = three_particles();
  p.internal_energy = {-880.0 * 1000.0, -880.0 * 1000.0, 0.0};
  p.density[2] = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> out;
  EXPECT_EQ(derive_field("temperature", p, test::small_materials(), Thermal::conserving, out), 2);
  EXPECT_EQ(out[0], 1.0);
  EXPECT_EQ(out[1], 1.0);
  EXPECT_TRUE(std::isnan(out[2]));
}

TEST(DeriveField, UnknownNameListsTheKnownOnes) {
  std::vector<double> out;
  const std::string text = test::thrown<InputError>([&] {
    derive_field("temperatur", three_particles(), test::small_materials(), Thermal::paper, out);
  });
  EXPECT_TRUE(test::contains(text, "\"temperatur\"")) << text;
  EXPECT_TRUE(test::contains(text, "temperature, pressure, density, speed, von_mises")) << text;
  EXPECT_EQ(derived_unit("von_mises"), "Pa");
}

}  // namespace
}  // namespace poreshock
