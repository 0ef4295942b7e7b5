#pragma once
// Pixel (voxel) maps of particle fields: each particle is a square (cube) of its own volume, and a
// pixel takes the mass-weighted mean of the parts of the particles that lie in it.
//
// The same particles give the same bits on any number of ranks and in any order: every contribution
// is rounded to an integer that depends on its particle and the largest value of all, and integers
// are added. Also in deposit.cpp.

#include <mpi.h>
#include <petscdmda.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "poreshock/morphology/minkowski.hpp"

namespace poreshock {

/// Size and sides of a map. Its low corner is the origin of the particle positions, or above it.
template <int Dim>
struct PixelLayout {
  std::array<int, Dim> pixels{};         ///< per axis; the last axis is the shock axis
  double pixel_size = 0.0;               ///< m
  std::array<bool, Dim - 1> periodic{};  ///< lateral axes that wrap
};

/// Owns the PETSc DMDA of a map: dof 1, stencil width 1, whole rows of pixels across the last axis
/// (layers in 3-D) handed out to the ranks from low to high.
template <int Dim>
class PixelGrid {
 public:
  /// Distributes the rows: `rows_per_rank` has one entry per rank, or is empty for PETSc's even
  /// split. Throws InputError when the layout is empty or too large, when there are fewer rows than
  /// ranks, or when rows_per_rank does not give every rank at least one row and use up all rows.
  /// Collective.
  PixelGrid(MPI_Comm communicator, const PixelLayout<Dim>& layout,
            std::span<const int> rows_per_rank = {});
  ~PixelGrid();
  PixelGrid(const PixelGrid&) = delete;
  PixelGrid& operator=(const PixelGrid&) = delete;

  const PixelLayout<Dim>& layout() const { return layout_; }
  MPI_Comm communicator() const { return communicator_; }
  DM dm() const { return dm_; }
  /// First row of each rank, and the number of rows at the end; ranks + 1 entries.
  std::span<const int> row_starts() const { return row_starts_; }
  /// First row of this rank.
  int first_row() const { return row_starts_[static_cast<std::size_t>(rank_)]; }
  /// Rows of this rank.
  int rows() const { return row_starts_[static_cast<std::size_t>(rank_) + 1] - first_row(); }
  /// Pixels in a row (layer).
  std::size_t row_size() const;

 private:
  MPI_Comm communicator_;
  PixelLayout<Dim> layout_;
  std::vector<int> row_starts_;
  int rank_ = 0;
  DM dm_ = nullptr;
};

/// Particles of one rank, as columns of equal length; a particle may lie anywhere.
template <int Dim>
struct PixelSources {
  std::array<std::span<const double>, Dim> position;  ///< m
  std::span<const double> mass;                       ///< kg (per metre of depth in plane strain)
  std::span<const double> density;                    ///< kg/m^3
};

/// Scales of a deposit.
struct PixelScales {
  double density = 1.0;   ///< kg/m^3, a typical density; weights resolve 2^-18 of it
  double max_side = 0.0;  ///< m, largest side of a particle square, which bounds its reach
  double low = 0.0;       ///< pixels, a whole number: place of the map along the shock axis
};

/// A value of a map of particles reaches a threshold from this share of it below: at rest the
/// arithmetic of a run leaves 300 K at 300 K - 1e-13 K.
inline constexpr double map_rounding = 0x1p-31;

/// Fields of a map on the rows of this rank and one row of the upper neighbour.
template <int Dim>
struct PixelField {
  PixelLayout<Dim> layout;                  ///< of the whole map
  int rows = 0;                             ///< rows owned
  bool first = false;                       ///< the lowest rows of the map are here
  bool last = false;                        ///< the highest rows of the map are here
  std::vector<std::vector<double>> values;  ///< per field (rows + 1) x row size; NaN in void pixels
  bool single_precision = false;            ///< the values come from numbers of 32 bits
  double rounding = 0.0;                    ///< share of a value that may be the arithmetic's
  std::vector<std::uint8_t> solid;          ///< (rows + 1) x row size, 1 = material, 0 = void
  std::vector<std::int64_t> coverage;       ///< owned rows: covered area in 2^-18 pixels
  std::int64_t capped = 0;   ///< particles, on all ranks, whose square was cut to max_side
  std::int64_t clamped = 0;  ///< particles' values that were not finite, and densities out of
                             ///< range, on all ranks
  std::int64_t skipped = 0;  ///< particles, on all ranks, without positive finite size and density,
                             ///< or 2^31 pixels and more from the origin
};

/// Coverage of one whole pixel in PixelField::coverage.
inline constexpr std::int64_t full_coverage = std::int64_t{1} << 18;

/// Deposits any number of fields of the same particles at once; `columns` has a value per particle
/// of each. Each particle is a square of side (mass / density)^(1/Dim) centred on it, at most
/// max_side; what lies outside the map is dropped. A pixel is solid when it is covered by half or
/// more, counting overlaps twice; its value is the mean weighted with density times covered area,
/// rounded to 2^-30 of the largest finite value of the field and never outside the values of the
/// particles in the pixel, so that equal ones are kept to the bit. An infinite value counts as the
/// largest finite one, NaN as 0. Throws InputError for columns of unequal length or scales that are
/// not positive, StateError when more than 16384 typical densities pile up in one pixel (on every
/// rank then). Collective; particles may lie on any rank, ghost row filled on return.
template <int Dim>
PixelField<Dim> deposit(const PixelSources<Dim>& particles,
                        const std::vector<std::span<const double>>& columns,
                        const PixelScales& scales, const PixelGrid<Dim>& grid);

/// The block of one field, for count_pixels or count_voxels; valid as long as `map` lives.
/// Not collective.
template <int Dim>
MapBlock<Dim> block(const PixelField<Dim>& map, std::size_t field);

}  // namespace poreshock
