// Generalized vortex (Kamojjala, Brannon, Sadeghirad & Guilkey, Engineering with Computers 31
// (2015) 193): a ring of 0.75 <= R <= 1.25 turns by alpha(R, t) = A sin(omega t) h(R) under the
// body force that this motion needs. The elastic law of the program, the rotation of each step by
// the polar factor of its deformation, is the Jaumann rate as the step goes to zero.

#include <numeric>

#include "verification/states.hpp"

namespace poreshock::test {
namespace {

constexpr double omega = 3.14159265358979323846;
constexpr double density = 1000.0;
constexpr double shear = 1000.0 / 2.6;  // Young's modulus 1000 Pa, Poisson's ratio 0.3
constexpr double centre = 1.5;

std::string vortex_text() {
  return R"(
[domain]
size = [3.0, 3.0]
cell = 0.0625
[boundary]
low = "free"
[[material]]
name = "unit solid"
density = 1000
young = 1000
poisson = 0.3
yield = 1e30
c0 = 0.912870929175277
lambda = 1.0
gamma = 0.0
cv = 1.0
[[body]]
shape = "ring"
center = [1.5, 1.5]
inner = 0.5
outer = 1.45
[viscosity]
linear = 0.0
quadratic = 0.0
[time]
end = 10.0
sleep = false
[output]
beat = 1.0
)";
}

/// The motion, its velocity and the body force at angles and radii about the centre.
struct Vortex {
  double amplitude;

  static double profile(double R) {
    const double s = R - 1.0;
    return s * s < 0.0625 ? 1.0 - 32.0 * s * s + 256.0 * s * s * s * s : 0.0;
  }
  static double slope(double R) {
    const double s = R - 1.0;
    return s * s < 0.0625 ? -64.0 * s + 1024.0 * s * s * s : 0.0;
  }
  static double curvature(double R) {
    const double s = R - 1.0;
    return s * s < 0.0625 ? -64.0 + 3072.0 * s * s : 0.0;
  }
  double angle(double R, double t) const { return amplitude * std::sin(omega * t) * profile(R); }
  /// Radial and tangential body force per mass, m/s^2; Jaumann stresses
  /// s_tt = -s_rr = G (1 - cos kappa), s_rt = G sin kappa of the simple shear kappa = R dalpha/dR.
  Plane body_force(double R, double t) const {
    const double swing = amplitude * std::sin(omega * t);
    const double rate = amplitude * omega * std::cos(omega * t) * profile(R);
    const double acceleration = -omega * omega * swing * profile(R);
    const double kappa = R * swing * slope(R);
    const double kappa_slope = swing * (slope(R) + R * curvature(R));
    const double g = shear / density;
    const double radial = -std::sin(kappa) * kappa_slope - 2.0 * (1.0 - std::cos(kappa)) / R;
    const double tangential = std::cos(kappa) * kappa_slope + 2.0 * std::sin(kappa) / R;
    return {-R * rate * rate - g * radial, R * acceleration - g * tangential};
  }
};

struct Polar {
  double radius, angle;
};

Polar polar(const Plane& x) {
  const double dx = x[0] - centre, dy = x[1] - centre;
  return {std::sqrt(dx * dx + dy * dy), std::atan2(dy, dx)};
}

/// Initial velocity (at time t, positions undeformed) with its gradient: f e_theta.
Motion turning(const Vortex& vortex, const Plane& X, double t) {
  const auto [R, theta] = polar(X);
  const double rate = vortex.amplitude * omega * std::cos(omega * t);
  const double f = rate * R * Vortex::profile(R);
  const double df = rate * (Vortex::profile(R) + R * Vortex::slope(R));
  const double c = std::cos(theta), s = std::sin(theta);
  const double at = theta + vortex.angle(R, t);
  // f' e_theta e_r - (f / R) e_r e_theta
  return {{-f * std::sin(at), f * std::cos(at)},
          {-df * s * c + f / R * c * s, -df * s * s - f / R * c * c, df * c * c + f / R * s * s,
           df * c * s - f / R * s * c}};
}

/// One step under the body force, taken by the particles before they give their momentum away.
void driven_step(const Vortex& vortex, double dt, Simulation<2>& sim) {
  Particles<2>& q = sim.particles;
  for (std::size_t p = 0; p < q.size(); ++p) {
    const auto [r, theta] = polar(position(sim, p));
    const Plane b = vortex.body_force(r, sim.clock.time);
    const double c = std::cos(theta), s = std::sin(theta);
    q.velocity[0][p] += dt * (b[0] * c - b[1] * s);
    q.velocity[1][p] += dt * (b[0] * s + b[1] * c);
  }
  step_by(dt, sim);
}

struct Displacement {
  double error;      ///< root mean square, relative to the exact one's at the peak
  double amplitude;  ///< share of the exact displacement that is there
};

Displacement displacement(const Vortex& vortex, const Simulation<2>& sim) {
  double square = 0.0, scale = 0.0, product = 0.0, exact2 = 0.0;
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    const Plane X = site(sim, p), x = position(sim, p);
    const auto [R, theta] = polar(X);
    const double at = theta + vortex.angle(R, sim.clock.time);
    const Plane exact = {centre + R * std::cos(at), centre + R * std::sin(at)};
    const double largest = R * vortex.amplitude * Vortex::profile(R);
    scale += largest * largest;
    for (int a = 0; a < 2; ++a) {
      square += (x[a] - exact[a]) * (x[a] - exact[a]);
      product += (x[a] - X[a]) * (exact[a] - X[a]);
      exact2 += (exact[a] - X[a]) * (exact[a] - X[a]);
    }
  }
  return {std::sqrt(square / scale), product / exact2};
}

