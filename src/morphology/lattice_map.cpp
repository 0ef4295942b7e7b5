#include "poreshock/morphology/lattice_map.hpp"

#include <algorithm>
#include <limits>
#include <string>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"

namespace poreshock {
namespace {

/// Indices of the particles that go to each rank, rank after rank.
struct Outgoing {
  std::vector<std::uint32_t> particles;
  std::vector<int> counts;
};

/// Particles by rank: the owner of their row and, for a first row, the rank below, whose ghost row
/// it is.
Outgoing sort_by_rank(std::span<const std::int64_t> id, std::size_t row_size,
                      std::span<const int> row_starts) {
  const std::size_t ranks = row_starts.size() - 1;
  std::vector<std::vector<std::uint32_t>> lists(ranks);
  for (std::size_t i = 0; i < id.size(); ++i) {
    const auto row = static_cast<int>(id[i] / static_cast<std::int64_t>(row_size));
    const auto above = std::upper_bound(row_starts.begin(), row_starts.end(), row);
    const auto owner = static_cast<std::size_t>(above - row_starts.begin()) - 1;
    lists[owner].push_back(static_cast<std::uint32_t>(i));
    if (owner > 0 && row == row_starts[owner]) {
      lists[owner - 1].push_back(static_cast<std::uint32_t>(i));
    }
  }
  Outgoing outgoing;
  for (const auto& list : lists) {
    outgoing.particles.insert(outgoing.particles.end(), list.begin(), list.end());
    outgoing.counts.push_back(static_cast<int>(list.size()));
  }
  return outgoing;
}

std::vector<int> offsets(const std::vector<int>& counts) {
  std::vector<int> result = {0};
  for (const int count : counts) result.push_back(result.back() + count);
  return result;
}

/// Exchanges one column of particles.
template <class T>
std::vector<T> exchange(std::span<const T> column, const Outgoing& outgoing,
                        const std::vector<int>& incoming, MPI_Datatype type,
                        MPI_Comm communicator) {
  std::vector<T> sent;
  for (const std::uint32_t particle : outgoing.particles) sent.push_back(column[particle]);
  const std::vector<int> from = offsets(incoming);
  const std::vector<int> to = offsets(outgoing.counts);
  std::vector<T> received(static_cast<std::size_t>(from.back()));
  check_mpi(MPI_Alltoallv(sent.data(), outgoing.counts.data(), to.data(), type, received.data(),
                          incoming.data(), from.data(), type, communicator),
            "MPI_Alltoallv");
  return received;
}

void check_ids(std::span<const std::int64_t> id, std::int64_t sites, MPI_Comm communicator) {
  std::int64_t outside = 0;
  for (const std::int64_t site : id) outside += site < 0 || site >= sites ? 1 : 0;
  outside = sum(outside, communicator);
  if (outside == 0) return;
  throw InputError(std::to_string(outside) + " particles have a number outside the lattice of " +
                   std::to_string(sites) + " sites");
}

}  // namespace

template <int Dim>
PixelField<Dim> place_on_lattice(std::span<const std::int64_t> id,
                                 const std::vector<std::span<const double>>& columns,
                                 const PixelGrid<Dim>& grid) {
  const MPI_Comm communicator = grid.communicator();
  const std::size_t row_size = grid.row_size();
  const auto row_sites = static_cast<std::int64_t>(row_size);
  check_ids(id, row_sites * grid.layout().pixels[Dim - 1], communicator);
  const Outgoing outgoing = sort_by_rank(id, row_size, grid.row_starts());
  std::vector<int> incoming(outgoing.counts.size());
  check_mpi(
      MPI_Alltoall(outgoing.counts.data(), 1, MPI_INT, incoming.data(), 1, MPI_INT, communicator),
      "MPI_Alltoall");
  const auto sites = exchange<std::int64_t>(id, outgoing, incoming, MPI_INT64_T, communicator);

  PixelField<Dim> map;
  map.layout = grid.layout();
  map.rounding = map_rounding;
  map.rows = grid.rows();
  map.first = grid.first_row() == 0;
  map.last = grid.first_row() + grid.rows() == map.layout.pixels[Dim - 1];
  const std::size_t stored = static_cast<std::size_t>(map.rows + 1) * row_size;
  const std::int64_t first_site = row_sites * grid.first_row();
  map.solid.assign(stored, 0);
  map.coverage.assign(static_cast<std::size_t>(map.rows) * row_size, 0);
  for (const std::int64_t site : sites) {
    const auto at = static_cast<std::size_t>(site - first_site);
    map.solid[at] = 1;
    if (at < map.coverage.size()) map.coverage[at] = full_coverage;
  }
  for (const std::span<const double> column : columns) {
    const auto values = exchange<double>(column, outgoing, incoming, MPI_DOUBLE, communicator);
    std::vector<double>& field =
        map.values.emplace_back(stored, std::numeric_limits<double>::quiet_NaN());
    for (std::size_t i = 0; i < sites.size(); ++i) {
      field[static_cast<std::size_t>(sites[i] - first_site)] = values[i];
    }
  }
  return map;
}

template PixelField<2> place_on_lattice<2>(std::span<const std::int64_t>,
                                           const std::vector<std::span<const double>>&,
                                           const PixelGrid<2>&);
template PixelField<3> place_on_lattice<3>(std::span<const std::int64_t>,
                                           const std::vector<std::span<const double>>&,
                                           const PixelGrid<3>&);

}  // namespace poreshock
