// The nearest material of every void pixel, axis by axis: first along the shock axis over all
// slabs, then along the lateral ones within a layer (Saito and Toriwaki, Pattern Recognition 27
// (1994) 1551).

#include <limits>

#include "poreshock/core/parallel.hpp"
#include "poreshock/morphology/voids.hpp"
#include "slab.hpp"

namespace poreshock {
namespace {

constexpr std::int64_t none = std::numeric_limits<std::int64_t>::min();
constexpr std::int64_t far_away = std::numeric_limits<std::int64_t>::max();

/// A material pixel of a column: its layer on the whole map, `none` where there is no such pixel.
struct Site {
  double value;
  std::int64_t layer;
};

/// Squared distance to the nearest material found so far, and its value.
struct Nearest {
  std::int64_t distance;
  double value;
};

/// The operation of a scan: what comes later replaces what came before, where it holds a pixel.
void keep_last(void* before, void* after, int* bytes, MPI_Datatype*) {
  const Site* earlier = static_cast<const Site*>(before);
  Site* later = static_cast<Site*>(after);
  for (std::size_t i = 0; i < static_cast<std::size_t>(*bytes) / sizeof(Site); ++i) {
    if (later[i].layer == none) later[i] = earlier[i];
  }
}

/// Last pixels of the columns of all ranks before this one in the order of `communicator`.
std::vector<Site> of_ranks_before(const std::vector<Site>& own, MPI_Comm communicator) {
  std::vector<Site> result(own.size(), Site{0.0, none});
  MPI_Op operation = MPI_OP_NULL;
  check_mpi(MPI_Op_create(keep_last, 0, &operation), "MPI_Op_create");
  const int code =
      MPI_Exscan(own.data(), result.data(), static_cast<int>(own.size() * sizeof(Site)), MPI_BYTE,
                 operation, communicator);
  MPI_Op_free(&operation);
  check_mpi(code, "MPI_Exscan");
  // The first rank's result is undefined.
  if (rank(communicator) == 0) result.assign(own.size(), Site{0.0, none});
  return result;
}

/// The same from the highest rank down.
std::vector<Site> of_ranks_after(const std::vector<Site>& own, MPI_Comm communicator) {
  MPI_Comm reversed = MPI_COMM_NULL;
  check_mpi(MPI_Comm_split(communicator, 0, size(communicator) - rank(communicator), &reversed),
            "MPI_Comm_split");
  std::vector<Site> result = of_ranks_before(own, reversed);
  MPI_Comm_free(&reversed);
  return result;
}

std::int64_t first_layer_of(const Slab& slab, MPI_Comm communicator) {
  const std::int64_t layers = slab.layers;
  std::int64_t before = 0;
  check_mpi(MPI_Exscan(&layers, &before, 1, MPI_INT64_T, MPI_SUM, communicator), "MPI_Exscan");
  return rank(communicator) == 0 ? 0 : before;
}

/// One stored field of a slab with its mask.
struct Column {
  const double* values;
  const std::uint8_t* solid;
};

/// The last (or first) material pixel of every column of the owned layers.
std::vector<Site> end_sites(const Slab& slab, Column field, std::int64_t first, bool last) {
  const std::size_t layer = slab.layer_size();
  std::vector<Site> sites(layer, Site{0.0, none});
  for (int step = 0; step < slab.layers; ++step) {
    const int z = last ? step : slab.layers - 1 - step;
    for (std::size_t i = 0; i < layer; ++i) {
      const std::size_t at = static_cast<std::size_t>(z) * layer + i;
      if (field.solid[at] != 0) sites[i] = {field.values[at], first + z};
    }
  }
  return sites;
}

/// Takes a site along the shock axis into account for one pixel.
void consider(const Site& site, std::int64_t layer, Nearest& nearest) {
  if (site.layer == none) return;
  const std::int64_t distance = (site.layer - layer) * (site.layer - layer);
  if (distance < nearest.distance) nearest = {distance, site.value};
}

/// Nearest material along the shock axis for all stored pixels. Collective.
std::vector<Nearest> search_columns(const Slab& slab, Column field, MPI_Comm communicator) {
  const std::int64_t first = first_layer_of(slab, communicator);
  std::vector<Site> below = of_ranks_before(end_sites(slab, field, first, true), communicator);
  std::vector<Site> above = of_ranks_after(end_sites(slab, field, first, false), communicator);
  const std::size_t layer = slab.layer_size();
  std::vector<Nearest> nearest(slab.stored_size(), Nearest{far_away, 0.0});
  const auto pass = [&](int z, std::vector<Site>& sites) {
    for (std::size_t i = 0; i < layer; ++i) {
      const std::size_t at = static_cast<std::size_t>(z) * layer + i;
      if (field.solid[at] != 0) sites[i] = {field.values[at], first + z};
      consider(sites[i], first + z, nearest[at]);
    }
  };
  for (int z = 0; z < slab.stored; ++z) pass(z, below);
  for (int z = slab.stored - 1; z >= 0; --z) pass(z, above);
  return nearest;
}

/// Takes the nearest of a whole line of `count` pixels, `stride` apart, into account.
void search_line(std::vector<Nearest>& all, std::size_t start, std::size_t stride, int count,
                 bool periodic, std::vector<Nearest>& line) {
  for (int i = 0; i < count; ++i) {
    Nearest best = all[start + static_cast<std::size_t>(i) * stride];
    const int most = periodic ? count / 2 : count - 1;
    for (std::int64_t d = 1; d <= most && d * d < best.distance; ++d) {
      for (const std::int64_t side : {i - d, i + d}) {
        if (!periodic && (side < 0 || side >= count)) continue;
        const Nearest& other =
            all[start + static_cast<std::size_t>((side + count) % count) * stride];
        if (other.distance == far_away || other.distance + d * d >= best.distance) continue;
        best = {other.distance + d * d, other.value};
      }
    }
    line[static_cast<std::size_t>(i)] = best;
  }
  for (int i = 0; i < count; ++i) {
    all[start + static_cast<std::size_t>(i) * stride] = line[static_cast<std::size_t>(i)];
  }
}

}  // namespace

template <int Dim>
PixelField<Dim> fill_voids(const PixelField<Dim>& map, std::size_t field, MPI_Comm communicator) {
  const Slab slab = slab_of(map);
  const auto nx = static_cast<std::size_t>(slab.nx);
  std::vector<Nearest> nearest =
      search_columns(slab, {map.values.at(field).data(), map.solid.data()}, communicator);
  std::vector<Nearest> line(static_cast<std::size_t>(std::max(slab.nx, slab.ny)));
  for (std::size_t row = 0; row < slab.stored_size() / nx; ++row) {
    search_line(nearest, row * nx, 1, slab.nx, slab.periodic_x, line);
  }
  for (int z = 0; slab.ny > 1 && z < slab.stored; ++z) {
    for (std::size_t x = 0; x < nx; ++x) {
      search_line(nearest, static_cast<std::size_t>(z) * slab.layer_size() + x, nx, slab.ny,
                  slab.periodic_y, line);
    }
  }
  PixelField<Dim> result = map;
  for (std::size_t i = 0; i < nearest.size(); ++i) {
    if (result.solid[i] != 0 || nearest[i].distance == far_away) continue;
    result.values[field][i] = nearest[i].value;
    result.solid[i] = 1;
  }
  return result;
}

template PixelField<2> fill_voids<2>(const PixelField<2>&, std::size_t, MPI_Comm);
template PixelField<3> fill_voids<3>(const PixelField<3>&, std::size_t, MPI_Comm);

}  // namespace poreshock