struct Swing {
  Displacement peak, back;
};

/// From rest position over the peak (t = 1/2) and back (t = 1).
Swing run_vortex(double amplitude, int cells, const std::vector<std::string>& overrides) {
  std::vector<std::string> all = overrides;
  all.push_back("domain.cell=" + digits(3.0 / cells));
  Simulation<2> sim = start<2>(plain_scene_of(vortex_text(), all), MPI_COMM_SELF);
  const Vortex vortex{amplitude};
  const double c = longitudinal_sound_speed(sim.materials[0]);
  const auto half = static_cast<std::int64_t>(
      std::ceil(0.5 / (0.3 * 3.0 / cells / (c + 1.2 * amplitude * omega))));
  const double dt = 0.5 / static_cast<double>(half);
  set_motion([&](const Plane& X) { return turning(vortex, X, -0.5 * dt); }, sim);
  Swing swing{};
  for (std::int64_t k = 0; k < half; ++k) driven_step(vortex, dt, sim);
  swing.peak = displacement(vortex, sim);
  for (std::int64_t k = 0; k < half; ++k) driven_step(vortex, dt, sim);
  swing.back = displacement(vortex, sim);
  EXPECT_EQ(sim.clock.bad, 0);
  return swing;
}

/// `known` is what the error after the return is known to come to, 0 where it meets its bar.
void converge(const std::string& name, double amplitude, const std::vector<std::string>& overrides,
              double known = 0.0) {
  std::vector<Swing> swings;
  for (const int cells : {40, 80, 160}) swings.push_back(run_vortex(amplitude, cells, overrides));
  for (std::size_t i = 0; i + 1 < swings.size(); ++i) {
    const std::string suffix = i == 0 ? "_40_80" : "_80_160";
    record(name, "peak_displacement_order" + suffix,
           order(swings[i].peak.error, swings[i + 1].peak.error));
    record(name, "return_displacement_order" + suffix,
           order(swings[i].back.error, swings[i + 1].back.error));
  }
  // The ring is only seven cells wide at 40: the order is that over both refinements.
  verify_at_least(name, "peak_displacement_order",
                  0.5 * order(swings[0].peak.error, swings[2].peak.error), 1.5);
  verify_at_least(name, "return_displacement_order",
                  0.5 * order(swings[0].back.error, swings[2].back.error), 1.5);
  verify_at_most(name, "peak_displacement_error_160", swings.back().peak.error, 0.02);
  if (known > 0.0) {
    verify_known_shortfall(name, "return_displacement_error_160", swings.back().back.error, 0.02,
                           known);
  } else {
    verify_at_most(name, "return_displacement_error_160", swings.back().back.error, 0.02);
  }
  verify_relative(name, "peak_amplitude_160", swings.back().peak.amplitude, 1.0, 0.01);
}

