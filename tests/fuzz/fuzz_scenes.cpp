// Scenes with mistakes: each is refused with a message, or is one that can be run.
#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "fuzz/case_watch.hpp"
#include "fuzz/mutate.hpp"
#include "poreshock/core/error.hpp"
#include "poreshock/scene/read_scene.hpp"
#include "scene/scene_text.hpp"
#include "support/runs.hpp"

namespace poreshock {
namespace {

constexpr double most_particles = 8000;
constexpr int most_failures = 20;

std::vector<std::string> originals() {
  std::vector<std::string> texts = {
      rich_2d, rich_3d, small_scene(), test::porous_text(),
      test::porous_text("[conduction]\non = true\n"
                        "[morphology]\nevery = 5e-9\nfields = "
                        "[\"temperature\"]\nthresholds = [310, 400]\n")};
  const std::filesystem::path folder = PORESHOCK_SOURCE_DIR "/input";
  std::vector<std::filesystem::path> paths;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
    if (entry.path().extension() == ".toml") paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  for (const auto& path : paths) {
    std::ifstream file(path);
    texts.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
  }
  return texts;
}

/// Upper bound of the particles and nodes of a scene.
double cost(const Scene& scene) {
  double cells = 1.0, particles = 1.0;
  for (int axis = 0; axis < scene.dimension; ++axis) {
    cells *= scene.domain.cells[axis];
    particles *= scene.sample.particles_per_cell;
  }
  return cells * particles;
}

/// Makes the sample and takes a few steps; errors that name what is wrong are good ends too.
template <int Dim>
void try_to_run(const Scene& scene) {
  try {
    Simulation<Dim> sim = start<Dim>(scene, MPI_COMM_SELF);
    for (int step = 0; step < 3 && sim.clock.time < scene.time.end; ++step) {
      const double dt = next_time_step(scene, sim.clock);
      ASSERT_TRUE(dt > 0.0);
      advance(sim, dt);
      tick(scene, dt, sim.clock);
      if (agree_on_step(false, sim.clock, MPI_COMM_SELF).bad_state) return;
      migrate(sim);
    }
  } catch (const InputError& error) {
    EXPECT_GT(std::string(error.what()).size(), 10u);
  } catch (const StateError& error) {
    EXPECT_GT(std::string(error.what()).size(), 10u);
  }
}

/// Failed checks of this test so far.
int failures() {
  const ::testing::TestResult& result =
      *::testing::UnitTest::GetInstance()->current_test_info()->result();
  int count = 0;
  for (int i = 0; i < result.total_part_count(); ++i) {
    if (result.GetTestPartResult(i).failed()) ++count;
  }
  return count;
}

struct Counts {
  std::uint64_t refused = 0, accepted = 0, run = 0;
};

void try_scene(const std::string& text, Counts& counts) {
  Scene scene;
  try {
    scene = parse_scene(text, "mutated.toml");
  } catch (const InputError& error) {
    ++counts.refused;
    EXPECT_GT(std::string(error.what()).size(), 10u);
    return;
  }
  ++counts.accepted;
  const std::string written = write_scene(scene);
  EXPECT_TRUE(parse_scene(written, "written.toml") == scene) << written;
  if (cost(scene) > most_particles) return;
  ++counts.run;
  scene.dimension == 2 ? try_to_run<2>(scene) : try_to_run<3>(scene);
}

TEST(Fuzz, ScenesAreRefusedWithAReasonOrCanBeRun) {
  const test::CaseWatch watch;
  const std::vector<std::string> texts = originals();
  const std::uint64_t count = test::fuzz_count("PORESHOCK_FUZZ_SCENES", 300);
  const std::uint64_t first = test::fuzz_count("PORESHOCK_FUZZ_FIRST", 0);
  Counts counts;
  int failed = 0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    test::Mutator mutator(seed);
    const std::string text = mutator.scene(mutator.pick(texts), mutator.pick(texts));
    if (count == 1) std::printf("%s\n", text.c_str()), std::fflush(stdout);
    watch.begin(seed);
    try {
      try_scene(text, counts);
    } catch (const std::exception& error) {
      ADD_FAILURE() << "another exception: " << error.what();
    }
    watch.end();
    if (failures() == failed) continue;
    failed = failures();
    std::printf("case %llu:\n%s\n", static_cast<unsigned long long>(seed), text.c_str());
    if (failed >= most_failures) break;
  }
  std::printf("%llu mutated scenes: %llu refused, %llu accepted, %llu of them run\n",
              static_cast<unsigned long long>(count),
              static_cast<unsigned long long>(counts.refused),
              static_cast<unsigned long long>(counts.accepted),
              static_cast<unsigned long long>(counts.run));
  EXPECT_GT(counts.refused, count / 10);
  EXPECT_GT(counts.accepted, count / 20);
}

}  // namespace
}  // namespace poreshock
