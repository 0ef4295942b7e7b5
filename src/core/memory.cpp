#include "poreshock/core/memory.hpp"

#include <sys/resource.h>
#include <unistd.h>

#include <fstream>

#ifdef __GLIBC__
#include <malloc.h>
#endif

namespace poreshock {

std::int64_t peak_memory() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return std::int64_t{usage.ru_maxrss} * 1024;
}

std::int64_t own_memory() {
  std::ifstream file("/proc/self/statm");
  std::int64_t size = 0, resident = 0, shared = 0;
  file >> size >> resident >> shared;
  return file ? (resident - shared) * sysconf(_SC_PAGESIZE) : 0;
}

void release_freed_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

void return_large_blocks() {
#ifdef __GLIBC__
  mallopt(M_MMAP_MAX, 65536);
  // Larger than the blocks of 512 KiB and a little that HDF5 takes for every file.
  mallopt(M_MMAP_THRESHOLD, 640 << 10);
  mallopt(M_TRIM_THRESHOLD, 16 << 20);
#endif
}

}  // namespace poreshock
