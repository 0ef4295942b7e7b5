// One main for all tests: starts MPI and PETSc, and prints from rank 0 only unless a test fails.
#include <gtest/gtest.h>

#include "poreshock/core/parallel.hpp"

int main(int argc, char** argv) {
  ::testing::InitGoogleTest(&argc, argv);
  const poreshock::Runtime runtime(argc, argv);
  if (poreshock::rank(runtime.communicator()) != 0) {
    ::testing::TestEventListeners& listeners = ::testing::UnitTest::GetInstance()->listeners();
    class FailuresOnly : public ::testing::EmptyTestEventListener {
      void OnTestPartResult(const ::testing::TestPartResult& result) override {
        if (result.failed()) {
          std::fprintf(stderr, "rank > 0: %s:%d: %s\n", result.file_name(), result.line_number(),
                       result.message());
        }
      }
    };
    delete listeners.Release(listeners.default_result_printer());
    listeners.Append(new FailuresOnly);
  }
  const int failed = RUN_ALL_TESTS();
  return poreshock::largest(failed, runtime.communicator());
}
