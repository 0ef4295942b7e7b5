#include "poreshock/run/start_warnings.hpp"

#include <algorithm>
#include <cmath>

#include "first_impact.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/core/text.hpp"
#include "poreshock/grid/grain_colours.hpp"
#include "poreshock/scene/scene_warnings.hpp"

namespace poreshock {

namespace {

/// Steps in which nothing can have happened yet.
constexpr double first_steps = 20.0;

template <int Dim>
bool is_open(const Scene& scene, int axis, bool high) {
  return side_law(side_kind(scene.boundary, axis, high, Dim)).lets_out;
}

std::string side_name(int axis, bool high, int dimension) {
  if (axis + 1 == dimension) return high ? "boundary.high" : "boundary.low";
  return std::string("boundary.lateral (") + (high ? "high " : "low ") + "xyz"[axis] + ")";
}

/// Particles that reach an open side within the first steps, by axis and side.
template <int Dim>
std::vector<std::int64_t> leaving_particles(const Simulation<Dim>& sim) {
  const double time = first_steps * sim.clock.limit;
  const Particles<Dim>& particles = sim.particles;
  std::vector<std::int64_t> leaving(2 * Dim, 0);
  for (std::size_t a = 0; a < Dim; ++a) {
    const int axis = static_cast<int>(a);
    const double size = sim.scene.domain.size[a];
    const bool low = is_open<Dim>(sim.scene, axis, false),
               high = is_open<Dim>(sim.scene, axis, true);
    for (std::size_t p = 0; p < particles.size(); ++p) {
      const double moved = (particles.velocity[a][p] - sim.grid->shape().velocity[a]) * time;
      const double x = particles.position[a][p];
      if (low && x + moved < 0.0) ++leaving[2 * a];
      if (high && x + moved >= size) ++leaving[2 * a + 1];
    }
  }
  sum(leaving, sim.communicator);
  return leaving;
}

template <int Dim>
void warn_leaving(const Simulation<Dim>& sim, std::vector<std::string>& warnings) {
  const std::vector<std::int64_t> leaving = leaving_particles(sim);
  for (std::size_t side = 0; side < leaving.size(); ++side) {
    if (leaving[side] == 0) continue;
    const double share =
        100.0 * static_cast<double>(leaving[side]) / static_cast<double>(sim.sample.particles);
    const std::string name = side_name(static_cast<int>(side / 2), side % 2 == 1, Dim);
    warnings.push_back(std::to_string(leaving[side]) + " particles (" + significant<3>(share) +
                       " %) leave the domain within the first " + significant<3>(first_steps) +
                       " steps, through the open side " + name + ". Set " +
                       name.substr(0, name.find(' ')) +
                       " = \"wall\" or \"symmetry\" if they shall hit it, turn their velocity, or "
                       "leave them room.");
  }
}

template <int Dim>
void warn_nothing_hit(const Simulation<Dim>& sim, std::vector<std::string>& warnings) {
  const Scene& scene = sim.scene;
  if (moves_by_itself(scene)) return;
  const double impact = first_impact(scene, sim.sample);
  if (impact <= scene.time.end) return;
  const std::string late =
      std::isfinite(impact)
          ? ": the first impact comes at " + significant<3>(impact) +
                " s. Raise time.end, or start "
          : ": no wall, symmetry plane or body lies in the way of what moves. Set boundary.low = "
            "\"wall\", give loading.velocity or body velocities that meet something, or start ";
  warnings.push_back("Nothing is hit until time.end = " + significant<3>(scene.time.end) + " s" +
                     late + "what shall collide closer together.");
}

/// Grains that are driven together get more neighbours than they start with.
void warn_crowded(const std::vector<std::int8_t>& colours, std::vector<std::string>& warnings) {
  if (colours.empty()) return;
  const int taken = 1 + *std::max_element(colours.begin(), colours.end());
  if (taken + 1 < most_colours) return;
  warnings.push_back(
      "The grains take " + std::to_string(taken) + " of the " + std::to_string(most_colours) +
      " velocity fields at the start. Driven together they may need more, which "
      "ends the run (exit code 3). Set domain.cell finer, make the grains larger, or "
      "take a transfer.shape of a narrower stencil.");
}

}  // namespace

template <int Dim>
std::vector<std::string> motion_warnings(const Simulation<Dim>& sim) {
  std::vector<std::string> warnings;
  warn_leaving(sim, warnings);
  warn_nothing_hit(sim, warnings);
  warn_crowded(sim.grain_fields.colours, warnings);
  return warnings;
}

template <int Dim>
std::vector<std::string> start_warnings(const Simulation<Dim>& sim) {
  std::vector<std::string> warnings = scene_warnings(sim.scene);
  for (const std::vector<std::string>& more :
       {body_warnings(sim.scene, sim.sample), motion_warnings(sim)}) {
    warnings.insert(warnings.end(), more.begin(), more.end());
  }
  return warnings;
}

template std::vector<std::string> motion_warnings<2>(const Simulation<2>&);
template std::vector<std::string> motion_warnings<3>(const Simulation<3>&);
template std::vector<std::string> start_warnings<2>(const Simulation<2>&);
template std::vector<std::string> start_warnings<3>(const Simulation<3>&);

}  // namespace poreshock
