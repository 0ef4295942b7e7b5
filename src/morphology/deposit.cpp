// Deposit of particles into a map, in three parts: overlaps of squares and pixels, sums of rows
// sent to their owners, means and the ghost row.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "add_squares.hpp"
#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/morphology/pixel_map.hpp"
#include "row_sums.hpp"
#include "squares.hpp"

// Values. A field is rounded down to multiples of a power of two, 2^-31 of its largest value, so
// the map knows nothing of what will be asked of it. The mean of what was rounded down lies at most
// one quantum below the mean, and is lifted to the least value in the pixel: so it lies between the
// least and the largest, and uniform material keeps its value to the bit.
//
// Range of the sums. A value is an integer |v| <= 2^31, so |sum of W v| <= (sum of W) 2^31, which
// stays below 2^63 as long as sum of W < 2^32, that is 2^14 typical densities in one pixel. One
// contribution has W <= 2^24 (density held to 64 typical densities), so the sum of W itself is
// right for any number of particles below 2^39, and looking at it afterwards finds every overflow.
// Sums are unsigned: arithmetic modulo 2^64 is defined, and right whenever the result is in range.

namespace poreshock {
namespace {

constexpr std::uint64_t weight_sum_limit = std::uint64_t{1} << 32;

/// Rows of the map that the particles of this rank may touch.
template <int Dim>
RowSums make_band(const PixelSources<Dim>& particles, std::size_t components,
                  const PixelScales& scales, const PixelGrid<Dim>& grid) {
  const int rows = grid.layout().pixels[Dim - 1];
  const double most = place_limit * grid.layout().pixel_size;  // beyond, a particle is skipped
  double low = most;
  double high = -most;
  for (const double y : particles.position[Dim - 1]) {
    low = y < low && y > -most ? y : low;
    high = y > high && y < most ? y : high;
  }
  const double reach = 0.5 * scales.max_side;
  const auto row_at = [&](double y) {
    return std::clamp(y / grid.layout().pixel_size - scales.low, 0.0, static_cast<double>(rows));
  };
  // One row more at each end: the rounding here is not that of the squares.
  const int first = std::max(static_cast<int>(std::floor(row_at(low - reach))) - 1, 0);
  const int end = std::min(static_cast<int>(std::ceil(row_at(high + reach))) + 1, rows);
  return RowSums(first, std::max(end - first, 0), grid.row_size(), components);
}

/// Adds the particle with number i of a stretch.
template <int Dim, std::size_t Fields>
void add_particle(const Squares<Dim>& squares, std::size_t i, const Content<Fields>& content,
                  const PixelLayout<Dim>& layout, std::array<Overlaps, Dim>& overlaps,
                  RowSums& band) {
  if constexpr (Dim == 2) {
    if (add_small_square({squares.low[0][i], squares.high[0][i]},
                         {squares.low[1][i], squares.high[1][i]}, layout.pixels, content, band)) {
      return;
    }
  }
  for (std::size_t axis = 0; axis < Dim; ++axis) {
    const bool periodic = axis + 1 < Dim && layout.periodic[std::min<std::size_t>(axis, Dim - 2)];
    find_overlaps({squares.low[axis][i], squares.high[axis][i]}, layout.pixels[axis], periodic,
                  overlaps[axis]);
  }
  add_square<Dim>(overlaps, layout.pixels[0], content, band);
}

/// The rounding of every field. Collective.
std::vector<ValueRounding> find_roundings(const std::vector<std::span<const double>>& columns,
                                          MPI_Comm communicator) {
  std::vector<double> largest(columns.size(), 0.0);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    for (const double value : columns[k]) {
      const double size = std::abs(value);
      const bool larger = size > largest[k] && size <= std::numeric_limits<double>::max();
      largest[k] = larger ? size : largest[k];
    }
  }
  check_mpi(MPI_Allreduce(MPI_IN_PLACE, largest.data(), static_cast<int>(largest.size()),
                          MPI_DOUBLE, MPI_MAX, communicator),
            "MPI_Allreduce");
  std::vector<ValueRounding> roundings;
  for (const double value : largest) roundings.push_back(rounding_of(value));
  return roundings;
}

/// Adds a stretch of particles, whose addends stand field after field.
template <int Dim, std::size_t Fields>
void add_stretch(const Squares<Dim>& squares, std::size_t count, std::span<const Addend> addends,
                 const PixelLayout<Dim>& layout, std::array<Overlaps, Dim>& overlaps,
                 RowSums& band) {
  constexpr std::size_t stretch = Squares<Dim>::stretch;
  std::vector<Addend> own(addends.size() / stretch);
  for (std::size_t i = 0; i < count; ++i) {
    if (squares.usable[i] == 0) continue;
    for (std::size_t k = 0; k < own.size(); ++k) own[k] = addends[k * stretch + i];
    const Content<Fields> content{squares.density[i],
                                  std::span<const Addend, Fields>(own.begin(), own.end())};
    add_particle<Dim>(squares, i, content, layout, overlaps, band);
  }
}

template <int Dim>
RowSums sum_particles(const PixelSources<Dim>& particles,
                      const std::vector<std::span<const double>>& columns,
                      std::span<const ValueRounding> roundings, const PixelScales& scales,
                      const PixelGrid<Dim>& grid, Counters& counters) {
  constexpr std::size_t stretch = Squares<Dim>::stretch;
  const PixelLayout<Dim>& layout = grid.layout();
  const std::size_t fields = columns.size();
  RowSums band = make_band(particles, first_sum + 2 * fields, scales, grid);
  std::array<Overlaps, Dim> overlaps;
  overlaps.fill(make_overlaps(scales.max_side / layout.pixel_size));
  Squares<Dim> squares;
  std::vector<Addend> addends(fields * stretch);
  for (std::size_t first = 0; first < particles.mass.size(); first += stretch) {
    const std::size_t count = std::min(stretch, particles.mass.size() - first);
    make_squares(particles, first, count, scales, layout.pixel_size, squares, counters);
    for (std::size_t k = 0; k < fields; ++k) {
      counters.clamped += round_values(columns[k].subspan(first, count), roundings[k],
                                       squares.usable.data(), addends.data() + k * stretch);
    }
    if (fields == 1) {
      add_stretch<Dim, 1>(squares, count, addends, layout, overlaps, band);
    } else if (fields == 2) {
      add_stretch<Dim, 2>(squares, count, addends, layout, overlaps, band);
    } else {
      add_stretch<Dim, std::dynamic_extent>(squares, count, addends, layout, overlaps, band);
    }
  }
  return band;
}

void check_columns(std::size_t found, std::size_t expected, const char* name) {
  if (found == expected) return;
  throw InputError("the deposit got " + std::to_string(found) + " entries of " + name + " for " +
                   std::to_string(expected) + " particles; every column has one per particle.");
}

void check_positive(double value, const char* name) {
  if (value > 0.0 && std::isfinite(value)) return;
  throw InputError("the deposit got " + std::to_string(value) + " as its " + name +
                   "; it must be positive and finite.");
}

template <int Dim>
void check_input(const PixelSources<Dim>& particles,
                 const std::vector<std::span<const double>>& columns, const PixelScales& scales) {
  const std::size_t count = particles.mass.size();
  if (columns.empty()) throw InputError("the deposit got no values; it needs at least one field.");
  check_columns(particles.density.size(), count, "density");
  for (const auto& column : particles.position) check_columns(column.size(), count, "position");
  for (const auto& column : columns) check_columns(column.size(), count, "a value");
  check_positive(scales.density, "density scale (kg/m^3)");
  check_positive(scales.max_side, "largest particle side (m)");
}

/// Adds the counters over the ranks and stops all of them when a sum may have overflowed.
template <int Dim>
void share_counters(const Counters& counters, const RowSums& sums, MPI_Comm communicator,
                    PixelField<Dim>& map) {
  std::int64_t piled = 0;
  for (std::size_t p = 1; p < sums.data.size(); p += sums.components) {
    piled += sums.data[p] >= weight_sum_limit ? 1 : 0;
  }
  std::vector<std::int64_t> shared = {counters.capped, counters.clamped, counters.skipped, piled};
  sum(shared, communicator);
  map.capped = shared[0];
  map.clamped = shared[1];
  map.skipped = shared[2];
  if (shared[3] == 0) return;
  throw StateError("particles pile up in " + std::to_string(shared[3]) +
                   " pixels of the map: more than 16384 typical densities in one pixel. Check the "
                   "positions and densities of the particles, and the density scale.");
}

/// Means of the owned pixels and NaN where less than half of a pixel is covered.
template <int Dim>
void take_means(const RowSums& sums, std::span<const ValueRounding> roundings,
                PixelField<Dim>& map) {
  const std::size_t pixels = sums.data.size() / sums.components;
  map.coverage.resize(pixels);
  for (std::size_t p = 0; p < pixels; ++p) {
    const std::uint64_t* pixel = sums.data.data() + p * sums.components;
    map.coverage[p] = static_cast<std::int64_t>(pixel[0]);
    const auto weight = static_cast<std::int64_t>(pixel[1]);
    // A covered pixel whose weight is rounded to nothing has no mean.
    const bool solid = 2 * map.coverage[p] >= full_coverage && weight > 0;
    map.solid[p] = solid ? 1 : 0;
    if (!solid) continue;
    for (std::size_t k = 0; k < roundings.size(); ++k) {
      // Whole part and remainder apart, so that the sum of large numbers loses no digits.
      const auto total = static_cast<std::int64_t>(pixel[first_sum + 2 * k]);
      const std::int64_t whole = total / weight;
      const double mean = static_cast<double>(whole) +
                          static_cast<double>(total % weight) / static_cast<double>(weight);
      const double least = value_of_key(pixel[first_sum + 2 * k + 1]);
      map.values[k][p] = std::max(least, mean * roundings[k].quantum);
    }
  }
}

/// Borrows a global and a local vector from a DM and gives them back.
class BorrowedVectors {
 public:
  explicit BorrowedVectors(DM dm) : dm_(dm) {
    check_petsc(DMGetGlobalVector(dm_, &global), "DMGetGlobalVector");
    check_petsc(DMGetLocalVector(dm_, &local), "DMGetLocalVector");
  }
  ~BorrowedVectors() {
    DMRestoreLocalVector(dm_, &local);
    DMRestoreGlobalVector(dm_, &global);
  }
  BorrowedVectors(const BorrowedVectors&) = delete;
  BorrowedVectors& operator=(const BorrowedVectors&) = delete;

