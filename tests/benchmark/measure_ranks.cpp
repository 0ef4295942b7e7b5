// Preloaded into the ranks of a run: counts what each sends, and makes the phases of a run hold CPU
// time instead of wall time, so that ranks may share cores. tools/scaling reads the file that
// PORESHOCK_MEASURE names: one line per rank with messages, bytes and collective operations.
#include <mpi.h>

#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <map>
#include <vector>

namespace {

long messages = 0, collectives = 0;
double bytes = 0.0;
std::map<MPI_Request, double> persistent;

double size_of(int count, MPI_Datatype type) {
  int size = 0;
  PMPI_Type_size(type, &size);
  return static_cast<double>(count) * size;
}

void sent(double size, int to) {
  if (to == MPI_PROC_NULL) return;
  ++messages;
  bytes += size;
}

void started(MPI_Request request) {
  const auto found = persistent.find(request);
  if (found != persistent.end()) sent(found->second, 0);
}

}  // namespace

extern "C" {

double MPI_Wtime() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

int MPI_Send(const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm) {
  sent(size_of(count, type), to);
  return PMPI_Send(data, count, type, to, tag, comm);
}

int MPI_Isend(const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm,
              MPI_Request* request) {
  sent(size_of(count, type), to);
  return PMPI_Isend(data, count, type, to, tag, comm, request);
}

int MPI_Sendrecv(const void* data, int count, MPI_Datatype type, int to, int tag, void* into,
                 int room, MPI_Datatype into_type, int from, int from_tag, MPI_Comm comm,
                 MPI_Status* status) {
  sent(size_of(count, type), to);
  return PMPI_Sendrecv(data, count, type, to, tag, into, room, into_type, from, from_tag, comm,
                       status);
}

int MPI_Send_init(const void* data, int count, MPI_Datatype type, int to, int tag, MPI_Comm comm,
                  MPI_Request* request) {
  const int result = PMPI_Send_init(data, count, type, to, tag, comm, request);
  persistent[*request] = size_of(count, type);
  return result;
}

int MPI_Start(MPI_Request* request) {
  started(*request);
  return PMPI_Start(request);
}

int MPI_Startall(int count, MPI_Request* requests) {
  for (int k = 0; k < count; ++k) started(requests[k]);
  return PMPI_Startall(count, requests);
}

int MPI_Allreduce(const void* from, void* to, int count, MPI_Datatype type, MPI_Op operation,
                  MPI_Comm comm) {
  ++collectives;
  return PMPI_Allreduce(from, to, count, type, operation, comm);
}

int MPI_Bcast(void* data, int count, MPI_Datatype type, int root, MPI_Comm comm) {
  ++collectives;
  return PMPI_Bcast(data, count, type, root, comm);
}

int MPI_Finalize() {
  int me = 0, ranks = 1;
  PMPI_Comm_rank(MPI_COMM_WORLD, &me);
  PMPI_Comm_size(MPI_COMM_WORLD, &ranks);
  const double mine[3] = {static_cast<double>(messages), bytes, static_cast<double>(collectives)};
  std::vector<double> all(static_cast<std::size_t>(3 * ranks));
  PMPI_Gather(mine, 3, MPI_DOUBLE, all.data(), 3, MPI_DOUBLE, 0, MPI_COMM_WORLD);
  const char* path = std::getenv("PORESHOCK_MEASURE");
  std::FILE* file = me == 0 && path != nullptr ? std::fopen(path, "w") : nullptr;
  if (file != nullptr) {
    for (int r = 0; r < ranks; ++r) {
      std::fprintf(file, "%.0f %.0f %.0f\n", all[3 * r], all[3 * r + 1], all[3 * r + 2]);
    }
    std::fclose(file);
  }
  return PMPI_Finalize();
}

}  // extern "C"
