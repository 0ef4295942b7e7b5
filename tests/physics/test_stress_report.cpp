// Artificial viscosity, the stable step, guards and bad states.

#include <limits>

#include "physics/particle_states.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::test;

constexpr double dt = 1.0e-10;
constexpr double cell = 1.0e-5;
constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();
const MaterialParameters aluminium = reference::aluminium();
const reference::Solid solid = reference::solid(aluminium);
const std::vector<Material> materials = {make_material(aluminium)};

/// Gradient of a particle that closes along y at this rate, 1/s.
std::array<double, 4> closing(double rate) {
  return {0.0, 0.0, 0.0, -rate};
}

double speed_of(const Particles<2>& p) {
  const SymmetricTensor<2> s = tensor_of<2>(p.deviator);
  const double stored = contract<2>(s, s) / (4.0 * solid.shear * p.density[0]);
  return reference::longitudinal_speed(solid, 1.0 / p.density[0], p.internal_energy[0] - stored);
}

// q = rho (s_q C_q (h D)^2 + s_l C_l c_L h |D|) where the particle closes, zero where it opens; s
// are the shares that act.
TEST(Viscosity, Formula) {
  StressSettings<2> settings = settings_of<2>(Thermal::conserving);
  settings.viscosity = {0.7, 1.9, true};
  const double rate = 3.0e7;
  Points<2> point = at_rest<2>(aluminium);
  set_motion<2>(closing(rate), closing(rate), 0, point.step);
  update<2>(materials, settings, dt, point);
  // Rounding in place of a jump shall not decide: below 1e-6 c the linear part fades.
  const double h = cell * rate;
  const double faded = h / (h + 1e-6 * speed_of(point.particles));
  const double expected =
      point.particles.density[0] * (1.9 * h * h + faded * 0.7 * speed_of(point.particles) * h);
  EXPECT_NEAR(point.particles.viscous_pressure[0], expected, 1e-13 * expected);

  for (const auto& [linear, quadratic] :
       {std::pair{0.0, 0.0}, {0.25, 0.0}, {0.0, 0.5}, {0.75, 0.125}}) {
    point = at_rest<2>(aluminium);
    set_motion<2>(closing(rate), closing(rate), 0, point.step);
    point.step.viscous_linear[0] = linear;
    point.step.viscous_quadratic[0] = quadratic;
    update<2>(materials, settings, dt, point);
    const double limited =
        point.particles.density[0] *
        (quadratic * 1.9 * h * h + faded * linear * 0.7 * speed_of(point.particles) * h);
    EXPECT_NEAR(point.particles.viscous_pressure[0], limited, 1e-13 * limited);
  }

  set_motion<2>(closing(-rate), closing(-rate), 0, point.step);
  update<2>(materials, settings, dt, point);
  EXPECT_EQ(point.particles.viscous_pressure[0], 0.0);
}

// The heat of a step is that of the pressure of its start, and rises E by as much.
TEST(Viscosity, HeatIsBookedAndKept) {
  const StressSettings<2> settings = settings_of<2>(Thermal::conserving);
  const double rate = 2.0e7, mid = 1.7e7, q = 3.0e9, mass = 2.5;
  Points<2> with = at_rest<2>(aluminium);
  with.particles.mass[0] = mass;
  set_motion<2>(closing(rate), closing(mid), 0, with.step);
  Points<2> without = with;
  with.particles.viscous_pressure[0] = q;
  const StressReport report = update<2>(materials, settings, dt, with);
  EXPECT_TRUE(update<2>(materials, settings, dt, without).viscous_heat == 0);
  const double heat = dt * q * mid / 2700.0;
  const double found = static_cast<double>(report.viscous_heat) / settings.inverse_energy_quantum;
  EXPECT_NEAR(found, mass * heat, 1e-12 * mass * heat);
  EXPECT_NEAR(with.particles.internal_energy[0] - without.particles.internal_energy[0], heat,
              1e-12 * heat);
  // It opens at mid-step: the viscous pressure gets work back, also booked.
  set_motion<2>(closing(rate), closing(-mid), 0, with.step);
  with.particles = without.particles;
  with.particles.viscous_pressure[0] = q;
  EXPECT_LT(static_cast<double>(update<2>(materials, settings, dt, with).viscous_heat), 0.0);
}