TEST(Vortex, BodyForceOfTheJaumannRateHasItsPublishedValues) {
  // R = 1.1, t = 0.3, A = 0.5; six digits of G / rho = 0.384615 lie behind these numbers.
  const Plane b = Vortex{0.5}.body_force(1.1, 0.3);
  EXPECT_NEAR(b[0], 5.194297, 1e-5);
  EXPECT_NEAR(b[1], -7.403847, 1e-5);
}

TEST(Vortex, OneParticleInSimpleShearFollowsTheJaumannRate) {
  Simulation<2> sim = start<2>(plain_scene_of(vortex_text()), MPI_COMM_SELF);
  const int steps = 4000;
  const double rate = 1.0, dt = 2.0 / steps;
  StepData<2>& step = sim.step_data;
  resize_ordered(sim.particles.size(), step);
  std::vector<std::uint32_t> places(sim.particles.size());
  std::iota(places.begin(), places.end(), 0U);
  for (auto& column : step.gradient) std::fill(column.begin(), column.end(), 0.0);
  for (auto& column : step.rate) std::fill(column.begin(), column.end(), 0.0);
  std::fill(step.heat.begin(), step.heat.end(), 0.0);
  std::fill(step.gradient[1].begin(), step.gradient[1].end(), rate);
  std::fill(step.rate[2].begin(), step.rate[2].end(), 0.5 * rate);
  double error = 0.0, objective = 0.0;
  for (int k = 1; k <= steps; ++k) {
    StressReport report;
    update_stress(sim.materials, stress_settings(sim), step, dt, places, sim.particles, report);
    const double kappa = rate * dt * k;
    const double xx = sim.particles.deviator[0][0] / shear;
    const double xy = sim.particles.deviator[3][0] / shear;
    error = std::max({error, std::abs(xx - (1.0 - std::cos(kappa))),
                      std::abs(sim.particles.deviator[1][0] / shear + (1.0 - std::cos(kappa))),
                      std::abs(xy - std::sin(kappa))});
    // What the logarithmic strain of a hyperelastic solid would give.
    const double q = std::asinh(0.5 * kappa) / std::sqrt(kappa * kappa + 4.0);
    objective = std::max(objective, std::abs(xy - 4.0 * q));
  }
  verify_at_most("vortex_one_particle", "jaumann_stress_error", error, 1e-6);
  verify_at_least("vortex_one_particle", "distance_from_hencky", objective, 0.05);
}

TEST(Vortex, CubicApicConvergesAtSmallAmplitude) {
  converge("vortex_cubic_apic_0.05", 0.05, {});
}

TEST(Vortex, CubicApicConvergesAtLargeAmplitude) {
  converge("vortex_cubic_apic_0.2", 0.2, {});
}

TEST(Vortex, AflipConvergesAtSmallAmplitude) {
  converge("vortex_aflip_0.05", 0.05, default_scheme());
}

TEST(Vortex, AflipConvergesAtLargeAmplitude) {
  converge("vortex_aflip_0.2", 0.2, default_scheme(), 0.06);
}

TEST(Vortex, CubicFlipConverges) {
  converge("vortex_cubic_flip_0.05", 0.05, {"transfer.velocity=flip"});
}

}  // namespace
}  // namespace poreshock::test
