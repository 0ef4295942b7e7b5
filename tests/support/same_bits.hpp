#pragma once
// Checksums of whole runs on some of the ranks, with and without a restart between.

#include <gtest/gtest.h>

#include <filesystem>

#include "poreshock/output/checkpoint.hpp"
#include "poreshock/run/checksum.hpp"
#include "support/runs.hpp"

namespace poreshock::test {

/// Checksum at step `last` of a run on the first `ranks` ranks, with a forced rebalance every
/// `rebalance_every` steps (0 = never). Collective over all ranks.
template <int Dim>
std::uint64_t checksum_after(const Scene& scene, int ranks, std::int64_t last,
                             std::int64_t rebalance_every = 0) {
  std::uint64_t result = 0;
  on_ranks(ranks, [&](MPI_Comm part) {
    Simulation<Dim> sim = start<Dim>(scene, part);
    advance_to(last, rebalance_every, sim);
    result = checksum(sim);
  });
  return from_rank_zero(result);
}

/// Checksum at step `last` of a run that another number of ranks goes on with from a checkpoint.
/// Collective over all ranks.
template <int Dim>
std::uint64_t checksum_with_restart(const Scene& scene, int writers, int readers,
                                    std::int64_t middle, std::int64_t last) {
  // A name of its own for every program and number of ranks: they may run at the same time.
  const std::string suite =
      ::testing::UnitTest::GetInstance()->current_test_info()->test_suite_name();
  const std::string path =
      std::filesystem::absolute(suite + "_" + std::to_string(size(MPI_COMM_WORLD)) + ".h5");
  on_ranks(writers, [&](MPI_Comm part) {
    Simulation<Dim> sim = start<Dim>(scene, part);
    advance_to(middle, 0, sim);
    write_checkpoint(path, sim.scene_text, run_state(sim), sim.particles, part);
  });
  std::uint64_t result = 0;
  on_ranks(readers, [&](MPI_Comm part) {
    Simulation<Dim> sim = resume<Dim>(scene, path, part);
    EXPECT_EQ(sim.clock.step, middle);
    advance_to(last, 0, sim);
    result = checksum(sim);
  });
  return from_rank_zero(result);
}

}  // namespace poreshock::test
