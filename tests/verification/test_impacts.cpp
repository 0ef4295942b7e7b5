// Plate impacts with published or exact states behind elastic and plastic fronts.

#include <algorithm>

#include "support/aluminium.hpp"
#include "support/reference_shock.hpp"
#include "verification/states.hpp"

namespace poreshock::test {
namespace {

/// Mean over one layer of particles.
struct Layer {
  double y = 0.0, stress = 0.0, pressure = 0.0, density = 0.0, temperature = 0.0;
};

/// Layers from below to above.
std::vector<Layer> profile(const Simulation<2>& sim) {
  const std::int64_t width =
      std::int64_t{sim.scene.domain.cells[0]} * sim.scene.sample.particles_per_cell;
  std::vector<double> T;
  derive_field<2>("temperature", sim.particles, sim.materials, sim.scene.thermal, T);
  std::int64_t first = sim.particles.id[0], last = first;
  for (const std::int64_t id : sim.particles.id) {
    first = std::min(first, id);
    last = std::max(last, id);
  }
  std::vector<Layer> layers(static_cast<std::size_t>(last / width - first / width + 1));
  const double share = 1.0 / static_cast<double>(width);
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    Layer& layer = layers[static_cast<std::size_t>(sim.particles.id[p] / width - first / width)];
    layer.y += share * sim.particles.position[1][p];
    layer.stress += share * (sim.particles.pressure[p] - sim.particles.deviator[1][p]);
    layer.pressure += share * sim.particles.pressure[p];
    layer.density += share * sim.particles.density[p];
    layer.temperature += share * T[p];
  }
  return layers;
}

/// Highest place where the stress reaches `level`, m.
double front(const std::vector<Layer>& layers, double level) {
  std::size_t k = layers.size() - 1;
  while (k > 0 && layers[k].stress < level) --k;
  const Layer& a = layers[k];
  const Layer& b = layers[std::min(k + 1, layers.size() - 1)];
  return a.y + (b.y - a.y) * (a.stress - level) / (a.stress - b.stress);
}

/// Mean of the layers between two heights.
Layer mean_between(const std::vector<Layer>& layers, double low, double high) {
  Layer mean;
  double count = 0.0;
  for (const Layer& l : layers) {
    if (l.y < low || l.y > high) continue;
    count += 1.0;
    mean.stress += l.stress;
    mean.pressure += l.pressure;
    mean.density += l.density;
    mean.temperature += l.temperature;
  }
  for (double* x : {&mean.stress, &mean.pressure, &mean.density, &mean.temperature}) *x /= count;
  return mean;
}

/// What is exact behind the two fronts; velocities where the material ahead is at rest.
struct TwoWaves {
  double precursor_speed, precursor_stress, front_speed;
  double stress, pressure, density, temperature;
};

TwoWaves two_waves(const reference::Solid& solid, double up) {
  const reference::Piston p = reference::piston(solid, up);
  return {p.precursor.front,  p.precursor.stress,  p.shocked.front,      p.shocked.stress,
          p.shocked.pressure, p.shocked.density(), p.shocked.temperature};
}

struct Fronts {
  double time, elastic, plastic;
};

Fronts fronts(const Simulation<2>& sim, const TwoWaves& exact) {
  const auto layers = profile(sim);
  return {sim.clock.time, front(layers, 0.5 * exact.precursor_stress),
          front(layers, 0.5 * (exact.precursor_stress + exact.stress))};
}

/// Verifies the speeds between two times and the plateau between shares 1/4 and 3/4 of the way from
/// `origin` (the driven surface) to the plastic front. `ahead` is the velocity of the undisturbed
/// material. Returns the plateau.
Layer verify_two_waves(const std::string& name, const TwoWaves& exact, const Fronts& early,
                       double ahead, double origin, const Simulation<2>& sim) {
  const Fronts late = fronts(sim, exact);
  const double dt = late.time - early.time;
  const auto layers = profile(sim);
  const double reach = late.plastic - origin;
  const Layer found = mean_between(layers, origin + 0.25 * reach, origin + 0.75 * reach);
  verify_relative(name, "stress", found.stress, exact.stress, 0.005);
  verify_relative(name, "pressure", found.pressure, exact.pressure, 0.005);
  verify_relative(name, "density", found.density, exact.density, 0.001);
  verify_relative(name, "plastic_front_speed", (late.plastic - early.plastic) / dt - ahead,
                  exact.front_speed, 0.01);
  verify_relative(name, "elastic_front_speed", (late.elastic - early.elastic) / dt - ahead,
                  exact.precursor_speed, 0.01);
  return found;
}

// --- copper piston ---------------------------------------------------------------------------

reference::Solid copper() {
  return {8930.0, 3940.0, 1.49, 2.0, 385.0, 300.0, 45e9, 90e6, 0.0, 0.0};
}

TEST(CopperPiston, ReferenceHasThePublishedNumbers) {
  // They count the elastic energy of the deviator in the equation of state, which adds
  // Y^2 / (3 G) = 60 kPa to the pressure.
  reference::Solid as_published = copper();
  as_published.elastic_energy_heats = true;
  const TwoWaves exact = two_waves(as_published, 20.0);
  EXPECT_NEAR(exact.precursor_speed, 4722.2, 0.1);
  EXPECT_NEAR(exact.precursor_stress, 199.03e6, 0.02e6);
  EXPECT_NEAR(exact.front_speed, 3976.96, 0.05);
  EXPECT_NEAR(exact.density, 8973.453, 0.005);
  EXPECT_NEAR(exact.pressure, 681.59e6, 0.05e6);
  EXPECT_NEAR(exact.stress, 741.59e6, 0.05e6);
}

/// Copper that falls onto a wall at 20 m/s.
std::string copper_scene() {
  return falling_block(R"(
name = "copper"
density = 8930
young = 119.7e9
poisson = 0.33
yield = 90e6
c0 = 3940
lambda = 1.49
gamma = 2.0
cv = 385
)",
                       "20", "350e-9");
}

