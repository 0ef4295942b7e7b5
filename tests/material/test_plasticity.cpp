// The radial return: exact on radial paths, on the yield surface, and its symmetries.

#include <gtest/gtest.h>

#include <cmath>

#include "plastic_points.hpp"
#include "support/reference_shock.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::test;

TEST(RadialReturn, ElasticBelowYield) {
  for (const double share : {0.0, 0.5, 1.0}) {
    Point<2> p;
    const double limit = yield / (2.0 * shear);
    EXPECT_EQ(strain_by<2>(law_with(share), uniaxial(limit * (1 - 1e-12)), p), 0.0);
    EXPECT_EQ(p.plastic_work, 0.0);
    EXPECT_EQ(p.dissipation, 0.0);
    EXPECT_NEAR(von_mises<2>(p.deviator), yield, 1e-10 * yield);
    EXPECT_NEAR(p.deviator[1], -2.0 / 3.0 * yield, 1e-10 * yield);
    EXPECT_GT(strain_by<2>(law_with(share), uniaxial(1e-6), p), 0.0);
  }
}

// Uniaxial strain in one step or in many: von Mises stress 2 G L - 3 G ep with
// ep = (2 G L - Y)/(3 G + H), whatever the kind of hardening.
TEST(RadialReturn, UniaxialStrainInAnyNumberOfSteps) {
  for (const double share : {0.0, 0.3, 1.0}) {
    const J2Plasticity law = law_with(share);
    for (const int steps : {1, 7, 1000}) {
      Point<2> p;
      for (int i = 1; i <= steps; ++i) {
        strain_by<2>(law, uniaxial(0.25 / steps), p);
        const double strain = 0.25 * i / steps;
        const double expected =
            std::max(0.0, (2.0 * shear * strain - yield) / (3.0 * shear + hardening));
        EXPECT_NEAR(p.plastic_strain, expected, 1e-13);
        EXPECT_NEAR(p.deviator[1], -2.0 / 3.0 * (2.0 * shear * strain - 3.0 * shear * expected),
                    1e-12 * shear);
        EXPECT_NEAR(p.deviator[0], -0.5 * p.deviator[1], 1e-13 * shear);
        EXPECT_EQ(p.deviator[3], 0.0);
      }
    }
  }
}

// The plastic strain and the stress deviator behind an exact shock.
TEST(RadialReturn, ExactShockStates) {
  const reference::Solid solid;
  for (const double up : {100.0, 700.0, 1100.0, 2000.0}) {
    const reference::State s = reference::piston(solid, up).shocked;
    Point<2> p;
    const double strain = std::log(s.density() / solid.density);
    for (int i = 0; i < 100; ++i) strain_by<2>(law_with(0.0), uniaxial(strain / 100), p);
    EXPECT_NEAR(p.plastic_strain, s.plastic_strain, 1e-12);
    EXPECT_NEAR(-p.deviator[1], s.deviator(), 1e-9 * s.deviator());
  }
}

template <int Dim>
void check_surface(double share) {
  const J2Plasticity law = law_with(share);
  Point<Dim> p;
  Sequence random;
  int plastic = 0;
  for (int i = 0; i < 3000; ++i) {
    const double d = strain_by<Dim>(law, random_deviator<Dim>(random, 3e-3), p);
    SymmetricTensor<Dim> xi = p.deviator;
    for (int c = 0; c < symmetric_size<Dim>; ++c) xi[c] -= p.back_stress[c];
    const double radius = law.yield + law.isotropic * p.plastic_strain;
    if (d > 0.0) {
      ++plastic;
      EXPECT_NEAR(von_mises<Dim>(xi), radius, 1e-13 * shear * 3e-3) << i;
    } else {
      EXPECT_LE(von_mises<Dim>(xi), radius * (1 + 1e-14)) << i;
    }
    EXPECT_NEAR((p.deviator[0] + p.deviator[1]) + p.deviator[2], 0.0, 1e-12 * shear * 3e-3);
    EXPECT_GE(d, 0.0);
  }
  EXPECT_GT(plastic, 1000);
}

TEST(RadialReturn, EndsOnTheYieldSurface) {
  for (const double share : {0.0, 0.4, 1.0}) {
    check_surface<2>(share);
    check_surface<3>(share);
  }
}

