#pragma once
// MPI and PETSc: start and end, and the few collectives the program uses.

#include <mpi.h>

#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

namespace poreshock {

/// Starts MPI and PETSc and ends them when it goes out of scope. Collective.
class Runtime {
 public:
  Runtime(int& argc, char**& argv);
  ~Runtime();
  Runtime(const Runtime&) = delete;
  Runtime& operator=(const Runtime&) = delete;

  MPI_Comm communicator() const { return MPI_COMM_WORLD; }
};

/// Rank of this process. Not collective.
int rank(MPI_Comm communicator);
/// Number of ranks. Not collective.
int size(MPI_Comm communicator);

/// Throws RankError with the text of a PETSc error code when it is not zero. Not collective.
void check_petsc(int code, const char* what);
/// Throws RankError with the text of an MPI error code when it is not MPI_SUCCESS. Not
/// collective.
void check_mpi(int code, const char* what);

/// Largest value over all ranks. Collective.
int largest(int value, MPI_Comm communicator);
/// Sum over all ranks, exact. Collective.
std::int64_t sum(std::int64_t value, MPI_Comm communicator);
/// Sums element by element over all ranks, exact. Collective.
void sum(std::vector<std::int64_t>& values, MPI_Comm communicator);
/// Copies rank 0's text to all ranks. Collective.
void broadcast(std::string& text, MPI_Comm communicator);

/// MPI type of so many bytes, so that counts of items stay below 2^31; the caller frees it.
MPI_Datatype make_unit(std::size_t bytes);

/// What all ranks have, rank after rank; at most 2^31 items in all. Collective.
template <class Item>
std::vector<Item> gather_all(const std::vector<Item>& mine, MPI_Comm communicator) {
  const int own = static_cast<int>(mine.size());
  std::vector<int> counts(static_cast<std::size_t>(size(communicator)));
  check_mpi(MPI_Allgather(&own, 1, MPI_INT, counts.data(), 1, MPI_INT, communicator),
            "MPI_Allgather");
  std::vector<int> starts(counts.size());
  std::exclusive_scan(counts.begin(), counts.end(), starts.begin(), 0);
  std::vector<Item> all(static_cast<std::size_t>(starts.back() + counts.back()));
  MPI_Datatype unit = make_unit(sizeof(Item));
  check_mpi(MPI_Allgatherv(mine.data(), own, unit, all.data(), counts.data(), starts.data(), unit,
                           communicator),
            "MPI_Allgatherv");
  MPI_Type_free(&unit);
  return all;
}

/// True when all ranks call this within so many seconds of each other; false on those that waited
/// in vain, after which the communicator is of no more use to them. Collective over a communicator
/// that nothing else uses.
bool all_arrive(double seconds, MPI_Comm communicator);

/// Program version, for example "0.1.0".
std::string version();
/// Source revision the program was built from.
std::string revision();

/// Sends items one way along the ranks and receives those that come from the other side; `to` and
/// `from` may be MPI_PROC_NULL. `per_unit` of them travel as one unit, of which there may be 2^31.
/// Uses the tags `tag` and tag + 1. Collective (neighbours).
template <class Item>
std::vector<Item> shift(const std::vector<Item>& sent, std::size_t per_unit, int to, int from,
                        int tag, MPI_Comm communicator) {
  std::int64_t outgoing = static_cast<std::int64_t>(sent.size() / per_unit), incoming = 0;
  check_mpi(MPI_Sendrecv(&outgoing, 1, MPI_INT64_T, to, tag, &incoming, 1, MPI_INT64_T, from, tag,
                         communicator, MPI_STATUS_IGNORE),
            "MPI_Sendrecv of counts");
  std::vector<Item> received(static_cast<std::size_t>(incoming) * per_unit);
  MPI_Datatype unit = make_unit(per_unit * sizeof(Item));
  check_mpi(MPI_Sendrecv(sent.data(), static_cast<int>(outgoing), unit, to, tag + 1,
                         received.data(), static_cast<int>(incoming), unit, from, tag + 1,
                         communicator, MPI_STATUS_IGNORE),
            "MPI_Sendrecv of items");
  MPI_Type_free(&unit);
  return received;
}

/// What came from the ranks next to this one; empty where there is none.
template <class Item>
struct FromNeighbours {
  std::vector<Item> below, above;
};

/// Sends items to the rank below and to the one above, as shift() does, and receives theirs. Uses
/// the tags `tag` ... tag + 3. Collective (neighbours).
template <class Item>
FromNeighbours<Item> swap_with_neighbours(const std::vector<Item>& to_below,
                                          const std::vector<Item>& to_above, std::size_t per_unit,
                                          int tag, MPI_Comm communicator) {
  const int me = rank(communicator);
  const int below = me > 0 ? me - 1 : MPI_PROC_NULL;
  const int above = me + 1 < size(communicator) ? me + 1 : MPI_PROC_NULL;
  FromNeighbours<Item> result;
  result.above = shift(to_below, per_unit, below, above, tag, communicator);
  result.below = shift(to_above, per_unit, above, below, tag + 2, communicator);
  return result;
}

}  // namespace poreshock
