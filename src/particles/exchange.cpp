#include "poreshock/particles/exchange.hpp"

#include <algorithm>
#include <numeric>

#include "poreshock/core/parallel.hpp"

namespace poreshock {

namespace {

/// Removes the particles at `holes` (any order, distinct) by moving the last ones into their
/// places.
template <int Dim>
void remove(std::vector<std::uint32_t> holes, Particles<Dim>& particles) {
  if (holes.empty()) return;
  std::sort(holes.begin(), holes.end());
  const std::size_t kept = particles.size() - holes.size();
  std::vector<std::uint32_t> from;
  for (std::size_t p = kept; p < particles.size(); ++p) {
    if (!std::binary_search(holes.begin(), holes.end(), static_cast<std::uint32_t>(p))) {
      from.push_back(static_cast<std::uint32_t>(p));
    }
  }
  for_each_column(particles, [&](std::string_view, int, auto& column) {
    for (std::size_t k = 0; k < from.size(); ++k) column[holes[k]] = column[from[k]];
  });
  resize(particles, kept);
}

}  // namespace

template <int Dim>
void exchange_with_neighbours(const std::vector<std::uint32_t>& down,
                              const std::vector<std::uint32_t>& up,
                              const std::vector<std::uint32_t>& gone, Particles<Dim>& particles,
                              MPI_Comm communicator) {
  const std::size_t bytes = bytes_per_particle(particles);
  std::vector<std::byte> to_below, to_above;
  pack(particles, down, to_below);
  pack(particles, up, to_above);
  std::vector<std::uint32_t> holes = down;
  holes.insert(holes.end(), up.begin(), up.end());
  holes.insert(holes.end(), gone.begin(), gone.end());
  remove(std::move(holes), particles);
  if (size(communicator) == 1) return;
  const auto from = swap_with_neighbours(to_below, to_above, bytes, 10, communicator);
  unpack(from.above.data(), from.above.size() / bytes, particles);
  unpack(from.below.data(), from.below.size() / bytes, particles);
}

template <int Dim>
void redistribute(const std::vector<int>& destination, Particles<Dim>& particles,
                  MPI_Comm communicator) {
  const int ranks = size(communicator);
  const std::size_t bytes = bytes_per_particle(particles);
  const int me = rank(communicator);
  std::vector<std::vector<std::uint32_t>> leaving(static_cast<std::size_t>(ranks));
  std::vector<std::uint32_t> holes;
  for (std::size_t p = 0; p < destination.size(); ++p) {
    if (destination[p] == me) continue;
    holes.push_back(static_cast<std::uint32_t>(p));
    if (destination[p] >= 0) leaving[destination[p]].push_back(holes.back());
  }
  std::vector<std::int64_t> sent, received(static_cast<std::size_t>(ranks));
  for (const auto& indices : leaving) sent.push_back(static_cast<std::int64_t>(indices.size()));
  check_mpi(
      MPI_Alltoall(sent.data(), 1, MPI_INT64_T, received.data(), 1, MPI_INT64_T, communicator),
      "MPI_Alltoall of particle counts");
  MPI_Datatype unit = make_unit(bytes);
  std::vector<std::vector<std::byte>> buffers(static_cast<std::size_t>(ranks));
  std::vector<std::vector<std::byte>> arrived(static_cast<std::size_t>(ranks));
  std::vector<MPI_Request> requests;
  for (int r = 0; r < ranks; ++r) {
    arrived[r].resize(static_cast<std::size_t>(received[r]) * bytes);
    if (received[r] == 0) continue;
    requests.emplace_back();
    MPI_Irecv(arrived[r].data(), static_cast<int>(received[r]), unit, r, 30, communicator,
              &requests.back());
  }
  for (int r = 0; r < ranks; ++r) {
    if (leaving[r].empty()) continue;
    pack(particles, leaving[r], buffers[r]);
    requests.emplace_back();
    MPI_Isend(buffers[r].data(), static_cast<int>(sent[r]), unit, r, 30, communicator,
              &requests.back());
  }
  check_mpi(MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE),
            "MPI_Waitall for particles");
  MPI_Type_free(&unit);
  buffers.clear();
  remove(std::move(holes), particles);
  for (int r = 0; r < ranks; ++r) {
    unpack(arrived[r].data(), static_cast<std::size_t>(received[r]), particles);
    std::vector<std::byte>().swap(arrived[r]);
  }
}

template void redistribute<2>(const std::vector<int>&, Particles<2>&, MPI_Comm);
template void redistribute<3>(const std::vector<int>&, Particles<3>&, MPI_Comm);
template void exchange_with_neighbours<2>(const std::vector<std::uint32_t>&,
                                          const std::vector<std::uint32_t>&,
                                          const std::vector<std::uint32_t>&, Particles<2>&,
                                          MPI_Comm);
template void exchange_with_neighbours<3>(const std::vector<std::uint32_t>&,
                                          const std::vector<std::uint32_t>&,
                                          const std::vector<std::uint32_t>&, Particles<3>&,
                                          MPI_Comm);

}  // namespace poreshock
