// Tension and failure of single particles: the law of expansion, the cut at the spall strength, and
// the temperature of what has opened.

#include "physics/particle_states.hpp"

namespace poreshock::test {
namespace {

constexpr double dt = 1e-9;

/// Stretches all axes alike by `dilatation` (1/s) for some steps, without viscosity.
template <int Dim>
void stretch(const std::vector<Material>& materials, Thermal thermal, double dilatation, int steps,
             Points<Dim>& points, double cell = 10e-6) {
  std::array<double, Dim * Dim> gradient{};
  for (int a = 0; a < Dim; ++a) gradient[a * (Dim + 1)] = dilatation / Dim;
  for (std::size_t p = 0; p < points.particles.size(); ++p) {
    set_motion<Dim>(gradient, gradient, p, points.step);
  }
  StressSettings<Dim> settings = settings_of<Dim>(thermal);
  settings.viscosity = {0.0, 0.0};
  settings.cell = cell;
  for (int n = 0; n < steps; ++n) update<Dim>(materials, settings, dt, points);
}

MaterialParameters spalling(double strength) {
  MaterialParameters m = reference::aluminium();
  m.spall = strength;
  return m;
}

/// One that fails as soon as it opens.
Material brittle(const MaterialParameters& parameters) {
  Material m = make_material(parameters);
  m.opened_tension = m.spall;
  return m;
}

template <int Dim>
Points<Dim> at_rest_and_sound(const MaterialParameters& m) {
  Points<Dim> points = at_rest<Dim>(m);
  points.particles.options.failed = true;
  resize(points.particles, 1);
  return points;
}

TEST(Tension, IsLinearInTheVolume) {
  // Without dissipation the material stays on the isentrope through its initial state: P = K eta,
  // E = K V0 eta^2/2 and T = T0 (V0/V)^gamma in both modes, K = rho0 c0^2.
  MaterialParameters fluid = reference::aluminium();
  fluid.young = fluid.yield = fluid.hardening = 0.0;
  const std::vector<Material> materials = {make_material(fluid)};
  const double bulk = 2700.0 * 5350.0 * 5350.0;
  for (const Thermal thermal : {Thermal::paper, Thermal::conserving}) {
    Points<3> points = at_rest<3>(fluid);
    stretch(materials, thermal, 1e5, 1000, points);
    const Particles<3>& p = points.particles;
    const double eta = 1.0 - 2700.0 / p.density[0];
    EXPECT_NEAR(eta, -std::expm1(0.1), 1e-4);
    // The step of the energy is of first order: work with the pressure of its start.
    EXPECT_NEAR(p.internal_energy[0] / (0.5 * bulk * eta * eta / 2700.0), 1.0, 2e-3);
    EXPECT_NEAR(p.pressure[0] / (bulk * eta), 1.0, thermal == Thermal::paper ? 1e-12 : 2e-3);
    const ThermalState state{p.density[0], p.internal_energy[0]};
    EXPECT_NEAR(temperature(materials[0], thermal, state), 300.0 * std::pow(1.0 - eta, -2.0),
                thermal == Thermal::paper ? 1e-6 : 0.5);
  }
}

template <int Dim>
void fails_once_and_for_good(Thermal thermal) {
  const std::vector<Material> materials = {brittle(spalling(1e9))};
  Points<Dim> points = at_rest_and_sound<Dim>(spalling(1e9));
  Particles<Dim>& p = points.particles;
  // -1 GPa lie at eta = -0.013 or so.
  stretch(materials, thermal, 1e6, 12, points);
  EXPECT_EQ(p.failed[0], 0);
  EXPECT_NEAR(p.pressure[0], -0.93e9, 0.03e9);
  stretch(materials, thermal, 1e6, 3, points);
  EXPECT_EQ(p.failed[0], 1);
  EXPECT_EQ(p.pressure[0], 0.0);
  EXPECT_EQ(von_mises(p), 0.0);
  // It opens without work, and closes where it had opened.
  const double energy = p.internal_energy[0], strain = p.plastic_strain[0];
  stretch(materials, thermal, 1e6, 50, points);
  EXPECT_EQ(p.pressure[0], 0.0);
  EXPECT_EQ(p.internal_energy[0], energy);
  EXPECT_EQ(p.plastic_strain[0], strain);
  stretch(materials, thermal, -1e6, 60, points);
  EXPECT_EQ(p.pressure[0], 0.0);
  EXPECT_EQ(p.internal_energy[0], energy);
  stretch(materials, thermal, -1e6, 25, points);
  EXPECT_GT(p.pressure[0], 1e9);
  EXPECT_EQ(p.failed[0], 1);
  EXPECT_EQ(von_mises(p), 0.0);
}

TEST(Spall, FailsOnceAndForGood) {
  for (const Thermal thermal : {Thermal::paper, Thermal::conserving}) {
    fails_once_and_for_good<2>(thermal);
    fails_once_and_for_good<3>(thermal);
  }
}

TEST(Spall, ElasticEnergyStaysAsHeat) {
  // Sheared elastically, then opened: the energy of the shear is in the temperature afterwards.
  MaterialParameters strong = spalling(1e9);
  strong.yield = 5e9;
  const std::vector<Material> materials = {brittle(strong)};
  Points<2> sheared = at_rest_and_sound<2>(strong), plain = sheared;
  for (int k = 0; k < 4; ++k) sheared.particles.deviator[k][0] = 0.0;
  const double shear_stress = 2e9, shear = 69e9 / 2.66;
  sheared.particles.deviator[3][0] = shear_stress;
  const double stored = shear_stress * shear_stress / (2.0 * shear * 2700.0);
  sheared.particles.internal_energy[0] = stored;
  for (Points<2>* points : {&sheared, &plain}) {
    stretch(materials, Thermal::conserving, 1e6, 14, *points);
    EXPECT_EQ(points->particles.failed[0], 1);
  }
  const auto T = [&](const Points<2>& points) {
    const Particles<2>& p = points.particles;
    return temperature(materials[0], Thermal::conserving,
                       {p.density[0], p.internal_energy[0], 0.0, 0.0, 0.0, 0.0, true});
  };
  EXPECT_GT(stored / 880.0, 30.0);
  EXPECT_NEAR(T(sheared) - T(plain), stored / 880.0, 0.05 * stored / 880.0);
}

/// Volume at which a solid of this energy bears no pressure.
double unloaded_volume(const reference::Solid& m, double energy) {
  return reference::first_root([&](double v) { return reference::pressure(m, v, energy); },
                               0.999 * m.volume(), 1.5 * m.volume());
}

TEST(Spall, OpenedParticleHasTheTemperatureOfItsSolid) {
  const MaterialParameters m = spalling(1e9);
  const Material material = make_material(m);
  const reference::Solid solid = reference::solid(m);
  for (const double energy : {1e3, 5e4, 4e5}) {
    const double expected = reference::temperature(solid, unloaded_volume(solid, energy), energy);
    ThermalState state;
    state.internal_energy = energy;
    state.failed = true;
    for (const double volume : {1.2, 2.0, 30.0}) {
      state.density = 2700.0 / volume;
      EXPECT_NEAR(temperature(material, Thermal::conserving, state), expected, 1e-6);
    }
    // Under pressure it is as any other.
    state.density = 2900.0;
    ThermalState sound = state;
    sound.failed = false;
    EXPECT_EQ(temperature(material, Thermal::conserving, state),
              temperature(material, Thermal::conserving, sound));
  }
  // Paper: K eta + gamma rho W = 0.
  ThermalState state;
  state.plastic_work = 1e5;
  state.density = 1000.0;
  state.failed = true;
  const double g = 2.0 * 2700.0 * 1e5 / solid.bulk();
  const double eta = 0.5 * (1.0 - std::sqrt(1.0 + 4.0 * g));
  EXPECT_NEAR(eta * (1.0 - eta) + g, 0.0, 1e-15);
  EXPECT_NEAR(temperature(material, Thermal::paper, state),
              300.0 * std::pow(1.0 - eta, -2.0) + 1e5 / 880.0, 1e-6);
}

template <int Dim>
void opens_and_fails(Thermal thermal) {
  MaterialParameters m = spalling(1e9);
  m.young = m.yield = m.hardening = 0.0;
  const std::vector<Material> materials = {make_material(m)};
  const reference::Solid solid = reference::fluid_of(reference::solid(m));
  Points<Dim> points = at_rest_and_sound<Dim>(m);
  Particles<Dim>& p = points.particles;
  const auto T = [&] {
    return temperature(materials[0], thermal, {p.density[0], p.internal_energy[0]});
  };
  // The solid bears 1 GPa at a volume 1 + S/K; then 15 % more open at this tension.
  stretch(materials, thermal, 1e5, 600, points, 1.0);
  EXPECT_EQ(p.failed[0], 0);
  EXPECT_EQ(p.pressure[0], -1e9);
  const double opened = 2700.0 / p.density[0] - 1.0 - 1e9 / solid.bulk();
  EXPECT_NEAR(opened, std::expm1(0.06) - 0.013, 1e-3);
  // Work of the solid, then of what opens.
  const double work = (0.5 * 1e9 * 1e9 / solid.bulk() + 1e9 * opened) / 2700.0;
  EXPECT_NEAR(p.internal_energy[0] / work, 1.0, 2e-3);
  const double closed = reference::first_root(
      [&](double v) { return reference::pressure(solid, v, p.internal_energy[0]) + 1e9; },
      0.999 * solid.volume(), 1.5 * solid.volume());
  EXPECT_NEAR(T(),
              thermal == Thermal::conserving
                  ? reference::temperature(solid, closed, p.internal_energy[0])
                  : 300.0 * std::pow(1.0 + 1e9 / solid.bulk(), -2.0),
              thermal == Thermal::conserving ? 1e-6 : 0.5);
  // It closes at the tension at which it opened, and is then what it was.
  stretch(materials, thermal, -1e5, 600, points, 1.0);
  EXPECT_EQ(p.failed[0], 0);
  EXPECT_NEAR(p.pressure[0], 0.0, 2e-3 * 1e9);
  EXPECT_NEAR(p.internal_energy[0] / work, 0.0, 2e-3);
  stretch(materials, thermal, 1e5, 1370, points, 1.0);
  EXPECT_EQ(p.failed[0], 0);
  EXPECT_EQ(p.pressure[0], -1e9);
  stretch(materials, thermal, 1e5, 180, points, 1.0);
  EXPECT_EQ(p.failed[0], 1);
  EXPECT_EQ(p.pressure[0], 0.0);
}

/// Steps that a particle opens at its strength before it fails.
int steps_held(const MaterialParameters& m, double cell) {
  const std::vector<Material> materials = {make_material(m)};
  Points<2> points = at_rest_and_sound<2>(m);
  const Particles<2>& p = points.particles;
  int opening = 0;
  for (int steps = 0; steps < 600 && p.failed[0] <= 0; ++steps) {
    opening += p.failed[0] < 0 ? 1 : 0;
    stretch(materials, Thermal::conserving, 1e5, 1, points, cell);
  }
  EXPECT_EQ(p.failed[0], 1);
  return opening;
}

TEST(Spall, FailsWhenSoundHasCrossed32Cells) {
  // A step crosses 0.535 cells: the strength is reached in step 130 or so, and 60 more it opens.
  EXPECT_EQ(steps_held(spalling(1e9), 10e-6), 59);
}

TEST(Spall, FailsAfterTheTimeOfItsMaterialWhateverTheCells) {
  MaterialParameters m = spalling(1e9);
  m.spall_time = 200.5 * dt;
  for (const double cell : {0.1e-6, 10e-6, 1.0}) EXPECT_EQ(steps_held(m, cell), 200);
}

TEST(Spall, OpensAtItsStrengthAndFailsWhenAShareIsOpen) {
  for (const Thermal thermal : {Thermal::paper, Thermal::conserving}) {
    opens_and_fails<2>(thermal);
    opens_and_fails<3>(thermal);
  }
}

TEST(Spall, OtherMaterialsOfTheSceneHold) {
  const std::vector<Material> materials = {brittle(spalling(1e9)),
                                           make_material(reference::aluminium())};
  Points<2> points(2, false);
  points.particles.options.failed = true;
  resize(points.particles, 2);
  points.particles.density = {2700.0, 2700.0};
  points.particles.material = {0, 1};
  stretch(materials, Thermal::conserving, 1e6, 30, points);
  EXPECT_EQ(points.particles.failed, (std::vector<std::int32_t>{1, 0}));
  EXPECT_LT(points.particles.pressure[1], -2e9);
}

}  // namespace
}  // namespace poreshock::test