TEST(CopperPiston, TwoWavesAt20) {
  const TwoWaves exact = two_waves(copper(), 20.0);
  Simulation<2> sim = start<2>(scene_of(copper_scene()), MPI_COMM_SELF);
  advance_to(1000000, 0, sim);
  const Fronts early = fronts(sim, exact);
  sim.scene.time.end = 700e-9;
  advance_to(1000000, 0, sim);
  const Layer found = verify_two_waves("copper_piston", exact, early, -20.0, 0.0, sim);
  verify_relative("copper_piston", "temperature_rise", found.temperature - 300.0,
                  exact.temperature - 300.0, 0.02);
  const auto layers = profile(sim);
  const Fronts late = fronts(sim, exact);
  const double gap = late.elastic - late.plastic;
  const Layer precursor = mean_between(layers, late.plastic + 0.4 * gap, late.plastic + 0.7 * gap);
  verify_relative("copper_piston", "precursor_stress", precursor.stress, exact.precursor_stress,
                  0.05);
}

// --- Wilkins' flyer --------------------------------------------------------------------------

reference::Solid wilkins_aluminium() {
  return {2785.0, 5328.0, 1.338, 2.0, 884.0, 300.0, 27.6e9, 300e6, 0.0, 0.0};
}

TEST(WilkinsFlyer, ReferenceHasThePublishedNumbers) {
  const TwoWaves exact = two_waves(wilkins_aluminium(), 400.0);
  EXPECT_NEAR(exact.precursor_speed, 6484.9, 0.1);
  EXPECT_NEAR(exact.precursor_stress, 634.8e6, 0.1e6);
  EXPECT_NEAR(exact.stress, 6.63602e9, 2e4);
  EXPECT_NEAR(exact.pressure, 6.43602e9, 2e4);
  EXPECT_NEAR(exact.density, 2985.62, 0.01);
  EXPECT_NEAR(exact.temperature, 354.5, 0.1);
  EXPECT_NEAR(exact.front_speed, 5909.2, 0.1);
}