TEST(Heat, EntersTheEnergy) {
  Points<2> warm = at_rest<2>(aluminium), cold = warm;
  warm.step.heat[0] = 1234.0;
  const StressSettings<2> settings = settings_of<2>(Thermal::conserving);
  update<2>(materials, settings, dt, warm);
  update<2>(materials, settings, dt, cold);
  EXPECT_EQ(warm.particles.internal_energy[0], 1234.0);
  EXPECT_EQ(cold.particles.internal_energy[0], 0.0);
  EXPECT_NEAR(warm.particles.pressure[0], 2.0 * 2700.0 * 1234.0, 1e-7);
  EXPECT_EQ(cold.particles.pressure[0], 0.0);
}

TEST(TimeStep, AtRestAndMoving) {
  StressSettings<2> settings = settings_of<2>(Thermal::conserving);
  settings.cfl = 0.4;
  Points<2> point = at_rest<2>(aluminium);
  StressReport report;
  initialise_stress<2>(materials, settings, point.particles, report);
  const double c = std::sqrt((solid.bulk() + 4.0 / 3.0 * solid.shear) / 2700.0);
  EXPECT_NEAR(c, 6436.8, 0.05);
  EXPECT_NEAR(report.dt_limit, 0.4 * cell / c, 1e-15 * cell / c);

  point.particles.velocity[0][0] = -900.0;
  point.particles.velocity[1][0] = 1500.0;
  settings.grid_velocity = {100.0, 800.0};
  initialise_stress<2>(materials, settings, point.particles, report);
  EXPECT_NEAR(report.dt_limit, 0.4 * cell / (c + 1000.0), 1e-15 * cell / c);
  settings.grid_velocity = {-900.0, 1500.0};
  initialise_stress<2>(materials, settings, point.particles, report);
  EXPECT_NEAR(report.dt_limit, 0.4 * cell / c, 1e-15 * cell / c);
}

/// Longitudinal sound speed at rest, m/s.
double resting_speed() {
  return std::sqrt((solid.bulk() + 4.0 / 3.0 * solid.shear) / 2700.0);
}

/// Step of a particle that hardly closes, where `share` of a linear viscosity acts.
template <int Dim>
double lone_step(double stiffness, double linear, double share, double rate) {
  StressSettings<Dim> settings = settings_of<Dim>(Thermal::conserving);
  settings.cfl = 1.5;
  settings.stiffness = stiffness;
  settings.viscosity.linear = linear;
  Points<Dim> point = at_rest<Dim>(aluminium);
  std::array<double, Dim * Dim> gradient{};
  gradient[Dim * Dim - 1] = -rate;
  set_motion<Dim>(gradient, gradient, 0, point.step);
  point.step.viscous_linear[0] = share;
  return update<Dim>(materials, settings, dt, point).dt_limit;
}

// Alone a particle swings with the force of the state before: a step of cell/(r c) is at its limit
// where e/r^2 + 2 v/r = 4, e = Dim stiffness (K + G/3 in the plane, K in space)/(rho c^2) and v =
// Dim stiffness C_l, whichever share of the viscosity acts now.
TEST(TimeStep, OfAParticleAlone) {
  const double K = solid.bulk(), G = solid.shear, c = resting_speed();
  const auto expect_limit = [&](double step, double elastic, double viscous) {
    const double r = cell / (c * step);
    EXPECT_NEAR(elastic / (2700.0 * c * c) / (r * r) + 2.0 * viscous / r, 4.0, 1e-11);
  };
  for (const double linear : {0.0, 0.6, 1.0}) {
    for (const double rate : {0.0, -1e-3, 1e-3}) {
      for (const double share : {0.0, 0.4, 1.0}) {
        expect_limit(lone_step<2>(3.28, linear, share, rate), 2.0 * 3.28 * (K + G / 3.0),
                     2.0 * 3.28 * linear);
        expect_limit(lone_step<3>(8.0, linear, share, rate), 3.0 * 8.0 * K, 3.0 * 8.0 * linear);
      }
    }
  }
  EXPECT_NEAR(lone_step<2>(0.0, 0.6, 1.0, 0.0), 1.5 * cell / c, 1e-13 * cell / c);
}

