#include "poreshock/core/parallel.hpp"

#include <petscsys.h>

#include <chrono>
#include <csignal>
#include <thread>

#include "poreshock/core/error.hpp"
#include "poreshock/core/memory.hpp"

namespace poreshock {

Runtime::Runtime(int& argc, char**& argv) {
  struct sigaction hang_up {};
  sigaction(SIGHUP, nullptr, &hang_up);
  check_petsc(PetscInitialize(&argc, &argv, nullptr, nullptr), "PetscInitialize");
  // Errors come back as codes and become exceptions with a text, instead of a printed stack.
  check_petsc(PetscPushErrorHandler(PetscIgnoreErrorHandler, nullptr), "PetscPushErrorHandler");
  check_petsc(PetscPopSignalHandler(), "PetscPopSignalHandler");
  // What nohup has asked for outlives PETSc's own handlers.
  if (hang_up.sa_handler == SIG_IGN) sigaction(SIGHUP, &hang_up, nullptr);
  return_large_blocks();
}

Runtime::~Runtime() {
  PetscFinalize();
}

int rank(MPI_Comm communicator) {
  int result = 0;
  MPI_Comm_rank(communicator, &result);
  return result;
}

int size(MPI_Comm communicator) {
  int result = 1;
  MPI_Comm_size(communicator, &result);
  return result;
}

void check_petsc(int code, const char* what) {
  if (code == 0) return;
  const char* text = nullptr;
  PetscErrorMessage(static_cast<PetscErrorCode>(code), &text, nullptr);
  throw RankError(std::string("PETSc failed in ") + what + ": " +
                  (text != nullptr ? text : "unknown error") + " (code " + std::to_string(code) +
                  ")");
}

void check_mpi(int code, const char* what) {
  if (code == MPI_SUCCESS) return;
  char text[MPI_MAX_ERROR_STRING];
  int length = 0;
  MPI_Error_string(code, text, &length);
  throw RankError(std::string("MPI failed in ") + what + ": " + std::string(text, length));
}

int largest(int value, MPI_Comm communicator) {
  int result = value;
  check_mpi(MPI_Allreduce(&value, &result, 1, MPI_INT, MPI_MAX, communicator), "MPI_Allreduce");
  return result;
}

std::int64_t sum(std::int64_t value, MPI_Comm communicator) {
  std::int64_t result = value;
  check_mpi(MPI_Allreduce(&value, &result, 1, MPI_INT64_T, MPI_SUM, communicator), "MPI_Allreduce");
  return result;
}

void sum(std::vector<std::int64_t>& values, MPI_Comm communicator) {
  check_mpi(MPI_Allreduce(MPI_IN_PLACE, values.data(), static_cast<int>(values.size()), MPI_INT64_T,
                          MPI_SUM, communicator),
            "MPI_Allreduce");
}

void broadcast(std::string& text, MPI_Comm communicator) {
  std::int64_t length = static_cast<std::int64_t>(text.size());
  check_mpi(MPI_Bcast(&length, 1, MPI_INT64_T, 0, communicator), "MPI_Bcast");
  text.resize(static_cast<std::size_t>(length));
  check_mpi(MPI_Bcast(text.data(), static_cast<int>(length), MPI_CHAR, 0, communicator),
            "MPI_Bcast");
}

bool all_arrive(double seconds, MPI_Comm communicator) {
  MPI_Request request = MPI_REQUEST_NULL;
  check_mpi(MPI_Ibarrier(communicator, &request), "MPI_Ibarrier");
  int arrived = 0;
  const double end = MPI_Wtime() + seconds;
  while (true) {
    check_mpi(MPI_Test(&request, &arrived, MPI_STATUS_IGNORE), "MPI_Test");
    if (arrived != 0 || MPI_Wtime() > end) return arrived != 0;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

std::string version() {
  return PORESHOCK_VERSION;
}
std::string revision() {
  return PORESHOCK_REVISION;
}

MPI_Datatype make_unit(std::size_t bytes) {
  MPI_Datatype unit;
  MPI_Type_contiguous(static_cast<int>(bytes), MPI_BYTE, &unit);
  MPI_Type_commit(&unit);
  return unit;
}

}  // namespace poreshock