// Without back stress both forms of the function are the same, bit for bit.
TEST(RadialReturn, IsotropicFormAgrees) {
  const J2Plasticity law = law_with(0.0);
  Sequence random;
  SymmetricTensor<2> s{};
  double strain = 0.0;
  for (int i = 0; i < 500; ++i) {
    SymmetricTensor<2> trial = s;
    const SymmetricTensor<2> de = random_deviator<2>(random, 2e-3);
    for (int c = 0; c < 4; ++c) trial[c] += 2.0 * shear * de[c];
    const auto a = radial_return<2, false>(law, s, trial, {}, strain);
    const auto b = radial_return<2, true>(law, s, trial, {}, strain);
    EXPECT_EQ(a.deviator, b.deviator);
    EXPECT_EQ(a.plastic_strain_increment, b.plastic_strain_increment);
    EXPECT_EQ(a.plastic_work, b.plastic_work);
    EXPECT_EQ(a.dissipation, b.dissipation);
    EXPECT_EQ(a.back_stress, SymmetricTensor<2>{});
    EXPECT_EQ(b.back_stress, SymmetricTensor<2>{});
    s = a.deviator;
    strain += a.plastic_strain_increment;
  }
  EXPECT_GT(strain, 0.1);
}

// After loading to plastic strain ep the elastic range on the way back is 2 (Y + H ep) with
// isotropic and 2 Y with kinematic hardening.
TEST(RadialReturn, BauschingerEffect) {
  for (const double share : {0.0, 0.35, 1.0}) {
    const J2Plasticity law = law_with(share);
    const SymmetricTensor<2> pull = {0.0, 0.0, 0.0, 0.05};
    Point<2> loaded;
    strain_by<2>(law, pull, loaded);
    const double ep = loaded.plastic_strain;
    EXPECT_NEAR(von_mises<2>(loaded.deviator), yield + hardening * ep, 1e-12 * shear);
    const double range = 2.0 * (yield + (1.0 - share) * hardening * ep);
    // In shear the von Mises stress changes by 2 sqrt(3) G per strain.
    const double reverse = range / (2.0 * std::sqrt(3.0) * shear);
    Point<2> below = loaded;
    EXPECT_EQ(strain_by<2>(law, {0, 0, 0, -reverse * (1 - 1e-9)}, below), 0.0);
    Point<2> above = loaded;
    EXPECT_GT(strain_by<2>(law, {0, 0, 0, -reverse * (1 + 1e-9)}, above), 0.0);
    // Far beyond: the flow stress on the other side.
    const double d = strain_by<2>(law, {0, 0, 0, -0.05}, loaded);
    const double expected =
        yield + (1.0 - share) * hardening * (ep + d) - share * hardening * (ep - d);
    EXPECT_NEAR(loaded.deviator[3], -expected / std::sqrt(3.0), 1e-12 * shear);
  }
}

TEST(RadialReturn, KinematicHardeningKeepsItsRadius) {
  const J2Plasticity law = law_with(1.0);
  Point<2> p;
  strain_by<2>(law, uniaxial(0.1), p);
  // On the first loading the back stress is 2/3 H ep along the flow.
  EXPECT_NEAR(-p.back_stress[1], 2.0 / 3.0 * hardening * p.plastic_strain, 1e-12 * shear);
  EXPECT_NEAR(p.back_stress[0] + p.back_stress[1] + p.back_stress[2], 0.0, 1e-12 * shear);
}

TEST(RadialReturn, FluidHasNoDeviator) {
  for (const double hard : {0.0, hardening}) {
    const J2Plasticity fluid = {0.0, 0.0, hard, 0.0};
    Point<2> p;
    for (int i = 0; i < 10; ++i) EXPECT_EQ(strain_by<2>(fluid, uniaxial(0.1), p), 0.0);
    EXPECT_EQ(p.deviator, SymmetricTensor<2>{});
    EXPECT_EQ(p.back_stress, SymmetricTensor<2>{});
    EXPECT_EQ(p.plastic_work, 0.0);
    EXPECT_EQ(p.dissipation, 0.0);
  }
}