TEST(TimeStep, ViscosityAndStrain) {
  StressSettings<2> settings = settings_of<2>(Thermal::conserving);
  Points<2> point = at_rest<2>(aluminium);
  const double rate = 5.0e7;
  set_motion<2>(closing(rate), closing(rate), 0, point.step);
  const StressReport shock = update<2>(materials, settings, dt, point);
  const double c = speed_of(point.particles);
  const auto expected = [&](double Q) { return 0.35 * cell / (Q + std::sqrt(Q * Q + c * c)); };
  const double faded = cell * rate / (cell * rate + 1e-6 * c);
  const double all = expected(faded * 0.6 * c + 2.25 * cell * rate);
  EXPECT_NEAR(shock.dt_limit, all, 1e-13 * all);

  // Only what acts costs: nothing of it in smooth flow.
  for (const auto& [linear, quadratic] : {std::pair{0.0, 0.0}, {0.3, 0.8}}) {
    point = at_rest<2>(aluminium);
    set_motion<2>(closing(rate), closing(rate), 0, point.step);
    point.step.viscous_linear[0] = linear;
    point.step.viscous_quadratic[0] = quadratic;
    const double limited = expected(faded * linear * 0.6 * c + quadratic * 2.25 * cell * rate);
    EXPECT_NEAR(update<2>(materials, settings, dt, point).dt_limit, limited, 1e-13 * limited);
  }

  // A strong shear: no step may change velocities across a particle by more than a strain of 0.2.
  Points<2> sheared = at_rest<2>(aluminium);
  set_motion<2>({0.0, -3.0e9, 0.0, 0.0}, {}, 0, sheared.step);
  EXPECT_DOUBLE_EQ(update<2>(materials, settings, dt, sheared).dt_limit, 0.2 / 3.0e9);

  Points<2> none(0, false);
  EXPECT_EQ(update<2>(materials, settings, dt, none).dt_limit,
            std::numeric_limits<double>::infinity());
}

// The smallest limit of all particles counts, wherever the particle is stored.
TEST(TimeStep, SmallestOfAll) {
  const StressSettings<2> settings = settings_of<2>(Thermal::conserving);
  for (const std::size_t fast : {0, 255, 256, 299}) {
    Points<2> points = at_rest<2>(aluminium, 300);
    points.particles.velocity[0][fast] = 5000.0;
    StressReport report;
    initialise_stress<2>(materials, settings, points.particles, report);
    const double c = std::sqrt((solid.bulk() + 4.0 / 3.0 * solid.shear) / 2700.0);
    EXPECT_NEAR(report.dt_limit, 0.35 * cell / (c + 5000.0), 1e-15 * cell / c);
  }
}

TEST(Guards, CompressionBeyondTheGuard) {
  const MieGruneisen& eos = materials[0].eos;
  const std::array<double, 5> eta = {0.0, eos.guard * (1.0 - 1e-12), 0.4, eos.guard * (1.0 + 1e-12),
                                     0.9};
  Points<2> points = at_rest<2>(aluminium, 5);
  for (std::size_t i = 0; i < 5; ++i) {
    points.particles.density[i] = 2700.0 / (1.0 - eta[i]);
    points.particles.internal_energy[i] = reference_point(eos, eta[i]).energy;
  }
  StressReport report;
  initialise_stress<2>(materials, settings_of<2>(Thermal::conserving), points.particles, report);
  EXPECT_EQ(report.compression_guard, 2);
  EXPECT_EQ(report.sound_speed_guard, 0);
  EXPECT_EQ(report.bad, 0);
  // Beyond the guard the reference curve goes on by its tangent.
  const ReferencePoint at_guard = reference_point(eos, eos.guard);
  const double expected = at_guard.pressure + at_guard.pressure_slope * (0.9 - eos.guard);
  EXPECT_NEAR(points.particles.pressure[4], expected, 1e-12 * expected);
}

