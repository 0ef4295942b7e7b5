// Hertz line contact: two alike elastic cylinders pressed together. Half-width and peak pressure of
// b^2 = 4 P R / (pi E*), p0 = sqrt(P E* / (pi R)) with R half the radius, E* = E / (2 (1 - nu^2))
// and P the load per length.
//
// A segment of each stands for it, with its lattice bent along the arc: steps of half a cell
// would hide the gap beside the contact. Poisson's ratio is high so that the compression, which the
// equation of state stiffens, stays small. The load is a body force; at every peak of the kinetic
// energy all motion is taken out.

#include <numbers>

#include "verification/states.hpp"

namespace poreshock::test {
namespace {

constexpr double density = 1000.0, young = 1e9, poisson = 0.45;
constexpr double modulus = 0.5 * young / (1.0 - poisson * poisson);
constexpr double half_width = 0.1e-3;           // m, b
constexpr double cylinder = 10.0 * half_width;  // m, its radius
constexpr double width = 6.0 * half_width;      // m, of half a segment
constexpr double height = 8.0 * half_width;     // m
constexpr double axis = width + half_width;
constexpr double radius = 0.5 * cylinder;
constexpr double load = std::numbers::pi * modulus * half_width * half_width / (4.0 * radius);
constexpr double peak = 0.5 * modulus * half_width / radius;
constexpr double middle = 9.0 * half_width;  // m, height of the contact

std::string scene_text(double cell) {
  const auto corner = [](double x, double y) {
    return std::string("[").append(digits(x)).append(", ").append(digits(y)).append("]\n");
  };
  std::string text("[domain]\nsize = ");
  text.append(corner(2.0 * axis, 2.0 * middle)).append("cell = ").append(digits(cell));
  text.append("\n[boundary]\nlow = \"free\"\n");
  for (int grain = 0; grain < 2; ++grain) {
    text.append("[[body]]\nshape = \"box\"\ngrain = ").append(std::to_string(grain));
    text.append("\nlow = ").append(corner(half_width, grain == 0 ? middle : middle - height));
    text.append("high = ").append(
        corner(2.0 * width + half_width, grain == 0 ? middle + height : middle));
  }
  text.append("[time]\nend = 1.0\nsleep = false\n[output]\nbeat = 1.0\n[[material]]\n");
  text.append("name = \"elastic\"\ndensity = 1000\nyoung = 1e9\npoisson = 0.45\nyield = 1e12\n");
  text.append("lambda = 1.0\ngamma = 0.0\ncv = 1000\nc0 = ");
  return text.append(digits(std::sqrt(young / (3.0 * (1.0 - 2.0 * poisson)) / density)))
      .append("\n");
}

/// Bends the faces that meet into arcs; the backs stay flat.
void bend(Simulation<2>& sim) {
  Particles<2>& q = sim.particles;
  for (std::size_t p = 0; p < q.size(); ++p) {
    const double x = q.position[0][p] - axis, depth = std::abs(q.position[1][p] - middle);
    const double arc = cylinder - std::sqrt(cylinder * cylinder - x * x);
    const double from = arc + depth * (1.0 - arc / height);
    q.position[1][p] = q.grain[p] == 0 ? middle + from : middle - from;
    q.mass[p] *= 1.0 - arc / height;
  }
  migrate(sim);
}

double kinetic(const Particles<2>& q) {
  double sum = 0.0;
  for (std::size_t p = 0; p < q.size(); ++p) {
    sum += q.mass[p] * (q.velocity[0][p] * q.velocity[0][p] + q.velocity[1][p] * q.velocity[1][p]);
  }
  return sum;
}

void stop(Particles<2>& q) {
  for (auto& column : q.velocity) std::fill(column.begin(), column.end(), 0.0);
  for (auto& column : q.affine) std::fill(column.begin(), column.end(), 0.0);
  for (auto& column : q.quadratic) std::fill(column.begin(), column.end(), 0.0);
}

/// Presses the segments together until `time`.
void press(double time, Simulation<2>& sim) {
  Particles<2>& q = sim.particles;
  double mass = 0.0;
  for (std::size_t p = 0; p < q.size(); ++p) mass += 0.5 * q.mass[p];
  const double acceleration = load / mass;
  double before = 0.0;
  while (sim.clock.time < time) {
    agree_on_step(false, sim.clock, sim.communicator);
    const double dt = next_time_step(sim.scene, sim.clock);
    for (std::size_t p = 0; p < q.size(); ++p) {
      q.velocity[1][p] += (q.grain[p] == 1 ? 1.0 : -1.0) * acceleration * dt;
    }
    step_by(dt, sim);
    ASSERT_EQ(sim.clock.bad, 0) << "state gone bad at step " << sim.clock.step;
    const double now = kinetic(q);
    if (now < before) stop(q);
    before = now < before ? 0.0 : now;
  }
}

struct Contact {
  double half_width, peak;
};

/// From the particles that lie less than `deepest` cells below the face: p^2 = p0^2 (1 - x^2 / b^2)
/// is a straight line in x^2, fitted where p is above a third of its largest.
Contact contact_of(double deepest, const Simulation<2>& sim) {
  const Particles<2>& q = sim.particles;
  const double cell = sim.scene.domain.cell;
  std::vector<std::array<double, 2>> points;
  double largest = 0.0;
  for (std::size_t p = 0; p < q.size(); ++p) {
    const double x = std::abs(q.position[0][p] - axis);
    const double depth = site(sim, p)[1] - middle;
    if (x > 1.5 * half_width || depth < 0.0 || depth > deepest * cell) continue;
    const double push = q.pressure[p] - q.deviator[1][p];
    points.push_back({x * x, push});
    largest = std::max(largest, push);
  }
  double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, sxy = 0.0;
  for (const auto& [x, push] : points) {
    if (push < largest / 3.0) continue;
    const double y = push * push;
    n += 1.0, sx += x, sy += y, sxx += x * x, sxy += x * y;
  }
  const double slope = (n * sxy - sx * sy) / (n * sxx - sx * sx);
  const double top = (sy - slope * sx) / n;
  return {std::sqrt(-top / slope), std::sqrt(top)};
}

/// Of the first layer of particles, and of the first cell, which holds two.
struct Layers {
  Contact first, cell;
};

Layers pressed(int cells_per_half_width) {
  Simulation<2> sim =
      start<2>(scene_of(scene_text(half_width / cells_per_half_width)), MPI_COMM_SELF);
  bend(sim);
  press(4.0 * height / std::sqrt(young / density), sim);
  return {contact_of(0.5, sim), contact_of(1.0, sim)};
}

// The stress of layers alternates beside the contact, which nodes cannot see: what the first bears
// too much, the second bears too little.
TEST(HertzLineContact, TwoCylinders) {
  const std::string name = "hertz_line";
  const Layers coarse = pressed(4), fine = pressed(6);
  record(name, "half_width_error_4", coarse.cell.half_width / half_width - 1.0);
  record(name, "peak_pressure_error_4", coarse.cell.peak / peak - 1.0);
  verify_relative(name, "half_width", fine.cell.half_width, half_width, 0.03);
  verify_relative(name, "peak_pressure", fine.cell.peak, peak, 0.03);
  verify_relative(name, "half_width_first_layer", fine.first.half_width, half_width, 0.05);
  verify_known_shortfall(name, "peak_first_layer_error", fine.first.peak / peak - 1.0, 0.1, 0.105);
  verify_at_most(name, "first_layer_error_ratio_6_4",
                 std::abs((fine.first.peak - peak) / (coarse.first.peak - peak)), 0.9);
}

}  // namespace
}  // namespace poreshock::test
