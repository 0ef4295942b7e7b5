#include "poreshock/core/rank_zero.hpp"

namespace poreshock {

void agree(const Outcome& outcome, MPI_Comm communicator) {
  const int ranks = size(communicator);
  const int mine = outcome.code == ExitCode::success ? ranks : rank(communicator);
  int lowest = mine;
  check_mpi(MPI_Allreduce(&mine, &lowest, 1, MPI_INT, MPI_MIN, communicator), "MPI_Allreduce");
  if (lowest == ranks) return;
  std::string text = outcome.reason;
  int header[2] = {static_cast<int>(outcome.code), static_cast<int>(text.size())};
  check_mpi(MPI_Bcast(header, 2, MPI_INT, lowest, communicator), "MPI_Bcast");
  text.resize(static_cast<std::size_t>(header[1]));
  check_mpi(MPI_Bcast(text.data(), header[1], MPI_CHAR, lowest, communicator), "MPI_Bcast");
  if (header[0] == static_cast<int>(ExitCode::bad_input)) throw InputError(text);
  throw SystemError(text);
}

}  // namespace poreshock
