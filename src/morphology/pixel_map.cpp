#include "poreshock/morphology/pixel_map.hpp"

#include <limits>
#include <string>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"

namespace poreshock {
namespace {

template <int Dim>
void check_layout(const PixelLayout<Dim>& layout, int ranks) {
  std::int64_t total = 1;
  for (const int pixels : layout.pixels) {
    if (pixels < 1) {
      throw InputError("the pixel map has " + std::to_string(pixels) +
                       " pixels along one axis; it needs at least 1. Use smaller pixels.");
    }
    // The test comes before the product can leave 64 bits.
    total *= pixels;
    if (total > std::numeric_limits<PetscInt>::max()) {
      throw InputError("the pixel map has more pixels than PETSc can number, " +
                       std::to_string(std::numeric_limits<PetscInt>::max()) +
                       ". Use larger pixels, or a PETSc with 64-bit indices.");
    }
  }
  if (!(layout.pixel_size > 0.0)) {
    throw InputError("the pixel size is " + std::to_string(layout.pixel_size) +
                     " m; it must be positive.");
  }
  if (layout.pixels[Dim - 1] < ranks) {
    throw InputError("the pixel map has " + std::to_string(layout.pixels[Dim - 1]) +
                     " rows across the shock axis for " + std::to_string(ranks) +
                     " ranks; every rank needs at least one row. Use smaller pixels or at most " +
                     std::to_string(layout.pixels[Dim - 1]) + " ranks.");
  }
}

std::vector<PetscInt> checked_rows(std::span<const int> rows_per_rank, int rows, int ranks) {
  std::int64_t total = 0;
  bool each = true;
  for (const int count : rows_per_rank) {
    total += count;
    each = each && count > 0;
  }
  if (static_cast<int>(rows_per_rank.size()) != ranks || total != rows || !each) {
    throw InputError("the rows per rank are " + std::to_string(rows_per_rank.size()) +
                     " numbers that add up to " + std::to_string(total) + "; a pixel map of " +
                     std::to_string(rows) + " rows on " + std::to_string(ranks) +
                     " ranks needs one number of at least 1 row per rank, and all rows used.");
  }
  return {rows_per_rank.begin(), rows_per_rank.end()};
}

template <int Dim>
DM make_dm(MPI_Comm communicator, const std::array<int, Dim>& pixels, const PetscInt* rows) {
  const DMBoundaryType none = DM_BOUNDARY_NONE;
  const PetscInt ranks = size(communicator);
  DM dm = nullptr;
  if constexpr (Dim == 2) {
    check_petsc(DMDACreate2d(communicator, none, none, DMDA_STENCIL_BOX, pixels[0], pixels[1], 1,
                             ranks, 1, 1, nullptr, rows, &dm),
                "DMDACreate2d");
  } else {
    check_petsc(DMDACreate3d(communicator, none, none, none, DMDA_STENCIL_BOX, pixels[0], pixels[1],
                             pixels[2], 1, 1, ranks, 1, 1, nullptr, nullptr, rows, &dm),
                "DMDACreate3d");
  }
  const PetscErrorCode code = DMSetUp(dm);
  if (code != 0) DMDestroy(&dm);
  check_petsc(code, "DMSetUp");
  return dm;
}

template <int Dim>
std::vector<int> find_row_starts(DM dm) {
  const PetscInt* counts = nullptr;
  if constexpr (Dim == 2) {
    check_petsc(DMDAGetOwnershipRanges(dm, nullptr, &counts, nullptr), "DMDAGetOwnershipRanges");
  } else {
    check_petsc(DMDAGetOwnershipRanges(dm, nullptr, nullptr, &counts), "DMDAGetOwnershipRanges");
  }
  const int ranks = size(PetscObjectComm(reinterpret_cast<PetscObject>(dm)));
  std::vector<int> starts(static_cast<std::size_t>(ranks) + 1, 0);
  for (std::size_t r = 0; r + 1 < starts.size(); ++r) {
    starts[r + 1] = starts[r] + static_cast<int>(counts[r]);
  }
  return starts;
}

}  // namespace

template <int Dim>
PixelGrid<Dim>::PixelGrid(MPI_Comm communicator, const PixelLayout<Dim>& layout,
                          std::span<const int> rows_per_rank)
    : communicator_(communicator), layout_(layout), rank_(rank(communicator)) {
  const int ranks = size(communicator);
  check_layout(layout, ranks);
  std::vector<PetscInt> rows;
  if (!rows_per_rank.empty()) rows = checked_rows(rows_per_rank, layout.pixels[Dim - 1], ranks);
  dm_ = make_dm<Dim>(communicator, layout.pixels, rows.empty() ? nullptr : rows.data());
  row_starts_ = find_row_starts<Dim>(dm_);
}

template <int Dim>
PixelGrid<Dim>::~PixelGrid() {
  DMDestroy(&dm_);
}

template <int Dim>
std::size_t PixelGrid<Dim>::row_size() const {
  std::size_t result = 1;
  for (std::size_t axis = 0; axis + 1 < Dim; ++axis) {
    result *= static_cast<std::size_t>(layout_.pixels[axis]);
  }
  return result;
}

template <int Dim>
MapBlock<Dim> block(const PixelField<Dim>& map, std::size_t field) {
  MapBlock<Dim> result;
  if constexpr (Dim == 2) {
    result.width = map.layout.pixels[0];
    result.rows = map.rows;
    result.periodic = map.layout.periodic[0];
  } else {
    result.width = {map.layout.pixels[0], map.layout.pixels[1]};
    result.layers = map.rows;
    result.periodic = map.layout.periodic;
  }
  result.first = map.first;
  result.last = map.last;
  result.values = map.values.at(field);
  result.solid = map.solid;
  return result;
}

template class PixelGrid<2>;
template class PixelGrid<3>;
template PixelBlock block<2>(const PixelField<2>&, std::size_t);
template VoxelBlock block<3>(const PixelField<3>&, std::size_t);

}  // namespace poreshock
