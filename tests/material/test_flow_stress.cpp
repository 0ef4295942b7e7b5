// Flow stresses against their closed forms, the implicit return, and the library of materials.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>

#include "poreshock/core/elementary.hpp"
#include "poreshock/material/library.hpp"
#include "support/random_numbers.hpp"

namespace {

using namespace poreshock;

FlowStress law_of(const char* name, StrengthModel model) {
  MaterialParameters p = library_material(name)->parameters;
  p.strength = model;
  return std::get<FlowStress>(make_material(p).flow);
}

TEST(Elementary, LogarithmAndExponential) {
  EXPECT_EQ(natural_logarithm(1.0), 0.0);
  EXPECT_EQ(exponential(0.0), 1.0);
  EXPECT_EQ(positive_power(0.0, 0.3), 0.0);
  EXPECT_EQ(positive_power(-1.0, 0.3), 0.0);
  reference::Random random{11};
  for (int i = 0; i < 20000; ++i) {
    const double y = 600.0 * (2.0 * random.uniform() - 1.0);
    const double x = i % 2 == 0 ? std::exp(y) : 1.0 + 1e-3 * y;
    if (x > 0.0) {
      const double exact = std::log(x);
      EXPECT_NEAR(natural_logarithm(x), exact, 5e-16 * std::abs(exact)) << x;
    }
    EXPECT_NEAR(exponential(y) / std::exp(y), 1.0, 5e-16) << y;
  }
}

// Copper of Johnson & Cook at a strain of 0.3, 1e5 1/s and 600 K: by hand from their eq 1.
TEST(JohnsonCook, AtOnePoint) {
  const FlowStress law = law_of("copper", StrengthModel::johnson_cook);
  const double hardened = 90e6 + 292e6 * std::pow(0.3, 0.31);
  const double rate = 1.0 + 0.025 * std::log(1e5);
  const double soft = 1.0 - std::pow((600.0 - 294.0) / (1356.0 - 294.0), 1.09);
  const double factor = thermal_factor(law, 20e9, 1.2, 600.0);
  EXPECT_NEAR(factor, soft, 1e-14);
  EXPECT_NEAR(flow_stress(law, factor, 0.3, 1e5), hardened * rate * soft, 1e-6);
  EXPECT_NEAR(hardened * rate * soft, 278.26e6, 0.01e6);
  // Below the reference rate and temperature nothing is below the static, cold stress.
  EXPECT_NEAR(flow_stress(law, thermal_factor(law, 0.0, 1.0, 250.0), 0.3, 1e-3), hardened, 1e-6);
  EXPECT_EQ(thermal_factor(law, 0.0, 1.0, 1356.0), 0.0);
  EXPECT_EQ(thermal_factor(law, 0.0, 1.0, 5000.0), 0.0);
}

// Copper of Steinberg, Cochran & Guinan at a strain of 0.2, 40 GPa, 1.2 times its density, 500 K.
TEST(SteinbergGuinan, AtOnePoint) {
  const FlowStress law = law_of("copper", StrengthModel::steinberg_guinan);
  const double hardened = 120e6 * std::pow(1.0 + 36.0 * 0.2, 0.45);
  const double modulus = 1.0 + 28.3e-12 * 40e9 / std::cbrt(1.2) - 3.77e-4 * 200.0;
  const double factor = thermal_factor(law, 40e9, 1.2, 500.0);
  EXPECT_NEAR(factor, modulus, 1e-14);
  EXPECT_NEAR(flow_stress(law, factor, 0.2, 1e9), hardened * modulus, 1e-6);
  EXPECT_NEAR(hardened * modulus, 615.49e6, 0.01e6);
  // Hardening stops at Ymax, which the modulus still scales; strong heating takes all strength.
  EXPECT_NEAR(flow_stress(law, factor, 10.0, 0.0), 640e6 * modulus, 1e-6);
  EXPECT_EQ(thermal_factor(law, 0.0, 1.0, 4000.0), 0.0);
}

/// The root by bisection of the stress as flow_stress has it.
double increment_by_bisection(const FlowStress& law, const FlowStep& s) {
  double low = 0.0, high = s.trial / s.triple_shear;
  for (int k = 0; k < 200; ++k) {
    const double d = 0.5 * (low + high);
    const double stress = flow_stress(law, s.factor, s.plastic_strain + d, d / s.dt);
    (s.trial - s.triple_shear * d > stress ? low : high) = d;
  }
  return 0.5 * (low + high);
}

TEST(PlasticIncrement, MeetsTheFlowStress) {
  reference::Random random{5};
  double worst = 0.0;
  for (const char* name : {"copper", "aluminium_6061_t6"}) {
    for (const StrengthModel model :
         {StrengthModel::johnson_cook, StrengthModel::steinberg_guinan}) {
      const FlowStress law = law_of(name, model);
      for (int i = 0; i < 5000; ++i) {
        FlowStep s;
        s.triple_shear = 140e9;
        s.factor = i % 5 == 0 ? 0.0 : 2.0 * random.uniform();
        s.plastic_strain = i % 3 == 0 ? 0.0 : std::pow(random.uniform(), 6.0);
        s.dt = std::pow(10.0, -12.0 + 3.0 * random.uniform());
        const double yield = flow_stress(law, s.factor, s.plastic_strain, 0.0);
        s.trial = yield * (1.0 + std::pow(10.0, -8.0 + 8.5 * random.uniform())) + 1.0;
        const double exact = increment_by_bisection(law, s);
        const double error = s.triple_shear * std::abs(plastic_increment(law, s) - exact) / s.trial;
        worst = std::max(worst, error);
        s.trial = yield * (1.0 - 1e-9);
        EXPECT_EQ(plastic_increment(law, s), 0.0);
      }
    }
  }
  EXPECT_LT(worst, 1e-9);
}

// A fluid and a failed particle have no stress to return.
TEST(PlasticIncrement, WithoutShearThereIsNone) {
  const FlowStress law = law_of("copper", StrengthModel::johnson_cook);
  EXPECT_EQ(plastic_increment(law, {0.0, 0.0, 1.0, 0.0, 1e-10}), 0.0);
  EXPECT_EQ(plastic_increment(law, {0.0, 0.0, 0.0, 0.0, 1e-10}), 0.0);
  EXPECT_EQ(plastic_increment(law, {0.0, 140e9, 1.0, 0.0, 0.0}), 0.0);
}

// One step to the surface, where the work is the mean of the stresses times the plastic strain.
TEST(PlasticIncrement, WorkOfTheReturn) {
  const double shear = 47e9, increment = 1e-3;
  const SymmetricTensor<2> start{1e8, -3e8, 2e8, 5e7};
  SymmetricTensor<2> trial = start;
  for (double& x : trial) x *= 1.5;
  const auto r = return_by<2>(increment, shear, start, trial);
  const double before = std::sqrt(1.5 * contract<2>(start, start));
  const double after = std::sqrt(1.5 * contract<2>(r.deviator, r.deviator));
  EXPECT_NEAR(after, 1.5 * before - 3.0 * shear * increment, 1e-6 * after);
  EXPECT_NEAR(r.plastic_work, 0.5 * (before + after) * increment, 1e-12 * r.plastic_work);
  EXPECT_EQ(r.dissipation, r.plastic_work);
}

TEST(Library, NamesSourcesAndNumbers) {
  std::set<std::string> names;
  for (const LibraryMaterial& m : material_library()) {
    const MaterialParameters& p = m.parameters;
    EXPECT_TRUE(names.insert(p.name).second) << p.name;
    EXPECT_EQ(library_material(p.name), &m);
    EXPECT_FALSE(m.source.empty());
    const double sound = longitudinal_sound_speed(make_material(p));
    EXPECT_GT(sound, p.c0) << p.name;
    EXPECT_LT(sound, 1.5 * p.c0) << p.name;
  }
  EXPECT_EQ(names,
            (std::set<std::string>{"paper_aluminium", "aluminium_6061_t6", "copper", "tungsten",
                                   "magnesium_az31b", "steel_304", "pmma", "hmx"}));
  EXPECT_EQ(library_material("unobtainium"), nullptr);
}

// The shear moduli that the sources state.
TEST(Library, ShearModuli) {
  const auto shear = [](const char* name) {
    return make_material(library_material(name)->parameters).strength.shear;
  };
  EXPECT_NEAR(shear("aluminium_6061_t6"), 27.6e9, 0.02e9);
  EXPECT_NEAR(shear("copper"), 47.7e9, 0.02e9);
  EXPECT_NEAR(shear("tungsten"), 160e9, 0.1e9);
  EXPECT_NEAR(shear("magnesium_az31b"), 16.5e9, 0.01e9);
  EXPECT_NEAR(shear("steel_304"), 77.0e9, 0.01e9);
  EXPECT_NEAR(shear("pmma"), 2.33e9, 0.005e9);
  EXPECT_NEAR(shear("hmx"), 12e9, 0.01e9);
}

}  // namespace
