// Plate impact of materials whose flow stress hardens by a power and depends on pressure and
// temperature, against the exact jump conditions with that flow stress.

#include <algorithm>

#include "poreshock/material/library.hpp"
#include "support/aluminium.hpp"
#include "support/reference_shock.hpp"
#include "support/scalar_stress.hpp"
#include "verification/states.hpp"

namespace poreshock::test {
namespace {

constexpr double velocity = 1000.0;  // of the impact, m/s: one front, faster than elastic waves

MaterialParameters copper(StrengthModel model) {
  MaterialParameters m = library_material("copper")->parameters;
  m.strength = model;
  m.johnson_cook.rate = 0.0;  // behind the front the rate falls to zero for ever
  return m;
}

/// Flow stress where the plastic strain, the pressure and the energy without the elastic part of
/// the deviator are known; v is the specific volume.
double flow_stress_at(const MaterialParameters& m, double strain, double pressure, double v,
                      double energy) {
  const double T = reference::temperature(reference::solid(m), v, energy);
  return m.strength == StrengthModel::johnson_cook
             ? reference::johnson_cook(m.johnson_cook, T)(strain, 0.0)
             : reference::steinberg_guinan(m.steinberg_guinan, pressure, 1.0 / (m.density * v), T)(
                   strain, 0.0);
}

/// State behind one jump from rest to volume v: the flow stress by iteration.
reference::State behind_jump(const MaterialParameters& m, double v) {
  const reference::Solid solid = reference::solid(m);
  reference::State s;
  s.flow_stress = 1e8;
  for (int k = 0; k < 30; ++k) {
    s = reference::jump_to(solid, reference::at_rest(solid), v, s.flow_stress);
    s.flow_stress = flow_stress_at(m, s.plastic_strain, s.pressure, v, s.energy);
  }
  s.temperature = reference::temperature(solid, v, s.energy);
  return s;
}

reference::State exact_state(const MaterialParameters& m) {
  const double v0 = 1.0 / m.density;
  return behind_jump(
      m, reference::first_root([&](double v) { return behind_jump(m, v).velocity - velocity; },
                               v0 * (1.0 - 1e-3), v0 * 0.6, 20));
}

std::string plate(const std::string& strength) {
  const char* constant = strength == "johnson_cook" ? "johnson_cook = { rate = 0 }\n" : "";
  return falling_block("name = \"copper\"\nstrength = \"" + strength + "\"\n" + constant, "1000",
                       "600e-9");
}

struct Means {
  double stress = 0.0, density = 0.0, temperature = 0.0, plastic_strain = 0.0, largest = 0.0;
};

/// Means over the middle half of the shocked length, and the largest von Mises stress there.
Means plateau(const Simulation<2>& sim, double front) {
  std::vector<double> T;
  derive_field<2>("temperature", sim.particles, sim.materials, sim.scene.thermal, T);
  Means mean;
  double count = 0.0;
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    const double y = sim.particles.position[1][p];
    if (y < 0.25 * front || y > 0.75 * front) continue;
    count += 1.0;
    mean.stress += sim.particles.pressure[p] - sim.particles.deviator[1][p];
    mean.density += sim.particles.density[p];
    mean.temperature += T[p];
    mean.plastic_strain += sim.particles.plastic_strain[p];
    mean.largest = std::max(mean.largest, von_mises(sim.particles, p));
  }
  for (double* x : {&mean.stress, &mean.density, &mean.temperature, &mean.plastic_strain})
    *x /= count;
  return mean;
}

void verify_plate(const std::string& strength, StrengthModel model) {
  const reference::State exact = exact_state(copper(model));
  Simulation<2> sim = start<2>(plain_scene_of(plate(strength)), MPI_COMM_WORLD);
  const double total = stock(sim).total;
  advance_to(1000000, 0, sim);
  const Means found = plateau(sim, (exact.front - velocity) * sim.clock.time);
  const std::string name = "copper_" + strength;
  EXPECT_GT(exact.front, 4750.0);  // no elastic precursor runs ahead
  verify_relative(name, "stress", found.stress, exact.stress, 0.003);
  verify_relative(name, "density", found.density, exact.density(), 0.001);
  verify_relative(name, "temperature_rise", found.temperature - 300.0, exact.temperature - 300.0,
                  0.01);
  verify_relative(name, "plastic_strain", found.plastic_strain, exact.plastic_strain, 0.02);
  verify_relative(name, "largest_von_mises", found.largest, exact.flow_stress, 0.02);
  verify_at_most(name, "energy_drift", std::abs(stock(sim).total / total - 1.0), 1e-12);
}

TEST(CopperPlate, SteinbergGuinan) {
  verify_plate("steinberg_guinan", StrengthModel::steinberg_guinan);
}

TEST(CopperPlate, JohnsonCook) {
  verify_plate("johnson_cook", StrengthModel::johnson_cook);
}

}  // namespace
}  // namespace poreshock::test
