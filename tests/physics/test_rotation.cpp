// Rotations turn the stress and change nothing else; mirrors change no bit.

#include "physics/particle_states.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::test;

constexpr double dt = 1.0e-10;
const MaterialParameters aluminium = reference::aluminium();

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
    EXPECT_EQ(update<Dim>(materials, settings_of<Dim>(Thermal::conserving), dt, point).bad, 0);
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
    const double error = 1e-13 * 5e9 + 1e-16 * 5.2e10 * steps;
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

/// The same motion seen in a mirror x -> -x gives the same bits.
template <int Dim>
void mirrored_bits() {
  MaterialParameters m = aluminium;
  m.kinematic_share = 0.3;
  const std::vector<Material> materials = {make_material(m)};
  reference::Random random{3};
  Points<Dim> points = random_points<Dim>(37, materials, true, 0.02, dt, random);
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
