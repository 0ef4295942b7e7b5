// One particle compressed and sheared in many steps: the update against closed forms.

#include "physics/particle_states.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::test;

constexpr double dt = 1.0e-10;
const MaterialParameters aluminium = reference::aluminium();
const reference::Solid solid = reference::solid(aluminium);

/// What a path adds up besides the state.
struct Path {
  double volume_work = 0.0;  ///< sum of -P dV, J/kg
  StressReport report;
};

/// Stretches one particle along its axes by the given logarithmic strains in equal steps. The
/// velocity is constant over a step, so the middle gradient is that of its end.
template <int Dim>
Path stretch(const std::vector<Material>& materials, const StressSettings<Dim>& settings,
             const std::array<double, Dim>& strain, int steps, Points<Dim>& point) {
  std::array<double, Dim * Dim> gradient{};
  for (int a = 0; a < Dim; ++a) gradient[a * (Dim + 1)] = std::expm1(strain[a] / steps) / dt;
  set_motion<Dim>(gradient, gradient, 0, point.step);
  Path path;
  for (int n = 0; n < steps; ++n) {
    const double p = point.particles.pressure[0], density = point.particles.density[0];
    path.report = update<Dim>(materials, settings, dt, point);
    path.volume_work -= p * (1.0 / point.particles.density[0] - 1.0 / density);
  }
  return path;
}

template <int Dim>
std::array<double, Dim> along_last_axis(double strain) {
  std::array<double, Dim> result{};
  result[Dim - 1] = strain;
  return result;
}

template <int Dim>
StressSettings<Dim> inviscid(Thermal thermal = Thermal::conserving) {
  StressSettings<Dim> settings = settings_of<Dim>(thermal);
  settings.viscosity = {0.0, 0.0};
  return settings;
}

/// Integral of f from 0 to b (Simpson).
template <class F>
double integral(const F& f, double b) {
  constexpr int n = 2000;
  double sum = f(0.0) + f(b);
  for (int i = 1; i < n; ++i) sum += (i % 2 == 1 ? 4.0 : 2.0) * f(b * i / n);
  return sum * b / (3.0 * n);
}

// Without strength and viscosity dE = -P dV: the isentrope, on which T V^gamma is constant. The
// work of a step takes the pressure of its start, so the error is of first order in the step.
template <int Dim>
void follows_the_isentrope(double strain) {
  MaterialParameters water = aluminium;
  water.young = water.yield = water.hardening = 0.0;
  const std::vector<Material> materials = {make_material(water)};
  std::array<double, 3> T{};
  for (int k = 0; k < 3; ++k) {
    Points<Dim> point = at_rest<Dim>(water);
    const int steps = 1000 << k;
    const Path path =
        stretch<Dim>(materials, inviscid<Dim>(), along_last_axis<Dim>(strain), steps, point);
    const Particles<Dim>& p = point.particles;
    const double density = 2700.0 * std::exp(-strain);
    EXPECT_NEAR(p.density[0], density, 2e-16 * steps * density);
    EXPECT_NEAR(p.internal_energy[0], path.volume_work, 1e-11 * path.volume_work);
    EXPECT_NEAR(p.pressure[0], reference::pressure(solid, 1.0 / p.density[0], p.internal_energy[0]),
                1e-3);
    EXPECT_EQ(von_mises<Dim>(p), 0.0);
    EXPECT_EQ(p.plastic_strain[0], 0.0);
    T[k] = temperature(materials[0], Thermal::conserving,
                       {p.density[0], p.internal_energy[0], 0.0, 0.0, 0.0});
  }
  const double expected = 300.0 * std::exp(-2.0 * strain);
  EXPECT_NEAR((T[0] - expected) / (T[1] - expected), 2.0, 0.01);
  EXPECT_NEAR((T[1] - expected) / (T[2] - expected), 2.0, 0.01);
  const double extrapolated = (8.0 * T[2] - 6.0 * T[1] + T[0]) / 3.0;
  EXPECT_NEAR(extrapolated, expected, 1e-7);
}

TEST(Uniaxial, FluidFollowsTheIsentrope) {
  follows_the_isentrope<2>(-0.17);
  follows_the_isentrope<3>(-0.17);
  follows_the_isentrope<2>(0.02);
}

