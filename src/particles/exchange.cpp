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

/// Which particles of this rank stay or go to each rank, and how many come from each.
struct Departure {
  std::vector<std::uint32_t> staying;
  std::vector<std::vector<std::uint32_t>> leaving;
  std::vector<std::int64_t> arriving;
};

/// Moves one column: first those that stay, then those of rank 0, 1, ... Collective.
template <class Value>
void move_column(const Departure& departure, std::vector<Value>& column, MPI_Comm communicator) {
  MPI_Datatype unit = make_unit(sizeof(Value));
  std::vector<Value> moved(std::accumulate(departure.arriving.begin(), departure.arriving.end(),
                                           departure.staying.size()));
  for (std::size_t k = 0; k < departure.staying.size(); ++k)
    moved[k] = column[departure.staying[k]];
  std::vector<MPI_Request> requests;
  std::size_t at = departure.staying.size();
  for (std::size_t r = 0; r < departure.arriving.size(); ++r) {
    if (departure.arriving[r] == 0) continue;
    MPI_Irecv(moved.data() + at, static_cast<int>(departure.arriving[r]), unit, static_cast<int>(r),
              30, communicator, &requests.emplace_back());
    at += static_cast<std::size_t>(departure.arriving[r]);
  }
  std::vector<std::vector<Value>> buffers;
  for (std::size_t r = 0; r < departure.leaving.size(); ++r) {
    if (departure.leaving[r].empty()) continue;
    std::vector<Value>& buffer = buffers.emplace_back();
    buffer.reserve(departure.leaving[r].size());
    for (const std::uint32_t p : departure.leaving[r]) buffer.push_back(column[p]);
    MPI_Isend(buffer.data(), static_cast<int>(buffer.size()), unit, static_cast<int>(r), 30,
              communicator, &requests.emplace_back());
  }
  check_mpi(MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE),
            "MPI_Waitall for particles");
  MPI_Type_free(&unit);
  column.swap(moved);
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
  Departure departure;
  departure.leaving.resize(static_cast<std::size_t>(size(communicator)));
  const int me = rank(communicator);
  for (std::size_t p = 0; p < destination.size(); ++p) {
    const int to = destination[p];
    if (to < 0) continue;
    (to == me ? departure.staying : departure.leaving[to]).push_back(static_cast<std::uint32_t>(p));
  }
  std::vector<std::int64_t> sent;
  for (const auto& indices : departure.leaving) {
    sent.push_back(static_cast<std::int64_t>(indices.size()));
  }
  departure.arriving.resize(sent.size());
  check_mpi(MPI_Alltoall(sent.data(), 1, MPI_INT64_T, departure.arriving.data(), 1, MPI_INT64_T,
                         communicator),
            "MPI_Alltoall of particle counts");
  // One column after the other: whole, the particles of a slab that wakes up would be held thrice.
  for_each_column(particles, [&](std::string_view, int, auto& column) {
    move_column(departure, column, communicator);
  });
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
