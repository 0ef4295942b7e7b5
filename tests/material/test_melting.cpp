// Melt curves and the phase of a state against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include "poreshock/material/library.hpp"
#include "poreshock/material/material.hpp"
#include "support/aluminium.hpp"

namespace poreshock {
namespace {

MaterialParameters melting_aluminium(MeltingLaw law) {
  MaterialParameters p = reference::aluminium();
  p.melting = law;
  p.melt = {933.0, 4.0e5, 6.0e9, 2.0};
  return p;
}

/// Energy (J/kg) of the solid at a density and temperature, without shear.
double solid_energy(const Material& m, double density, double temperature) {
  const double eta = 1.0 - m.eos.density / density;
  return reference_point(m.eos, eta).energy +
         m.eos.cv * (temperature - reference_temperature(m.temperature, eta));
}

TEST(Melting, HeatAtConstantVolumeWarmsThenMeltsThenWarms) {
  for (const MeltingLaw law : {MeltingLaw::lindemann, MeltingLaw::simon_glatzel}) {
    const Material material = make_material(melting_aluminium(law));
    const Material& m = material;
    const double density = 2900.0, cv = m.eos.cv, latent = 4.0e5;
    // On the curve the pressure of the solid is that of its melting temperature.
    double melting = 933.0;
    if (law == MeltingLaw::lindemann) melting = melting_temperature(*m.melt, density, 0.0);
    const auto begin = [&](double T) {
      const double P = conserving_state(m.eos, density, solid_energy(m, density, T)).pressure;
      return melting_temperature(*m.melt, density, P) - T;
    };
    for (int k = 0; k < 200 && law == MeltingLaw::simon_glatzel; ++k) melting += begin(melting);
    const double e = solid_energy(m, density, melting);
    const auto phase = [&](double energy) {
      return material_phase(material, Thermal::conserving,
                            {.density = density, .internal_energy = energy});
    };
    EXPECT_NEAR(phase(e - 100.0 * cv).temperature, melting - 100.0, 1e-6);
    EXPECT_EQ(phase(e - 100.0 * cv).molten, 0.0);
    EXPECT_EQ(phase(e + 2.0 * latent).molten, 1.0);
    EXPECT_NEAR(phase(e + 2.0 * latent).temperature, melting + latent / cv, 1e-6);
    // Half way: by Lindemann's law exactly half; the other curve rises with the pressure of heat.
    const MaterialPhase half = phase(e + 0.5 * latent);
    const double P = conserving_state(m.eos, density, e + 0.5 * latent).pressure;
    EXPECT_NEAR(half.temperature, melting_temperature(*m.melt, density, P), 1e-9);
    const double exact = 0.5 - cv * (half.temperature - melting) / latent;
    EXPECT_NEAR(half.molten, exact, 1e-9);
    if (law == MeltingLaw::lindemann) {
      EXPECT_NEAR(half.molten, 0.5, 1e-9);
    }
  }
}

TEST(Melting, Curves) {
  const auto lindemann = make_material(melting_aluminium(MeltingLaw::lindemann));
  // At no pressure it melts at the given temperature, whatever the material expands by then.
  const double rest = 1.0 / lindemann.melt->inverse;
  EXPECT_NEAR(conserving_state(lindemann.eos, rest, solid_energy(lindemann, rest, 933.0)).pressure,
              0.0, 1.0);
  EXPECT_NEAR(melting_temperature(*lindemann.melt, rest, 0.0), 933.0, 1e-9);
  EXPECT_NEAR(melting_temperature(*lindemann.melt, 1.2 * rest, 0.0),
              933.0 * std::pow(1.2, 2.0 * (2.0 - 1.0 / 3.0)), 1e-9);
  EXPECT_EQ(melting_temperature(*lindemann.melt, 0.9 * rest, 0.0), 933.0);
  const auto simon = make_material(melting_aluminium(MeltingLaw::simon_glatzel));
  EXPECT_NEAR(melting_temperature(*simon.melt, 3000.0, 18e9), 933.0 * 2.0, 1e-9);
  EXPECT_NEAR(melting_temperature(*simon.melt, 3000.0, -1e9), 933.0, 1e-9);
}

TEST(Melting, LatentHeatsFollowFromGibbsEnergies) {
  // G_liquid - G_solid = a + b T + c T^7 vanishes where it melts; H = G - T dG/dT (Dinsdale 1991).
  struct Metal {
    const char* name;
    double a, b, c, mass;  // J/mol ..., kg/mol
  };
  for (const Metal& m : {Metal{"paper_aluminium", 11005.029, -11.841867, 7.934e-20, 26.982e-3},
                         Metal{"aluminium_6061_t6", 11005.029, -11.841867, 7.934e-20, 26.982e-3},
                         Metal{"copper", 12964.735, -9.511904, -5.8489e-21, 63.546e-3}}) {
    const MeltParameters melt = library_material(m.name)->parameters.melt;
    const double T = melt.temperature, T7 = std::pow(T, 7.0);
    EXPECT_NEAR(m.a + m.b * T + m.c * T7, 0.0, 1.0) << m.name;
    EXPECT_NEAR(melt.latent_heat * m.mass / (m.a - 6.0 * m.c * T7), 1.0, 1e-3) << m.name;
  }
}

TEST(Melting, NothingMeltsUnlessAsked) {
  MaterialParameters p = library_material("copper")->parameters;
  EXPECT_GT(p.melt.latent_heat, 0.0);
  const Material solid = make_material(p);
  EXPECT_FALSE(solid.melt);
  EXPECT_TRUE(std::holds_alternative<std::monostate>(solid.flow));
  const ThermalState hot{.density = p.density, .internal_energy = 2e6};
  EXPECT_EQ(material_phase(solid, Thermal::conserving, hot).molten, 0.0);
  p.melting = MeltingLaw::lindemann;
  EXPECT_EQ(material_phase(make_material(p), Thermal::conserving, hot).molten, 1.0);
  EXPECT_EQ(material_phase(make_material(p), Thermal::paper, hot).molten, 0.0);
}

}  // namespace
}  // namespace poreshock