// Elastic to Y/2G, where the exact precursor stands (its energy differs in the third order only);
// then on the yield surface with ep = (2 G L - Y)/(3 G + H), in any number of steps.
template <int Dim>
void strength_is_exact(int steps) {
  const std::vector<Material> materials = {make_material(aluminium)};
  const StressSettings<Dim> settings = inviscid<Dim>();
  Points<Dim> point = at_rest<Dim>(aluminium);
  const Particles<Dim>& p = point.particles;
  const double limit = solid.yield / (2.0 * solid.shear);
  stretch<Dim>(materials, settings, along_last_axis<Dim>(-limit * (1.0 - 1e-9)), steps, point);
  EXPECT_EQ(p.plastic_strain[0], 0.0);
  EXPECT_NEAR(von_mises<Dim>(p), solid.yield, 2e-9 * solid.yield);
  EXPECT_NEAR(p.deviator[Dim - 1][0], -80.0e6, 1.0);
  EXPECT_NEAR(p.density[0], 2706.252, 5e-4);
  EXPECT_NEAR(p.pressure[0], 179.66e6, 0.01e6 + 2e6 / steps);
  EXPECT_NEAR(p.pressure[0] - p.deviator[Dim - 1][0], 259.66e6, 0.01e6 + 2e6 / steps);

  const double beyond = 0.15;
  stretch<Dim>(materials, settings, along_last_axis<Dim>(-beyond - limit * 1e-9), steps, point);
  const double strain = limit + beyond;
  const double ep =
      (2.0 * solid.shear * strain - solid.yield) / (3.0 * solid.shear + solid.hardening);
  // In few steps the rational logarithm shows: at most 0.023 z^6 of the strain z of a step.
  const double logarithm = 0.023 * std::pow(beyond / steps, 6) * beyond;
  EXPECT_NEAR(p.plastic_strain[0], ep, 1e-13 + logarithm);
  EXPECT_NEAR(p.deviator[Dim - 1][0], -2.0 / 3.0 * (solid.yield + solid.hardening * ep),
              2.0 + 4.0 * solid.hardening * logarithm);
  EXPECT_NEAR(p.deviator[0][0], -0.5 * p.deviator[Dim - 1][0], 2.0);
  EXPECT_NEAR(p.density[0], 2700.0 * std::exp(strain), 1e-12 * 2700.0);
}

TEST(Uniaxial, StrengthIsExact) {
  for (const int steps : {5, 60, 1000}) {
    strength_is_exact<2>(steps);
    strength_is_exact<3>(steps);
  }
}

// Plastic work is the integral of V sigma_v dep; what E gains beyond -P dV is that of 2/3 V
// sigma_v.
TEST(Uniaxial, PlasticWorkAndStressPower) {
  const std::vector<Material> materials = {make_material(aluminium)};
  const double total = 0.12, limit = solid.yield / (2.0 * solid.shear);
  const double slope = 2.0 * solid.shear / (3.0 * solid.shear + solid.hardening);
  const auto volume = [](double L) { return std::exp(-L) / 2700.0; };
  const auto flow = [&](double L) { return solid.yield + solid.hardening * slope * (L - limit); };
  const double plastic = integral(
      [&](double x) { return volume(limit + x) * flow(limit + x) * slope; }, total - limit);
  const double power =
      2.0 / 3.0 *
      (integral([&](double L) { return volume(L) * 2.0 * solid.shear * L; }, limit) +
       integral([&](double x) { return volume(limit + x) * flow(limit + x); }, total - limit));
  std::array<double, 2> gained{};
  for (int k = 0; k < 2; ++k) {
    Points<2> point = at_rest<2>(aluminium);
    const Path path = stretch<2>(materials, inviscid<2>(), {0.0, -total}, 4000 << k, point);
    gained[k] = point.particles.internal_energy[0] - path.volume_work;
    EXPECT_NEAR(point.particles.plastic_work[0], plastic, 1e-4 * plastic / (1 << k));
  }
  EXPECT_NEAR(gained[1], power, 1e-3 * power);
  EXPECT_NEAR(2.0 * gained[1] - gained[0], power, 2e-6 * power);
}

