// The radial return: where the work goes.

#include <gtest/gtest.h>

#include "plastic_points.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::test;

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

}  // namespace
