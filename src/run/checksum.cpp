#include "poreshock/run/checksum.hpp"

#include <cstring>
#include <vector>

#include "poreshock/core/parallel.hpp"

namespace poreshock {

template <int Dim>
std::uint64_t checksum(const Simulation<Dim>& sim) {
  // Each particle is hashed with its id, and the hashes are added: order and rank cannot matter.
  const auto mix = [](std::uint64_t h) {
    h = (h ^ (h >> 30)) * 0xbf58476d1ce4e5b9ULL;
    h = (h ^ (h >> 27)) * 0x94d049bb133111ebULL;
    return h ^ (h >> 31);
  };
  std::vector<std::uint64_t> hash(sim.particles.size(), 0x9e3779b97f4a7c15ULL);
  for_each_column(sim.particles, [&](std::string_view, int, const auto& column) {
    for (std::size_t p = 0; p < hash.size(); ++p) {
      std::uint64_t bits = 0;
      std::memcpy(&bits, &column[p], sizeof(column[p]));
      hash[p] = mix(hash[p] ^ bits) + 0x9e3779b97f4a7c15ULL;
    }
  });
  std::uint64_t total = 0;
  for (const std::uint64_t h : hash) total += mix(h);
  check_mpi(MPI_Allreduce(MPI_IN_PLACE, &total, 1, MPI_UINT64_T, MPI_SUM, sim.communicator),
            "MPI_Allreduce of the checksum");
  return total;
}

template std::uint64_t checksum<2>(const Simulation<2>&);
template std::uint64_t checksum<3>(const Simulation<3>&);

}  // namespace poreshock