// So cold that c^2 < 0: the floor 1e-4 c0^2 takes its place in the step, and is counted.
TEST(Guards, SoundSpeedFloor) {
  Points<2> points = at_rest<2>(aluminium, 3);
  points.particles.internal_energy[1] = -2.0e7;
  StressReport report;
  initialise_stress<2>(materials, settings_of<2>(Thermal::conserving), points.particles, report);
  EXPECT_EQ(report.sound_speed_guard, 1);
  EXPECT_EQ(report.bad, 0);
  EXPECT_NEAR(points.particles.pressure[1], -2.0 * 2700.0 * 2.0e7, 1.0);

  Points<2> alone = at_rest<2>(aluminium);
  alone.particles.internal_energy[0] = -2.0e7;
  initialise_stress<2>(materials, settings_of<2>(Thermal::conserving), alone.particles, report);
  const double c = std::sqrt(1e-4 * 5350.0 * 5350.0 + 4.0 / 3.0 * solid.shear / 2700.0);
  EXPECT_NEAR(report.dt_limit, 0.35 * cell / c, 1e-15 * cell / c);
}

/// The report of nine particles of which the middle one was spoilt.
template <class Spoil>
StressReport report_with(const Spoil& spoil) {
  Points<2> points = at_rest<2>(aluminium, 9);
  spoil(points, std::size_t{4});
  return update<2>(materials, settings_of<2>(Thermal::conserving), dt, points);
}

TEST(BadStates, AreCounted) {
  const double infinity = std::numeric_limits<double>::infinity();
  const auto set_rate = [](double l, Points<2>& points, std::size_t i) {
    points.step.gradient[3][i] = l / dt;
  };
  EXPECT_EQ(report_with([](auto&, std::size_t) {}).bad, 0);
  for (const double x : {not_a_number, infinity, -infinity}) {
    EXPECT_EQ(report_with([&](auto& q, std::size_t i) { q.particles.internal_energy[i] = x; }).bad,
              1);
    EXPECT_EQ(report_with([&](auto& q, std::size_t i) { q.step.heat[i] = x; }).bad, 1);
    EXPECT_EQ(report_with([&](auto& q, std::size_t i) { q.step.gradient[1][i] = x; }).bad, 1);
    EXPECT_EQ(report_with([&](auto& q, std::size_t i) { q.step.rate[0][i] = x; }).bad, 1);
  }
  for (const double x : {not_a_number, 0.0}) {
    EXPECT_EQ(report_with([&](auto& q, std::size_t i) { q.particles.density[i] = x; }).bad, 1);
  }
  EXPECT_EQ(
      report_with([](auto& q, std::size_t i) { q.particles.deviator[0][i] = not_a_number; }).bad,
      1);
  // Inverted, and more than halved or doubled in one step.
  for (const double l : {-1.5, -1.0, -0.5001, 1.0001, 3.0}) {
    EXPECT_EQ(report_with([&](auto& q, std::size_t i) { set_rate(l, q, i); }).bad, 1) << l;
  }
  for (const double l : {-0.4999, 0.9999}) {
    EXPECT_EQ(report_with([&](auto& q, std::size_t i) { set_rate(l, q, i); }).bad, 0) << l;
  }
}

// Further than a cell in one step, relative to the grid, in any direction.
TEST(BadStates, TravelBeyondACell) {
  const auto moving = [](int axis, double speed) {
    return report_with(
        [&](auto& q, std::size_t i) { q.particles.velocity[axis][i] = speed * cell / dt; });
  };
  for (const int axis : {0, 1}) {
    EXPECT_EQ(moving(axis, 1.001).bad, 1);
    EXPECT_EQ(moving(axis, -1.001).bad, 1);
    EXPECT_EQ(moving(axis, -0.999).bad, 0);
  }
  StressSettings<2> settings = settings_of<2>(Thermal::conserving);
  settings.grid_velocity = {0.0, -5.0e6};
  Points<2> points = at_rest<2>(aluminium, 9);
  for (double& v : points.particles.velocity[1]) v = -5.0e6;
  EXPECT_EQ(update<2>(materials, settings, dt, points).bad, 0);
}

// A bad particle does not hide the step of the others.
TEST(BadStates, LeaveTheStepOfTheOthers) {
  const StressReport good = report_with([](auto&, std::size_t) {});
  const StressReport bad =
      report_with([](auto& q, std::size_t i) { q.particles.internal_energy[i] = not_a_number; });
  EXPECT_EQ(bad.dt_limit, good.dt_limit);
}

}  // namespace
