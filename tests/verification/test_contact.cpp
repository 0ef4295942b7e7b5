// Contact and friction of grains and walls against closed forms: numerics of blocks, discs on an
// incline (Bardenhagen, Brackbill & Sulsky, CMAME 187 (2000) 529) and colliding elastic discs.

#include <cmath>
#include <numbers>

#include "verification/grain_motion.hpp"
#include "verification/states.hpp"

namespace poreshock::test {
namespace {

constexpr double gravity = 100.0;

/// A soft elastic material: sound speed about 50 m/s.
constexpr const char* soft_text = R"(
[[material]]
name = "soft"
density = 1000
young = 2e6
poisson = 0.3
yield = 1e9
c0 = 41
lambda = 1.5
gamma = 0.0
cv = 1000
)";

GrainMotion after(const std::string& text, double time, int grain,
                  std::vector<std::string> overrides = {}) {
  overrides.push_back("time.end=" + digits(time));
  Simulation<2> sim = start<2>(scene_of(text + soft_text, overrides), MPI_COMM_SELF);
  advance_to(1000000, 0, sim);
  return motion_of(sim.particles, grain);
}

/// A bed of 3 or 4 cells that the wall holds, grain 1.
std::string bed(double width, double height) {
  return "[[body]]\nshape = \"box\"\nlow = [0.0, 0.0]\nhigh = [" + digits(width) + ", " +
         digits(height) + "]\ngrain = 1\n";
}

// A block of 10 x 4 cells slides on a wall and stops after v0^2 / (2 mu g).
constexpr const char* block_on_wall_text = R"(
[domain]
size = [30e-3, 12e-3]
cell = 1e-3
[boundary]
low = { kind = "wall", friction = 0.5 }
high = "free"
[[body]]
shape = "box"
low = [2e-3, 0.0]
high = [12e-3, 4e-3]
velocity = [1.0, 0.0]
[body_force]
acceleration = [0.0, -100.0]
[output]
beat = 1e-3
[time]
end = 1.0
)";
TEST(Friction, BlockOnAWall) {
  const GrainMotion motion = after(block_on_wall_text, 25e-3, 0, {});
  verify_relative("block_on_wall", "stop", motion.place[0] - 7e-3, 1.0 / (2.0 * 0.5 * gravity),
                  0.01);
  verify_at_most("block_on_wall", "velocity_after_stop", std::abs(motion.velocity[0]), 1e-3);
}

// The same on another grain. The leading edge of the block ploughs a little: the error falls with
// the length of the block in cells.
TEST(Friction, BlockOnAGrain) {
  const std::string text = R"(
[domain]
size = [60e-3, 12e-3]
cell = 1e-3
[boundary]
low = { kind = "wall", friction = 1e30 }
high = "free"
[[body]]
shape = "box"
low = [2e-3, 3e-3]
high = [42e-3, 7e-3]
grain = 2
velocity = [1.0, 0.0]
[contact]
friction = 0.5
[body_force]
acceleration = [0.0, -100.0]
[output]
beat = 1e-3
[time]
end = 1.0
)" + bed(60e-3, 3e-3);
  const GrainMotion motion = after(text, 25e-3, 2, {});
  verify_relative("block_on_grain", "stop", motion.place[0] - 22e-3, 1.0 / (2.0 * 0.5 * gravity),
                  0.01);
}

/// A disc of 24 cells across on an incline for 30 ms.
GrainMotion roll(double friction, double angle) {
  const std::string text = R"(
[domain]
size = [70e-3, 32e-3]
cell = 1e-3
[boundary]
low = { kind = "wall", friction = 1e30 }
high = "free"
[[body]]
shape = "disc"
center = [15e-3, 16e-3]
radius = 12e-3
grain = 2
[output]
beat = 1e-3
[time]
end = 1.0
[contact]
friction = )" + digits(friction) +
                           "\n[body_force]\nacceleration = [" + digits(gravity * std::sin(angle)) +
                           ", " + digits(-gravity * std::cos(angle)) + "]\n" + bed(70e-3, 4e-3);
  return after(text, 30e-3, 2);
}

