// What a run may write into a checkpoint: only a state that a restart takes.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>

#include "output/support.hpp"
#include "poreshock/run/records.hpp"
#include "poreshock/solver/check_state.hpp"
#include "support/runs.hpp"

namespace poreshock::test {
namespace {

TEST(CheckpointState, NoneIsMadeOfAParticleThatRestsAndIsNotFinite) {
  const TemporaryFolder folder;
  Simulation<2> sim = start<2>(scene_of(porous_text()), MPI_COMM_WORLD);
  advance_to(20, 0, sim);
  Recorder<2> recorder = make_recorder<2>(folder / "", false, nullptr, sim);
  // On the last rank what is stored first rests: no step reads more of it than its height.
  std::vector<double>& pressure = sim.particles.pressure;
  const bool last = rank(MPI_COMM_WORLD) == size(MPI_COMM_WORLD) - 1;
  if (last) {
    EXPECT_GT(resting_particles(sim.cells), 0u);
    pressure[0] = std::numeric_limits<double>::quiet_NaN();
  }
  advance_to(21, 0, sim);
  EXPECT_TRUE(
      contains(thrown<StateError>([&] { checkpoint_now(sim, recorder); }),
               "at step 21 no checkpoint can be made of 1 numbers that are not finite: look "
               "at failed.h5, restart from the newest checkpoint"));
  EXPECT_FALSE(std::filesystem::exists(folder / checkpoint_name(21)));
  EXPECT_EQ(recorder.last_checkpoint_step, 20);
  std::replace_if(
      pressure.begin(), pressure.end(), [](double p) { return !std::isfinite(p); }, 0.0);
  checkpoint_now(sim, recorder);
  EXPECT_TRUE(std::filesystem::exists(folder / checkpoint_name(21)));
  EXPECT_EQ(recorder.last_checkpoint_step, 21);
}

}  // namespace
}  // namespace poreshock::test