TEST(RadialReturn, NoYieldStressMeansNoDeviatorAndNoWork) {
  const J2Plasticity law = {shear, 0.0, 0.0, 0.0};
  Point<2> p;
  EXPECT_EQ(strain_by<2>(law, {}, p), 0.0);  // 0/0 without a guard
  EXPECT_EQ(p.deviator, SymmetricTensor<2>{});
  Sequence random;
  for (int i = 0; i < 100; ++i) {
    const SymmetricTensor<2> de = random_deviator<2>(random, 1e-2);
    const double d = strain_by<2>(law, de, p);
    // All of the strain is plastic.
    EXPECT_NEAR(d, std::sqrt(2.0 / 3.0 * contract<2>(de, de)), 1e-15);
    for (const double x : p.deviator) EXPECT_NEAR(x, 0.0, 1e-15 * 2.0 * shear * 1e-2);
  }
  EXPECT_EQ(p.dissipation, 0.0);
  EXPECT_NEAR(p.plastic_work, 0.0, 1e-14 * shear);
}

TEST(RadialReturn, ElasticSolid) {
  const J2Plasticity law = {shear, 1e30, hardening, 0.0};
  Point<2> p;
  EXPECT_EQ(strain_by<2>(law, uniaxial(0.5), p), 0.0);
  EXPECT_NEAR(p.deviator[1], -2.0 / 3.0 * shear, 1e-12 * shear);
}

TEST(RadialReturn, PlaneStrainIsTheThreeDimensionalLaw) {
  const J2Plasticity law = law_with(0.4);
  Point<2> a;
  Point<3> b;
  Sequence random;
  for (int i = 0; i < 500; ++i) {
    const SymmetricTensor<2> e = random_deviator<2>(random, 2e-3);
    EXPECT_EQ(strain_by<2>(law, e, a), strain_by<3>(law, {e[0], e[1], e[2], e[3], 0.0, 0.0}, b));
    for (int c = 0; c < 4; ++c) {
      EXPECT_EQ(a.deviator[c], b.deviator[c]);
      EXPECT_EQ(a.back_stress[c], b.back_stress[c]);
    }
    EXPECT_EQ(b.deviator[4], 0.0);
    EXPECT_EQ(b.deviator[5], 0.0);
  }
  EXPECT_EQ(a.plastic_work, b.plastic_work);
  EXPECT_EQ(a.dissipation, b.dissipation);
}

// Exchanging axes exchanges components, to round-off.
TEST(RadialReturn, AllDirectionsAreAlike) {
  const J2Plasticity law = law_with(0.4);
  Point<3> a, b;
  Sequence random;
  for (int i = 0; i < 300; ++i) {
    const SymmetricTensor<3> e = random_deviator<3>(random, 2e-3);
    strain_by<3>(law, e, a);
    strain_by<3>(law, {e[1], e[2], e[0], e[4], e[5], e[3]}, b);  // x y z -> z x y
  }
  const SymmetricTensor<3> turned = {a.deviator[1], a.deviator[2], a.deviator[0],
                                     a.deviator[4], a.deviator[5], a.deviator[3]};
  for (int c = 0; c < 6; ++c) EXPECT_NEAR(b.deviator[c], turned[c], 1e-9 * yield);
  EXPECT_NEAR(a.plastic_strain, b.plastic_strain, 1e-11);
}

// All stresses times a power of two: the same strains, the same bits.
TEST(RadialReturn, ScalesExactly) {
  for (const double scale : {0x1p-20, 0x1p3, 0x1p40}) {
    const J2Plasticity law = law_with(0.4);
    const J2Plasticity scaled = {law.shear * scale, law.yield * scale, law.isotropic * scale,
                                 law.kinematic * scale};
    Point<3> a, b;
    Sequence random;
    for (int i = 0; i < 300; ++i) {
      const SymmetricTensor<3> e = random_deviator<3>(random, 2e-3);
      EXPECT_EQ(strain_by<3>(law, e, a), strain_by<3>(scaled, e, b));
      for (int c = 0; c < 6; ++c) {
        EXPECT_EQ(a.deviator[c] * scale, b.deviator[c]);
        EXPECT_EQ(a.back_stress[c] * scale, b.back_stress[c]);
      }
    }
    EXPECT_GT(a.plastic_strain, 0.1);
    EXPECT_EQ(a.plastic_work * scale, b.plastic_work);
    EXPECT_EQ(a.dissipation * scale, b.dissipation);
  }
}

}  // namespace
