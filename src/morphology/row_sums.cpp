#include "row_sums.hpp"

#include <algorithm>
#include <array>

#include "poreshock/core/parallel.hpp"

namespace poreshock {
namespace {

/// Rows that two ranges share; begin >= end where there are none.
struct RowRange {
  int begin = 0;
  int end = 0;
};

RowRange shared_rows(const RowRange& a, const RowRange& b) {
  return {std::max(a.begin, b.begin), std::min(a.end, b.end)};
}

void add_rows(const std::uint64_t* source, const RowRange& range, RowSums& target) {
  std::uint64_t* sums = target.row(range.begin);
  const std::size_t count = static_cast<std::size_t>(range.end - range.begin) * target.row_length;
  for (std::size_t p = 0; p < count; p += target.components) {
    for (std::size_t k = p; k < p + first_sum; ++k) sums[k] += source[k];
    for (std::size_t k = p + first_sum; k < p + target.components; k += 2) {
      sums[k] += source[k];
      sums[k + 1] = std::max(sums[k + 1], source[k + 1]);
    }
  }
}

/// MPI type of one row, so that message lengths are rows and fit an int.
class RowType {
 public:
  explicit RowType(std::size_t length) {
    check_mpi(MPI_Type_contiguous(static_cast<int>(length), MPI_UINT64_T, &type),
              "MPI_Type_contiguous");
    check_mpi(MPI_Type_commit(&type), "MPI_Type_commit");
  }
  ~RowType() { MPI_Type_free(&type); }
  RowType(const RowType&) = delete;
  RowType& operator=(const RowType&) = delete;

  MPI_Datatype type = MPI_DATATYPE_NULL;
};

/// Row ranges of the bands of all ranks. Collective.
std::vector<RowRange> gather_bands(const RowSums& band, std::size_t ranks, MPI_Comm communicator) {
  static_assert(sizeof(RowRange) == 2 * sizeof(int));
  const RowRange mine = {band.first, band.first + band.rows};
  std::vector<RowRange> bands(ranks);
  check_mpi(MPI_Allgather(&mine, 2, MPI_INT, bands.data(), 2, MPI_INT, communicator),
            "MPI_Allgather");
  return bands;
}

}  // namespace

RowSums send_to_owners(const RowSums& band, std::span<const int> row_starts,
                       MPI_Comm communicator) {
  constexpr int tag = 1801;
  const std::size_t ranks = row_starts.size() - 1;
  const auto self = static_cast<std::size_t>(rank(communicator));
  const std::vector<RowRange> bands = gather_bands(band, ranks, communicator);
  const RowRange mine = {row_starts[self], row_starts[self + 1]};
  const RowType row_type(band.row_length);

  struct Incoming {
    RowRange range;
    std::vector<std::uint64_t> data;
  };
  std::vector<Incoming> incoming;
  std::vector<MPI_Request> requests;
  for (std::size_t r = 0; r < ranks; ++r) {
    const RowRange range = shared_rows(bands[r], mine);
    if (r == self || range.begin >= range.end) continue;
    const int count = range.end - range.begin;
    incoming.push_back(
        {range, std::vector<std::uint64_t>(static_cast<std::size_t>(count) * band.row_length)});
    check_mpi(MPI_Irecv(incoming.back().data.data(), count, row_type.type, static_cast<int>(r), tag,
                        communicator, &requests.emplace_back()),
              "MPI_Irecv");
  }
  for (std::size_t r = 0; r < ranks; ++r) {
    const RowRange range = shared_rows(bands[self], {row_starts[r], row_starts[r + 1]});
    if (r == self || range.begin >= range.end) continue;
    check_mpi(MPI_Isend(band.row(range.begin), range.end - range.begin, row_type.type,
                        static_cast<int>(r), tag, communicator, &requests.emplace_back()),
              "MPI_Isend");
  }

  RowSums owned(mine.begin, mine.end - mine.begin, band.row_length / band.components,
                band.components);
  const RowRange kept = shared_rows(bands[self], mine);
  if (kept.begin < kept.end) add_rows(band.row(kept.begin), kept, owned);
  check_mpi(MPI_Waitall(static_cast<int>(requests.size()), requests.data(), MPI_STATUSES_IGNORE),
            "MPI_Waitall");
  for (const Incoming& part : incoming) add_rows(part.data.data(), part.range, owned);
  return owned;
}

}  // namespace poreshock
