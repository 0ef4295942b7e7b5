// One particle compressed, rotated and sheared: the update against closed forms.

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

/// Row-major rotation by `angle` about the axis with the given unit direction.
std::array<double, 9> rotation_about(const std::array<double, 3>& n, double angle) {
  const double c = std::cos(angle), s = std::sin(angle);
  std::array<double, 9> R;
  for (int a = 0; a < 3; ++a) {
    for (int b = 0; b < 3; ++b) R[3 * a + b] = (1.0 - c) * n[a] * n[b] + (a == b ? c : 0.0);
  }
  R[1] -= s * n[2], R[2] += s * n[1], R[3] += s * n[2];
  R[5] -= s * n[0], R[6] -= s * n[1], R[7] += s * n[0];
  return R;
}

/// Turns a stressed particle rigidly in equal steps that add up to `angle`.
template <int Dim>
Points<Dim> turned(double angle, int steps, const std::array<double, 3>& axis, Points<Dim> point,
                   const std::vector<Material>& materials) {
  const std::array<double, 9> R = rotation_about(axis, angle / steps);
  std::array<double, Dim * Dim> gradient;
  for (int a = 0; a < Dim; ++a) {
    for (int b = 0; b < Dim; ++b) {
      gradient[a * Dim + b] = (R[3 * a + b] - (a == b ? 1.0 : 0.0)) / dt;
    }
  }
  set_motion<Dim>(gradient, {}, 0, point.step);
  for (int n = 0; n < steps; ++n) {
    EXPECT_EQ(update<Dim>(materials, inviscid<Dim>(), dt, point).bad, 0);
  }
  return point;
}

TEST(Rotation, PlaneStressTurnsByTheAngle) {
  MaterialParameters kinematic = aluminium;
  kinematic.kinematic_share = 0.5;
  kinematic.yield = 1.0e12;
  const std::vector<Material> materials = {make_material(kinematic)};
  Points<2> start = at_rest<2>(kinematic);
  start.particles.density[0] = 2800.0;
  start.particles.internal_energy[0] = 1.0e5;
  const SymmetricTensor<2> s = {4e9, -3e9, -1e9, 1.5e9}, b = {5e8, -8e8, 3e8, 2e8};
  for (int k = 0; k < 4; ++k) {
    start.particles.deviator[k][0] = s[k];
    start.particles.back_stress[k][0] = b[k];
  }
  for (const int steps : {1, 9, 1000}) {
    const Points<2> quarter = turned<2>(M_PI / 2, steps, {0, 0, 1}, start, materials);
    const SymmetricTensor<2> found = tensor_of<2>(quarter.particles.deviator);
    const SymmetricTensor<2> expected = {s[1], s[0], s[2], -s[3]};
    const SymmetricTensor<2> back = {b[1], b[0], b[2], -b[3]};
    // A rotation is a matrix of rounded numbers: each step strains by some 1e-16.
    const double error = 1e-13 * 5e9 + 1e-16 * 2.0 * solid.shear * steps;
    for (int k = 0; k < 4; ++k) {
      EXPECT_NEAR(found[k], expected[k], error);
      EXPECT_NEAR(quarter.particles.back_stress[k][0], back[k], error);
    }
    EXPECT_EQ(quarter.particles.plastic_strain[0], 0.0);
    EXPECT_EQ(quarter.particles.internal_energy[0], 1.0e5);
    EXPECT_NEAR(quarter.particles.density[0], 2800.0, 1e-12 * 2800.0);
  }
  // An eighth of a turn, anticlockwise: (xx - yy)/2 goes to xy and xy to -(xx - yy)/2.
  const Points<2> eighth = turned<2>(M_PI / 4, 10, {0, 0, 1}, start, materials);
  EXPECT_NEAR(eighth.particles.deviator[3][0], 0.5 * (s[0] - s[1]), 1e-13 * 5e9);
  EXPECT_NEAR(0.5 * (eighth.particles.deviator[0][0] - eighth.particles.deviator[1][0]), -s[3],
              1e-13 * 5e9);
}

TEST(Rotation, SpaceStressTurnsByTheAngle) {
  MaterialParameters elastic = aluminium;
  elastic.yield = 1.0e12;
  const std::vector<Material> materials = {make_material(elastic)};
  Points<3> start = at_rest<3>(elastic);
  const SymmetricTensor<3> s = {3e9, -2.5e9, -5e8, 1.2e9, -9e8, 7e8};
  for (int k = 0; k < 6; ++k) start.particles.deviator[k][0] = s[k];
  // A third of a turn about (1, 1, 1) carries x to y, y to z and z to x.
  const double n = 1.0 / std::sqrt(3.0);
  const Points<3> third = turned<3>(2.0 * M_PI / 3.0, 20, {n, n, n}, start, materials);
  const SymmetricTensor<3> expected = {s[2], s[0], s[1], s[5], s[3], s[4]};
  for (int k = 0; k < 6; ++k) {
    EXPECT_NEAR(third.particles.deviator[k][0], expected[k], 1e-13 * 5e9);
  }
  const double length = std::sqrt(0.04 + 0.49 + 0.47);
  const std::array<double, 3> axis = {0.2 / length, 0.7 / length, std::sqrt(0.47) / length};
  const Points<3> any = turned<3>(2.1, 7, axis, start, materials);
  const SymmetricTensor<3> found = tensor_of<3>(any.particles.deviator);
  EXPECT_NEAR(contract<3>(found, found), contract<3>(s, s), 1e-13 * contract<3>(s, s));
  EXPECT_NEAR(found[0] + found[1] + found[2], 0.0, 1e-13 * 5e9);
  EXPECT_GT(std::abs(found[0] - s[0]), 1e8);
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

/// The same motion seen in a mirror x -> -x gives the same bits.
template <int Dim>
void mirrored_bits() {
  MaterialParameters m = aluminium;
  m.kinematic_share = 0.3;
  const std::vector<Material> materials = {make_material(m)};
  reference::Random random{3};
  Points<Dim> points = random_points<Dim>(37, materials, true, false, 0.02, dt, random);
  Points<Dim> image = points;
  // The components with one x: xy, and zx in space.
  const auto flip = [](std::vector<double>& column) {
    for (double& x : column) x = -x;
  };
  const auto flip_tensor = [&](auto& columns) {
    flip(columns[3]);
    if constexpr (Dim == 3) flip(columns[5]);
  };
  const auto reflect = [&](Points<Dim>& q) {
    flip(q.particles.velocity[0]);
    flip_tensor(q.particles.deviator);
    flip_tensor(q.particles.back_stress);
  };
  reflect(image);
  for (int k = 1; k < Dim; ++k) {
    flip(image.step.gradient[k]);
    flip(image.step.gradient[k * Dim]);
  }
  flip(image.step.rate[Dim]);
  if constexpr (Dim == 3) flip(image.step.rate[5]);
  const StressReport report =
      update<Dim>(materials, settings_of<Dim>(Thermal::conserving), dt, points);
  const StressReport seen =
      update<Dim>(materials, settings_of<Dim>(Thermal::conserving), dt, image);
  reflect(image);
  for (std::size_t i = 0; i < 37; ++i) {
    EXPECT_EQ(bits_of<Dim>(image.particles, i), bits_of<Dim>(points.particles, i)) << i;
  }
  EXPECT_EQ(report.dt_limit, seen.dt_limit);
}

TEST(Mirror, SameBits) {
  mirrored_bits<2>();
  mirrored_bits<3>();
}

}  // namespace