  Vec global = nullptr;
  Vec local = nullptr;

 private:
  DM dm_;
};

/// Fills the row above the owned ones from the upper neighbour. Collective.
template <int Dim>
void fetch_ghost_row(const PixelGrid<Dim>& grid, std::vector<double>& values) {
  if (size(grid.communicator()) == 1) return;
  const std::size_t row = grid.row_size();
  const std::size_t owned = static_cast<std::size_t>(grid.rows()) * row;
  const BorrowedVectors vectors(grid.dm());
  PetscScalar* target = nullptr;
  check_petsc(VecGetArrayWrite(vectors.global, &target), "VecGetArrayWrite");
  std::copy_n(values.begin(), owned, target);
  check_petsc(VecRestoreArrayWrite(vectors.global, &target), "VecRestoreArrayWrite");
  check_petsc(DMGlobalToLocal(grid.dm(), vectors.global, INSERT_VALUES, vectors.local),
              "DMGlobalToLocal");
  if (grid.first_row() + grid.rows() == grid.layout().pixels[Dim - 1]) return;
  // A local vector starts with the ghost row of the lower neighbour, where there is one.
  const std::size_t below = grid.first_row() > 0 ? row : 0;
  const PetscScalar* source = nullptr;
  check_petsc(VecGetArrayRead(vectors.local, &source), "VecGetArrayRead");
  std::copy_n(source + below + owned, row, values.begin() + static_cast<std::ptrdiff_t>(owned));
  check_petsc(VecRestoreArrayRead(vectors.local, &source), "VecRestoreArrayRead");
}

/// Empty map on the rows of this rank: void everywhere.
template <int Dim>
PixelField<Dim> make_map(const PixelGrid<Dim>& grid, std::size_t fields) {
  PixelField<Dim> map;
  map.layout = grid.layout();
  map.rounding = map_rounding;
  map.rows = grid.rows();
  map.first = grid.first_row() == 0;
  map.last = grid.first_row() + grid.rows() == grid.layout().pixels[Dim - 1];
  const std::size_t size = (static_cast<std::size_t>(map.rows) + 1) * grid.row_size();
  map.values.assign(fields, std::vector<double>(size, std::numeric_limits<double>::quiet_NaN()));
  map.solid.assign(size, 0);
  return map;
}

}  // namespace