/// Flyer of 5 mm below, target above; free surfaces far from the plateau at the times looked at.
std::string flyer_scene() {
  return R"(
[domain]
size = [50e-6, 12e-3]
cell = 12.5e-6
periodic = true
[boundary]
low = "free"
[[material]]
name = "aluminium 2024"
density = 2785
young = 73.416e9
poisson = 0.33
yield = 300e6
c0 = 5328
lambda = 1.338
gamma = 2.0
cv = 884
[[body]]
shape = "box"
low = [0.0, 1e-3]
high = [50e-6, 6e-3]
velocity = [0.0, 800.0]
[[body]]
shape = "box"
low = [0.0, 6e-3]
high = [50e-6, 11.5e-3]
[time]
end = 400e-9
)";
}

TEST(WilkinsFlyer, PlateauOfTheImpactAt800) {
  const TwoWaves exact = two_waves(wilkins_aluminium(), 400.0);
  Simulation<2> sim = start<2>(scene_of(flyer_scene()), MPI_COMM_SELF);
  advance_to(1000000, 0, sim);
  const Fronts early = fronts(sim, exact);
  sim.scene.time.end = 750e-9;
  advance_to(1000000, 0, sim);
  const Layer found =
      verify_two_waves("wilkins_flyer", exact, early, 0.0, 6e-3 + 400.0 * sim.clock.time, sim);
  // Until the two fronts have parted, the material is heated as by a single one.
  verify_at_most("wilkins_flyer", "temperature_rise_error",
                 (found.temperature - exact.temperature) / (exact.temperature - 300.0), 0.02);
}

// --- the same impact in other frames ---------------------------------------------------------

Layer plateau_at_1100(const std::vector<std::string>& overrides) {
  const std::string text = std::string(R"(
[domain]
size = [80e-6, 2.2e-3]
cell = 20e-6
periodic = true
[boundary]
low = "wall"
[sample]
kind = "solid"
height = 2e-3
[loading]
velocity = 1100
[time]
end = 200e-9
)") + aluminium_text;
  Simulation<2> sim = start<2>(scene_of(text, overrides), MPI_COMM_SELF);
  advance_to(1000000, 0, sim);
  const auto layers = profile(sim);
  const double reach = front(layers, 10e9);
  return mean_between(layers, 0.25 * reach, 0.75 * reach);
}

/// Relative differences from the plateau of the falling plate.
struct FrameError {
  double stress, density, temperature_rise;
};

FrameError frame_error(const std::vector<std::string>& overrides) {
  const Layer falling = plateau_at_1100({});
  const Layer other = plateau_at_1100(overrides);
  return {std::abs(other.stress / falling.stress - 1.0),
          std::abs(other.density / falling.density - 1.0),
          std::abs((other.temperature - 300.0) / (falling.temperature - 300.0) - 1.0)};
}

void verify_same(const std::string& name, const FrameError& error) {
  verify_at_most(name, "stress_error", error.stress, 1e-9);
  verify_at_most(name, "density_error", error.density, 1e-9);
  verify_at_most(name, "temperature_rise_error", error.temperature_rise, 1e-9);
}

TEST(Frames, WallThatMovesUpIntoMaterialAtRest) {
  // The grid rides with the wall, so that not even the phase of the cells differs.
  verify_same("frame_moving_wall",
              frame_error({"loading.velocity=0.0", "boundary.low={kind='wall', velocity=1100.0}"}));
}

TEST(Frames, PlateThatAlsoFliesSideways) {
  const std::string name = "frame_sideways";
  const FrameError error = frame_error({"loading.frame=[1000.0, 0.0]"});
  verify_at_most(name, "stress_error", error.stress, 0.002);
  verify_at_most(name, "density_error", error.density, 0.002);
  verify_at_most(name, "temperature_rise_error", error.temperature_rise, 0.01);
}

TEST(Frames, EverythingMovesUp) {
  verify_same("frame_upwards", frame_error({"loading.frame=[0.0, 1000.0]"}));
}

}  // namespace
}  // namespace poreshock::test
