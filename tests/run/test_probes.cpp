// Probes: what they look at, what they see, the same bits on any number of ranks.
#include <gtest/gtest.h>

#include <cmath>
#include <set>

#include "poreshock/core/error.hpp"
#include "poreshock/run/probes.hpp"
#include "poreshock/run/trace.hpp"
#include "support/aluminium.hpp"
#include "support/reference_shock.hpp"
#include "support/runs.hpp"

namespace poreshock::test {
namespace {

const char* const all_kinds = R"(
[[probe]]
name = "top"
at = [0.1e-3]
width = 60e-6
[[probe]]
name = "joint"
kind = "interface"
at = [0.1e-3, 0.2e-3]
width = 50e-6
faces = "down"
[[probe]]
name = "gauge"
kind = "particle"
at = [0.005e-3, 0.1e-3]
width = 40e-6
[[probe]]
name = "space"
kind = "point"
at = [0.1e-3, 0.15e-3]
width = 30e-6
)";

/// The rows of all probes every 10 steps.
std::vector<std::string> rows_of(const Scene& scene, int ranks, std::int64_t steps) {
  std::string text;
  on_ranks(ranks, [&](MPI_Comm part) {
    Simulation<2> sim = start<2>(scene, part);
    std::vector<ProbeTarget> targets;
    for (const Probe& probe : scene.probes) targets.push_back(find_target(probe, sim));
    for (std::int64_t step = 0; step <= steps; step += 10) {
      advance_to(step, 30, sim);
      for (std::size_t k = 0; k < targets.size(); ++k) {
        text += probe_line(look(scene.probes[k], sim, targets[k]), 2) + "\n";
      }
    }
  });
  broadcast(text, MPI_COMM_WORLD);
  std::vector<std::string> lines;
  for (std::size_t at = 0; at < text.size(); at = text.find('\n', at) + 1) {
    lines.push_back(text.substr(at, text.find('\n', at) - at));
  }
  return lines;
}

TEST(Probes, SameBitsOnAllRanks) {
  const Scene scene = scene_of(porous_text(all_kinds));
  const auto alone = rows_of(scene, 1, 120);
  EXPECT_GT(std::set<std::string>(alone.begin(), alone.end()).size(), 40u);
  for (int ranks = 2; ranks <= size(MPI_COMM_WORLD); ++ranks) {
    EXPECT_EQ(rows_of(scene, ranks, 120), alone) << ranks << " ranks";
  }
}

TEST(Probes, TargetsAreWhatTheKeysSay) {
  // Sites at 2.5 um, 7.5 um ...; 40 columns, 80 layers of the sample.
  const auto target = [](const std::string& probe) {
    const Scene scene =
        scene_of(porous_text("[[probe]]\nname = 'a'\n" + probe), {"sample.kind=solid"});
    return find_target(scene.probes[0], start<2>(scene, MPI_COMM_WORLD)).ids;
  };
  using Ids = std::vector<std::int64_t>;
  EXPECT_EQ(target("at = [0.1e-3]\n"), (Ids{79 * 40 + 19, 79 * 40 + 20}));
  EXPECT_EQ(target("at = [0.1e-3]\nfaces = 'down'\n"), (Ids{19, 20}));
  // Over the periodic side.
  EXPECT_EQ(target("at = [0]\n"), (Ids{79 * 40, 79 * 40 + 39}));
  EXPECT_EQ(target("kind = 'interface'\nat = [0.1e-3, 0.2e-3]\n"),
            (Ids{39 * 40 + 19, 39 * 40 + 20}));
  EXPECT_EQ(target("kind = 'interface'\nat = [0.1e-3, 0.2e-3]\nfaces = 'down'\n"),
            (Ids{40 * 40 + 19, 40 * 40 + 20}));
  EXPECT_EQ(target("kind = 'particle'\nat = [0.1e-3, 0.2e-3]\n"),
            (Ids{39 * 40 + 19, 39 * 40 + 20, 40 * 40 + 19, 40 * 40 + 20}));
  EXPECT_TRUE(target("kind = 'particle'\nat = [0.1e-3, 0.43e-3]\n").empty());
}

TEST(Probes, SaysWhatItLooksAtAtTheStart) {
  const Scene scene = scene_of(porous_text(all_kinds), {"sample.kind=solid"});
  const Simulation<2> sim = start<2>(scene, MPI_COMM_WORLD);
  const double heights[] = {397.5e-6, 202.5e-6, 100e-6, 150e-6};
  const double site = 25e-12 * 2700.0;
  const double counts[] = {12, 10, 52, 0};
  for (std::size_t k = 0; k < 4; ++k) {
    ProbeTarget target = find_target(scene.probes[k], sim);
    const ProbeRow row = look(scene.probes[k], sim, target);
    EXPECT_NEAR(row.height, heights[k], 1e-15) << k;
    EXPECT_NEAR(row.velocity[1], -1100.0, 1e-9) << k;
    EXPECT_NEAR(row.velocity[0], 0.0, 1e-9) << k;
    EXPECT_NEAR(row.temperature, 300.0, 1e-9) << k;
    EXPECT_EQ(row.pressure, 0.0);
    if (counts[k] > 0.0) {
      EXPECT_NEAR(row.mass / site, counts[k], 1e-9) << k;
    }
  }
  // The mean of 1 - (r/R)^2 over a disc is half of its area, R^2 = width^2/2.
  ProbeTarget none;
  const double mass = look(scene.probes[3], sim, none).mass;
  EXPECT_NEAR(mass / (2700.0 * 0.25 * M_PI * 900e-12), 1.0, 0.02);
}

TEST(Probes, ASurfaceWhoseParticlesLeftIsTheNextOne) {
  Scene scene = scene_of(porous_text("[[probe]]\nname = 'a'\nat = [0.1e-3]\nfaces = 'down'\n"),
                         {"boundary.low=free", "sample.kind=solid", "loading.velocity=3000"});
  Simulation<2> sim = start<2>(scene, MPI_COMM_WORLD);
  ProbeTarget target = find_target(scene.probes[0], sim);
  const std::int64_t first = target.ids[0];
  for (int k = 1; k <= 8; ++k) {
    advance_to(10 * k, 0, sim);
    const ProbeRow row = look(scene.probes[0], sim, target);
    EXPECT_EQ(target.ids, find_target(scene.probes[0], sim).ids);
    EXPECT_GT(row.mass, 0.0);
  }
  ASSERT_FALSE(target.ids.empty());
  EXPECT_GT(target.ids[0], first);
}

TEST(Probes, NoMaterialWhereItLooksIsAnError) {
  const Scene scene =
      scene_of(porous_text("[[probe]]\nname = 'a'\nkind = 'particle'\nat = [0.1e-3, 0.43e-3]\n"));
  const Simulation<2> sim = start<2>(scene, MPI_COMM_WORLD);
  try {
    require_targets(sim);
    ADD_FAILURE();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("probe \"a\": no material starts where it looks"),
              std::string::npos);
  }
}