template <int Dim>
PixelField<Dim> deposit(const PixelSources<Dim>& particles,
                        const std::vector<std::span<const double>>& columns,
                        const PixelScales& scales, const PixelGrid<Dim>& grid) {
  check_input(particles, columns, scales);
  Counters counters;
  const auto roundings = find_roundings(columns, grid.communicator());
  const RowSums band = sum_particles(particles, columns, roundings, scales, grid, counters);
  const RowSums owned = send_to_owners(band, grid.row_starts(), grid.communicator());
  PixelField<Dim> map = make_map(grid, columns.size());
  share_counters(counters, owned, grid.communicator(), map);
  take_means(owned, roundings, map);

  // The mask travels as the NaN of void pixels: means are finite, whatever the particles hold.
  for (std::vector<double>& field : map.values) fetch_ghost_row(grid, field);
  const std::size_t start = static_cast<std::size_t>(map.rows) * grid.row_size();
  for (std::size_t p = start; p < map.solid.size(); ++p) {
    map.solid[p] = std::isnan(map.values[0][p]) ? 0 : 1;
  }
  return map;
}

template PixelField<2> deposit<2>(const PixelSources<2>&,
                                  const std::vector<std::span<const double>>&, const PixelScales&,
                                  const PixelGrid<2>&);
template PixelField<3> deposit<3>(const PixelSources<3>&,
                                  const std::vector<std::span<const double>>&, const PixelScales&,
                                  const PixelGrid<3>&);

}  // namespace poreshock
