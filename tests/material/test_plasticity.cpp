// The radial return: exact on radial paths, on the yield surface, its energies and its symmetries.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>

#include "poreshock/material/j2_plasticity.hpp"
#include "support/reference_shock.hpp"

namespace {

using namespace poreshock;

constexpr double yield = 120e6;
constexpr double hardening = 384e6;
constexpr double shear = 69e9 / 2.66;

J2Plasticity law_with(double kinematic_share) {
  return {shear, yield, (1.0 - kinematic_share) * hardening, kinematic_share * hardening};
}

template <int Dim>
double von_mises(const SymmetricTensor<Dim>& s) {
  return std::sqrt(1.5 * contract<Dim>(s, s));
}

/// A material point that adds up what its steps report.
template <int Dim>
struct Point {
  SymmetricTensor<Dim> deviator{};
  SymmetricTensor<Dim> back_stress{};
  double plastic_strain = 0.0;
  double plastic_work = 0.0;
  double dissipation = 0.0;
};

/// One strain increment (a deviator); returns the plastic strain increment.
template <int Dim>
double strain_by(const J2Plasticity& law, const SymmetricTensor<Dim>& de, Point<Dim>& p) {
  SymmetricTensor<Dim> trial = p.deviator;
  for (int c = 0; c < symmetric_size<Dim>; ++c) trial[c] += 2.0 * law.shear * de[c];
  const ReturnMapping<Dim> r =
      radial_return<Dim, true>(law, p.deviator, trial, p.back_stress, p.plastic_strain);
  p.deviator = r.deviator;
  p.back_stress = r.back_stress;
  p.plastic_strain += r.plastic_strain_increment;
  p.plastic_work += r.plastic_work;
  p.dissipation += r.dissipation;
  return r.plastic_strain_increment;
}

/// Deviator of a uniaxial logarithmic compression along y.
SymmetricTensor<2> uniaxial(double strain) {
  return {strain / 3.0, -2.0 / 3.0 * strain, strain / 3.0, 0.0};
}

/// Numbers in [-1, 1), the same everywhere.
struct Sequence {
  std::uint64_t state = 20240607;
  double next() {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return static_cast<double>(state >> 11) * 0x1p-52 - 1.0;
  }
};

template <int Dim>
SymmetricTensor<Dim> random_deviator(Sequence& random, double size) {
  SymmetricTensor<Dim> e;
  for (double& x : e) x = size * random.next();
  e[2] = -(e[0] + e[1]);
  return e;
}

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

// The mean stress times the strain increment is what the deviator stores plus the plastic work:
// no joule is lost in a step, on any path.
template <int Dim>
void check_work(double share) {
  const J2Plasticity law = law_with(share);
  Point<Dim> p;
  Sequence random;
  double work = 0.0;
  for (int i = 0; i < 1000; ++i) {
    const SymmetricTensor<Dim> before = p.deviator;
    const SymmetricTensor<Dim> de = random_deviator<Dim>(random, 3e-3);
    strain_by<Dim>(law, de, p);
    SymmetricTensor<Dim> middle;
    for (int c = 0; c < symmetric_size<Dim>; ++c) middle[c] = 0.5 * (before[c] + p.deviator[c]);
    work += contract<Dim>(middle, de);
  }
  const double stored = contract<Dim>(p.deviator, p.deviator) / (4.0 * shear);
  EXPECT_GT(p.plastic_work, 100.0 * stored);
  EXPECT_NEAR(work, stored + p.plastic_work, 1e-12 * work);
}

TEST(RadialReturn, PlasticWorkIsAllOfTheWork) {
  for (const double share : {0.0, 0.4, 1.0}) {
    check_work<2>(share);
    check_work<3>(share);
  }
}

// The isotropic part of the work is Y ep + Hi ep^2/2 on every path, in steps of any size.
TEST(RadialReturn, DissipationIsAFunctionOfThePlasticStrain) {
  for (const double share : {0.0, 0.4, 1.0}) {
    const J2Plasticity law = law_with(share);
    Point<3> p;
    Sequence random;
    for (int i = 0; i < 200; ++i) {
      strain_by<3>(law, random_deviator<3>(random, 1e-2), p);
      const double expected = (yield + 0.5 * law.isotropic * p.plastic_strain) * p.plastic_strain;
      EXPECT_NEAR(p.dissipation, expected, 1e-12 * expected);
    }
  }
}

/// Plastic work minus what is dissipated and what the back stress stores, on a radial path whose
/// yield point lies in the middle of a step; `work` receives the plastic work.
double unexplained(double share, int steps_to_yield, double& work) {
  const J2Plasticity law = law_with(share);
  const double step = yield / (2.0 * shear) / (steps_to_yield + 0.5);
  Point<2> p;
  for (int i = 0; i < 20 * (2 * steps_to_yield + 1); ++i) strain_by<2>(law, uniaxial(step), p);
  work = p.plastic_work;
  const double stored =
      law.kinematic > 0.0 ? 0.75 * contract<2>(p.back_stress, p.back_stress) / law.kinematic : 0.0;
  return work - p.dissipation - stored;
}

// On a radial path the step that crosses the yield surface is the only one that is not exact: it
// misses d (Y - start)/2 of the work, which falls with the square of the step.
TEST(RadialReturn, DissipatedAndStoredEnergyMakeThePlasticWork) {
  for (const double share : {0.0, 0.4, 1.0}) {
    double before = 0.0;
    for (const int steps : {4, 8, 16, 32}) {
      double work = 0.0;
      const double missing = unexplained(share, steps, work);
      const double step = yield / (2.0 * shear) / (steps + 0.5);
      const double crossing = shear * step;  // von Mises stress on either side of the yield point
      const double expected = -0.5 * crossing * crossing / (3.0 * shear + hardening);
      EXPECT_NEAR(missing, expected, 1e-12 * work) << share << ' ' << steps;
      if (before != 0.0) {
        const double ratio = (2.0 * steps + 1.0) / (steps + 1.0);
        EXPECT_NEAR(before / missing, ratio * ratio, 1e-3);
      }
      before = missing;
    }
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