// Paper thermodynamics: no energy enters the pressure, only plastic work does; after a cycle back
// to V0 only its heat is left.
// At constant velocity the nodes give the work of the stress of the start of each step. An elastic
// particle stores that of the mean: half of M (e/n)^2 more, in each of n steps.
TEST(Uniaxial, WorkThatIsNotStoredIsHeatOfTheSteps) {
  MaterialParameters elastic = aluminium;
  elastic.yield = 1e15;
  const std::vector<Material> materials = {make_material(elastic)};
  Points<3> point = at_rest<3>(elastic);
  const double strain = -1e-5, modulus = solid.bulk() + 4.0 / 3.0 * solid.shear;
  const int steps = 10;
  double heat = 0.0, compression = 0.0;
  const double quantum = 1.0 / inviscid<3>().inverse_energy_quantum;
  for (int n = 0; n < steps; ++n) {
    const Path path = stretch<3>(materials, inviscid<3>(), {0.0, 0.0, strain / steps}, 1, point);
    heat += static_cast<double>(path.report.step_heat) * quantum;
    compression += static_cast<double>(path.report.compression_work) * quantum;
  }
  const double each = 0.5 * modulus * (strain / steps) * (strain / steps) / 2700.0;
  EXPECT_NEAR(heat, -steps * each, 1e-3 * steps * each);
  const double stored = 0.5 * solid.bulk() * strain * strain / 2700.0;
  EXPECT_NEAR(compression, stored, 1e-3 * stored);
}

TEST(Uniaxial, PaperMode) {
  const std::vector<Material> materials = {make_material(aluminium)};
  Points<2> point = at_rest<2>(aluminium);
  Points<2> hot = point;
  hot.particles.internal_energy[0] = 1.0e6;
  stretch<2>(materials, inviscid<2>(Thermal::paper), {0.0, -0.1}, 500, point);
  stretch<2>(materials, inviscid<2>(Thermal::paper), {0.0, -0.1}, 500, hot);
  const Particles<2>& p = point.particles;
  const double work = p.plastic_work[0];
  EXPECT_GT(work, 2000.0);
  EXPECT_EQ(hot.particles.pressure[0], p.pressure[0]);
  EXPECT_EQ(hot.particles.plastic_work[0], work);
  const double curve = reference::curve_pressure(solid, 1.0 / p.density[0]);
  EXPECT_NEAR(p.pressure[0], curve + 2.0 * p.density[0] * work, 1e-12 * curve);
  // The energy is booked all the same.
  EXPECT_NEAR(hot.particles.internal_energy[0] - 1.0e6, p.internal_energy[0], 1e-8);
  EXPECT_GT(p.internal_energy[0], 5.0e4);
  stretch<2>(materials, inviscid<2>(Thermal::paper), {0.0, 0.1}, 500, point);
  EXPECT_NEAR(p.density[0], 2700.0, 1e-9);
  EXPECT_NEAR(p.pressure[0], 2.0 * 2700.0 * p.plastic_work[0], 1e3);
}

// Forward shear by plane stretching, then back: with kinematic hardening the reverse yield comes
// after 2 Y, with isotropic after 2 (Y + H ep).
TEST(Hardening, ReverseYield) {
  for (const double share : {0.0, 0.25, 1.0}) {
    MaterialParameters m = aluminium;
    m.kinematic_share = share;
    m.hardening = 4.0e9;
    m.plastic_heat = PlasticHeat::dissipation;
    const std::vector<Material> materials = {make_material(m)};
    Points<2> point = at_rest<2>(m);
    const Particles<2>& p = point.particles;
    const double per_strain = 2.0 * std::sqrt(3.0) * solid.shear;  // von Mises stress
    const double modulus = 3.0 * solid.shear + m.hardening;
    const double forward = 0.03;
    stretch<2>(materials, inviscid<2>(), {forward, -forward}, 40, point);
    const double ep = (per_strain * forward - m.yield) / modulus;
    EXPECT_NEAR(p.plastic_strain[0], ep, 1e-13);
    EXPECT_NEAR(von_mises<2>(p), m.yield + m.hardening * ep, 10.0);
    if (share > 0.0) {
      const SymmetricTensor<2> alpha = tensor_of<2>(p.back_stress);
      EXPECT_NEAR(std::sqrt(1.5 * contract<2>(alpha, alpha)), share * m.hardening * ep, 10.0);
      EXPECT_GT(alpha[0], 0.0);
    }
    const double heat = m.yield * ep + 0.5 * (1.0 - share) * m.hardening * ep * ep;
    EXPECT_NEAR(p.plastic_work[0] * 2700.0, heat, 1e-11 * heat);

    const double range = 2.0 * (m.yield + (1.0 - share) * m.hardening * ep);
    const double back = range / per_strain;
    stretch<2>(materials, inviscid<2>(), {-back * (1 - 1e-9), back * (1 - 1e-9)}, 20, point);
    EXPECT_NEAR(p.plastic_strain[0], ep, 1e-13);
    stretch<2>(materials, inviscid<2>(), {-0.01, 0.01}, 20, point);
    EXPECT_NEAR(p.plastic_strain[0], ep + per_strain * (0.01 - 1e-9 * back) / modulus, 1e-13);
  }
}

}  // namespace
