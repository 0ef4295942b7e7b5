// Bars in uniaxial strain below the yield point: on a rigid wall, and on each other.

#include "verification/states.hpp"

namespace poreshock::test {
namespace {

constexpr double length = 1e-3;
constexpr double speed = 1.0;  // far below 14.9 m/s, where yielding starts

constexpr double width = 40e-6;

std::string bar_scene(const std::string& side) {
  return "[domain]\nsize = [40e-6, 1.2e-3]\ncell = 10e-6\nperiodic = true\n[boundary]\nlow = \"" +
         side + "\"\n[sample]\nkind = \"solid\"\nheight = 1e-3\n[time]\nend = 1.0\n" +
         aluminium_text;
}

double impedance(const Simulation<2>& sim) {
  return 2700.0 * longitudinal_sound_speed(sim.materials[0]);
}

/// Impulse of the walls on the material so far, N s per metre of depth.
double wall_impulse(const Simulation<2>& sim) {
  return static_cast<double>(sim.ledger.nodes.wall_impulse[1]) * sim.ledger.momentum_quantum;
}

double total_mass(const Simulation<2>& sim) {
  double mass = 0.0;
  for (const double m : sim.particles.mass) mass += m;
  return mass;
}

/// Wall impulses at equal steps until well after the bounce.
struct Bounce {
  double contact;  ///< 2 L / c, s
  double dt;
  double impedance;
  double mass;
  std::vector<double> impulse;
};

Bounce bounce(const std::vector<std::string>& overrides) {
  Simulation<2> sim = start<2>(plain_scene_of(bar_scene("wall"), overrides), MPI_COMM_SELF);
  for (double& v : sim.particles.velocity[1]) v = -speed;
  const double c = longitudinal_sound_speed(sim.materials[0]);
  Bounce b{2.0 * length / c, 0.25 * sim.scene.domain.cell / c, impedance(sim), total_mass(sim), {}};
  const auto steps = static_cast<std::int64_t>(1.5 * b.contact / b.dt);
  for (std::int64_t k = 0; k < steps; ++k) {
    b.impulse.push_back(wall_impulse(sim));
    step_by(b.dt, sim);
  }
  b.impulse.push_back(wall_impulse(sim));
  return b;
}

/// Mean stress on the wall between two shares of the contact time, Pa.
double wall_stress(const Bounce& b, double from, double to) {
  const auto at = [&](double share) {
    return b.impulse.at(static_cast<std::size_t>(std::llround(share * b.contact / b.dt)));
  };
  return (at(to) - at(from)) / ((to - from) * b.contact * width);
}

/// When the stress on the wall, averaged over two hundredths of the contact, falls to half, as a
/// share of the contact time.
double end_of_contact(const Bounce& b, double stress) {
  double share = 0.5;
  while (share < 1.4 && wall_stress(b, share - 0.01, share + 0.01) > 0.5 * stress) share += 0.001;
  return share;
}

/// Stress on the wall, time of contact and rebound of a bar; returns 1 - restitution.
double verify_bounce(const std::string& name, const Bounce& b, double least_restitution) {
  const double stress = wall_stress(b, 0.2, 0.8);
  verify_relative(name, "stress", stress, b.impedance * speed, 0.01);
  verify_relative(name, "contact_time", end_of_contact(b, stress), 1.0, 0.02);
  const double restitution = b.impulse.back() / (b.mass * speed) - 1.0;
  verify_at_least(name, "restitution", restitution, least_restitution);
  verify_at_most(name, "restitution_above_one", restitution - 1.0, 1e-3);
  return 1.0 - restitution;
}

TEST(ElasticBar, BouncesOffARigidWallWithoutViscosity) {
  verify_bounce("bar_on_wall_inviscid_100",
                bounce({"viscosity.linear=0.0", "viscosity.quadratic=0.0"}), 0.97);
}

TEST(ElasticBar, BouncesOffARigidWall) {
  // Linear viscosity spreads the two fronts over sqrt(cell x length), and so takes from the rebound
  // a share that falls like the square root of the cell.
  const Bounce coarse = bounce({"domain.cell=10e-6"});
  const double lost = 1.0 - (coarse.impulse.back() / (coarse.mass * speed) - 1.0);
  const double finer = verify_bounce("bar_on_wall_200", bounce({"domain.cell=5e-6"}), 0.95);
  record("bar_on_wall_100", "restitution", 1.0 - lost);
  verify_at_least("bar_on_wall", "restitution_order_100_200", order(lost, finer), 0.45);
}

TEST(ElasticBar, GivesItsVelocityToAnEqualOne) {
  // 500 um at rest below 500 um that fall on them: at twice the time a wave needs for one bar the
  // upper one stands still and the lower one has all its velocity. Later the exact bars part.
  Simulation<2> sim = start<2>(plain_scene_of(bar_scene("free")), MPI_COMM_SELF);
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    sim.particles.position[1][p] += 100e-6;
    const bool upper = site(sim, p)[1] > 0.5 * length;
    sim.particles.velocity[1][p] = upper ? -speed : 0.0;
  }
  distribute(sim);
  const double c = longitudinal_sound_speed(sim.materials[0]);
  const std::int64_t half = 200;
  const double dt = 0.5 * length / c / static_cast<double>(half);
  const double momentum = stock(sim).momentum[1];
  step_by(dt, half, sim);
  double stress = 0.0, count = 0.0;
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    const double X = site(sim, p)[1];
    if (X < 0.25 * length || X > 0.75 * length) continue;
    stress += sim.particles.pressure[p] - sim.particles.deviator[1][p];
    count += 1.0;
  }
  verify_relative("two_bars", "stress", stress / count, 0.5 * impedance(sim) * speed, 0.01);
  step_by(dt, half, sim);
  double low = 0.0, high = 0.0;
  for (std::size_t p = 0; p < sim.particles.size(); ++p) {
    (site(sim, p)[1] < 0.5 * length ? low : high) += sim.particles.velocity[1][p];
  }
  const double each = 0.5 * static_cast<double>(sim.particles.size());
  verify_relative("two_bars", "velocity_given", -low / each, speed, 0.05);
  verify_at_most("two_bars", "velocity_kept", std::abs(high / each) / speed, 0.05);
  verify_at_most("two_bars", "momentum", std::abs(stock(sim).momentum[1] / momentum - 1.0), 1e-12);
}

}  // namespace
}  // namespace poreshock::test