TEST(Friction, DiscRollsDownAnIncline) {
  const double angle = std::numbers::pi / 4.0, time = 30e-3;
  const GrainMotion motion = roll(0.6, angle);
  const double acceleration = 2.0 / 3.0 * gravity * std::sin(angle);
  verify_relative("rolling_disc", "way", motion.place[0] - 15e-3, 0.5 * acceleration * time * time,
                  0.01);
  record("rolling_disc", "spin_over_exact", -motion.spin * 12e-3 / (acceleration * time));
}

TEST(Friction, DiscSlipsDownAnIncline) {
  const double angle = std::numbers::pi / 3.0, friction = 0.2, time = 30e-3;
  const GrainMotion motion = roll(friction, angle);
  const double acceleration = gravity * (std::sin(angle) - friction * std::cos(angle));
  verify_relative("slipping_disc", "way", motion.place[0] - 15e-3, 0.5 * acceleration * time * time,
                  0.01);
  verify_relative("slipping_disc", "spin", -motion.spin,
                  2.0 * friction * gravity * std::cos(angle) * time / 12e-3, 0.03);
}

/// Share of the energy that two elastic discs lose in a head-on collision (Sulsky, Chen & Schreyer,
/// CMAME 118 (1994) 179): all that is neither kinetic nor elastic.
double lost_energy(double cell, const std::vector<std::string>& scheme, double& momentum) {
  const std::string text = R"(
[domain]
size = [1.0, 1.0]
[boundary]
low = "free"
high = "free"
[[material]]
name = "soft"
density = 1000
young = 1000
poisson = 0.3
yield = 1e9
c0 = 0.9129
lambda = 1.0
gamma = 0.0
cv = 1000
[[body]]
shape = "disc"
center = [0.30, 0.30]
radius = 0.2
grain = 1
velocity = [0.1, 0.1]
[[body]]
shape = "disc"
center = [0.70, 0.70]
radius = 0.2
grain = 2
velocity = [-0.1, -0.1]
[transfer]
velocity = "flip"
[viscosity]
linear = 0.0
quadratic = 0.0
[output]
beat = 0.1
[time]
end = 3.0
)";
  std::vector<std::string> overrides = scheme;
  overrides.push_back("domain.cell=" + digits(cell));
  Simulation<2> sim = start<2>(scene_of(text, overrides), MPI_COMM_SELF);
  advance_to(1000000, 0, sim);
  const HistoryRow row = stock(sim);
  momentum = std::max(std::abs(row.momentum[0]), std::abs(row.momentum[1]));
  EXPECT_GT(motion_of(sim.particles, 2).velocity[0], 0.05);  // they have bounced
  return all_heat(row) / row.total;
}

void verify_elastic_discs(const std::string& name, const std::vector<std::string>& scheme) {
  double momentum = 0.0;
  const double coarse = lost_energy(0.02, scheme, momentum);
  const double fine = lost_energy(0.01, scheme, momentum);
  verify_at_most(name, "loss_at_40_cells", fine, 0.035);
  verify_at_least(name, "order_of_loss", order(coarse, fine), 0.9);
  const double before = 1000.0 * std::numbers::pi * 0.04 * 0.1;
  verify_at_most(name, "momentum", momentum / before, 1e-13);
}

TEST(ElasticDiscs, LoseLittleEnergyAndNoMomentum) {
  verify_elastic_discs("elastic_discs", {});
}

TEST(ElasticDiscs, LoseLittleEnergyWithPolyFlip) {
  verify_elastic_discs("elastic_discs_polyflip", {"transfer.velocity=polyflip"});
}

TEST(ElasticDiscs, LoseLittleWithNormalsOfPartingPlanes) {
  verify_elastic_discs("elastic_discs_regression", {"contact.normal=regression"});
}

}  // namespace
}  // namespace poreshock::test
