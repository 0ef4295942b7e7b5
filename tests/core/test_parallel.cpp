// The few collectives of the program, and the texts of failures of the libraries below it.
#include <gtest/gtest.h>

#include <petscsys.h>
#include <chrono>
#include <thread>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"

namespace poreshock {
namespace {

const MPI_Comm world = MPI_COMM_WORLD;

TEST(Collectives, GiveEveryRankTheSameResult) {
  const int me = rank(world), ranks = size(world);
  EXPECT_EQ(largest(-5 - me, world), -5);
  EXPECT_EQ(largest(me, world), ranks - 1);
  const std::int64_t big = std::int64_t{1} << 60;
  EXPECT_EQ(sum(me == 0 ? big + 1 : std::int64_t{-1}, world), big + 2 - ranks);
  std::vector<std::int64_t> values = {me, 1, -me};
  sum(values, world);
  EXPECT_EQ(values,
            (std::vector<std::int64_t>{ranks * (ranks - 1) / 2, ranks, -ranks * (ranks - 1) / 2}));
}

TEST(Collectives, CopyTheTextOfRankZero) {
  std::string text = rank(world) == 0 ? std::string("a\0b and more", 12) : "shorter or longer";
  broadcast(text, world);
  EXPECT_EQ(text, std::string("a\0b and more", 12));
  std::string empty = rank(world) == 0 ? "" : "something";
  broadcast(empty, world);
  EXPECT_EQ(empty, "");
}

template <class Call>
std::string text_of_failure(Call&& call) {
  try {
    call();
  } catch (const RankError& error) {
    return error.what();
  }
  return "no failure";
}

TEST(Failures, NameTheCallAndTheReason) {
  const std::string petsc =
      text_of_failure([] { check_petsc(PETSC_ERR_ARG_OUTOFRANGE, "VecSetSizes"); });
  EXPECT_NE(petsc.find("PETSc failed in VecSetSizes: "), std::string::npos) << petsc;
  EXPECT_NE(petsc.find("(code " + std::to_string(PETSC_ERR_ARG_OUTOFRANGE) + ")"),
            std::string::npos)
      << petsc;
  const std::string mpi = text_of_failure([] { check_mpi(MPI_ERR_TRUNCATE, "MPI_Recv"); });
  EXPECT_NE(mpi.find("MPI failed in MPI_Recv: "), std::string::npos) << mpi;
  EXPECT_NE(mpi.find("TRUNCATE"), std::string::npos) << mpi;
  EXPECT_EQ(text_of_failure([] { check_petsc(0, "x"); }), "no failure");
  EXPECT_EQ(text_of_failure([] { check_mpi(MPI_SUCCESS, "x"); }), "no failure");
}

TEST(Farewell, RanksThatWaitInVainSaySo) {
  MPI_Comm farewell = MPI_COMM_NULL;
  MPI_Comm_dup(MPI_COMM_WORLD, &farewell);
  EXPECT_TRUE(all_arrive(20.0, farewell));
  const bool late = rank(farewell) == 0 && size(farewell) > 1;
  if (late) std::this_thread::sleep_for(std::chrono::milliseconds(700));
  const bool all = all_arrive(late ? 20.0 : 0.1, farewell);
  EXPECT_EQ(all, late || size(farewell) == 1);
  MPI_Barrier(MPI_COMM_WORLD);
  MPI_Comm_free(&farewell);
}

}  // namespace
}  // namespace poreshock