/// Trace of the free surface of a plate that hits a wall; heights in m.
struct SurfaceTrace {
  std::vector<double> time, velocity;
};

SurfaceTrace trace_of_plate(double velocity, double height, double end) {
  const Scene scene = scene_of(
      porous_text("[[probe]]\nname = 'a'\nat = [20e-6]\nwidth = 40e-6\n"),
      {"sample.kind=solid", "domain.size=[40e-6, " + std::to_string(height + 40e-6) + "]",
       "sample.height=" + std::to_string(height), "loading.velocity=" + std::to_string(velocity)});
  Simulation<2> sim = start<2>(scene, MPI_COMM_WORLD);
  ProbeTarget target = find_target(scene.probes[0], sim);
  SurfaceTrace trace;
  while (sim.clock.time < end) {
    const ProbeRow row = look(scene.probes[0], sim, target);
    trace.time.push_back(row.time);
    trace.velocity.push_back(row.velocity[1]);
    advance_to(sim.clock.step + 1, 0, sim);
  }
  return trace;
}

TEST(Probes, FreeSurfaceOfAPlate) {
  const double velocity = 1100.0, height = 0.6e-3;
  const reference::Solid solid = reference::solid(reference::aluminium());
  const reference::Piston exact = reference::piston(solid, velocity);
  const double arrival = height / exact.shocked.front;
  const SurfaceTrace trace = trace_of_plate(velocity, height, 1.6 * arrival);
  const TraceFigures seen = read_figures(trace.time, trace.velocity, 1.0);
  const double surface = reference::release(solid, exact.shocked).surface_velocity;
  EXPECT_NEAR(seen.jump_off / surface, 1.0, 0.005);
  EXPECT_LT(std::abs(seen.arrival - arrival) * exact.shocked.front, 10e-6);
}

}  // namespace
}  // namespace poreshock::test
