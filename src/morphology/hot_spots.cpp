#include <algorithm>
#include <cmath>
#include <limits>

#include "domain_part.hpp"
#include "label_runs.hpp"
#include "poreshock/core/fixed_point.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/morphology/domains.hpp"
#include "slab.hpp"

namespace poreshock {
namespace {

/// A run on the border between two slabs, which both of them have: its place there, the part it
/// belongs to, and its crossings from the origin of that part.
struct BorderRun {
  std::int64_t place;
  std::int64_t part;
  Crossings at;
};

/// Domains of a slab: complete ones, and parts that reach the border to another slab.
struct SlabDomains {
  std::vector<DomainPart> complete;
  std::vector<DomainPart> parts;
  std::vector<BorderRun> border;
};

/// Number of the set of each label, sets in the order of their roots.
std::vector<std::uint32_t> number_sets(const Labels& labels, std::size_t& count) {
  std::vector<std::uint32_t> number(labels.sets.size());
  count = 0;
  for (std::uint32_t l = 0; l < number.size(); ++l) {
    if (labels.sets.place(l).root == l) number[l] = static_cast<std::uint32_t>(count++);
  }
  for (std::uint32_t l = 0; l < number.size(); ++l) number[l] = number[labels.sets.place(l).root];
  return number;
}

/// The part of each label.
std::vector<DomainPart> add_runs(const Slab& slab, const Runs& runs, std::span<const double> values,
                                 double inverse_quantum, const MapFrame& frame,
                                 std::span<const std::uint32_t> label, std::size_t labels) {
  std::vector<DomainPart> parts(labels);
  const std::size_t rows =
      static_cast<std::size_t>(slab.ny) * static_cast<std::size_t>(slab.layers);
  for (std::size_t row = 0; row < rows; ++row) {
    const auto y = static_cast<std::int64_t>(row) % slab.ny;
    const auto z = static_cast<std::int64_t>(row) / slab.ny + frame.first_layer;
    const double* row_values = &values[row * static_cast<std::size_t>(slab.nx)];
    for (std::size_t r = runs.starts[row]; r < runs.starts[row + 1]; ++r) {
      add_run(runs.runs[r], y, z, row_values, inverse_quantum, frame, parts[label[r]]);
    }
  }
  return parts;
}

/// Runs on the borders to other slabs, their parts as the numbers of their labels.
std::vector<BorderRun> border_runs(const Slab& slab, const Runs& runs, const MapFrame& frame,
                                   std::span<const std::uint32_t> label, const Labels& labels) {
  std::vector<BorderRun> border;
  const auto ny = static_cast<std::size_t>(slab.ny);
  for (std::size_t row = 0; row + 1 < runs.starts.size(); ++row) {
    const auto z = static_cast<std::int64_t>(row / ny);
    if ((z > 0 || slab.first) && z < slab.layers) continue;
    const std::int64_t first =
        ((z + frame.first_layer) * frame.ny + static_cast<std::int64_t>(row % ny)) * frame.nx;
    for (std::size_t r = runs.starts[row]; r < runs.starts[row + 1]; ++r) {
      border.push_back({first + runs.runs[r].first, std::int64_t{label[r]},
                        labels.sets.place(label[r]).from_root});
    }
  }
  return border;
}

SlabDomains collect(const Slab& slab, const Runs& runs, std::span<const double> values,
                    double inverse_quantum, const MapFrame& frame,
                    std::span<const std::uint32_t> label, const Labels& labels) {
  std::size_t count = 0;
  const std::vector<std::uint32_t> number = number_sets(labels, count);
  const std::vector<DomainPart> parts =
      add_runs(slab, runs, values, inverse_quantum, frame, label, number.size());
  const auto winds = find_winding(labels);
  std::vector<DomainPart> domains(count);
  for (std::uint32_t l = 0; l < number.size(); ++l) {
    const auto place = labels.sets.place(l);
    add(parts[l], place.from_root, frame, domains[number[l]]);
    if (place.root == l) domains[number[l]].winds = winds[l];
  }
  SlabDomains result;
  result.border = border_runs(slab, runs, frame, label, labels);
  std::vector<std::int64_t> open(count, -1);
  for (BorderRun& run : result.border) {
    const std::uint32_t domain = number[static_cast<std::size_t>(run.part)];
    std::int64_t& part = open[domain];
    if (part < 0) {
      part = static_cast<std::int64_t>(result.parts.size());
      result.parts.push_back(domains[domain]);
    }
    run.part = part;
  }
  for (std::size_t d = 0; d < count; ++d) {
    if (open[d] < 0) result.complete.push_back(domains[d]);
  }
  return result;
}

/// Joins the parts of all slabs along the runs that two slabs share, on rank 0.
std::vector<DomainPart> join_parts(const std::vector<DomainPart>& parts,
                                   std::vector<BorderRun> border, const MapFrame& frame) {
  std::stable_sort(border.begin(), border.end(),
                   [](const BorderRun& a, const BorderRun& b) { return a.place < b.place; });
  Labels labels(parts.size());
  for (std::size_t i = 0; i + 1 < border.size(); ++i) {
    const BorderRun& a = border[i];
    const BorderRun& b = border[i + 1];
    if (a.place != b.place) continue;
    join(static_cast<std::size_t>(a.part), static_cast<std::size_t>(b.part), a.at - b.at, labels);
  }
  settle(labels);
  const auto winds = find_winding(labels);
  std::vector<DomainPart> domains(parts.size());
  for (std::size_t p = 0; p < parts.size(); ++p) {
    const auto place = labels.sets.place(static_cast<std::uint32_t>(p));
    add(parts[p], place.from_root, frame, domains[place.root]);
  }
  std::vector<DomainPart> result;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    if (labels.sets.place(static_cast<std::uint32_t>(p)).root != p) continue;
    domains[p].winds[0] |= winds[p][0];
    domains[p].winds[1] |= winds[p][1];
    result.push_back(domains[p]);
  }
  return result;
}

/// Sum of the numbers of the ranks below this one. Collective.
std::int64_t of_lower_ranks(std::int64_t count, MPI_Comm communicator) {
  std::int64_t before = 0;
  check_mpi(MPI_Exscan(&count, &before, 1, MPI_INT64_T, MPI_SUM, communicator), "MPI_Exscan");
  return rank(communicator) == 0 ? 0 : before;
}

/// All domains of the map, on rank 0.
std::vector<DomainPart> gather_domains(SlabDomains slab, const MapFrame& frame,
                                       MPI_Comm communicator) {
  std::vector<int> starts;
  std::vector<DomainPart> domains = gather(slab.complete, starts, communicator);
  // Parts are numbered over all ranks.
  const std::int64_t first =
      of_lower_ranks(static_cast<std::int64_t>(slab.parts.size()), communicator);
  for (BorderRun& run : slab.border) run.part += first;
  const std::vector<DomainPart> parts = gather(slab.parts, starts, communicator);
  std::vector<BorderRun> border = gather(slab.border, starts, communicator);
  const std::vector<DomainPart> joined = join_parts(parts, std::move(border), frame);
  domains.insert(domains.end(), joined.begin(), joined.end());
  return domains;
}

/// Quantum of the sums of values: 2^-31 of the largest value of the map, or the power of two below.
double find_inverse_quantum(const Slab& slab, std::span<const double> values,
                            std::span<const std::uint8_t> solid, MPI_Comm communicator) {
  double most = 0.0;
  const std::size_t owned = slab.layer_size() * static_cast<std::size_t>(slab.layers);
  constexpr std::size_t stretch = 64;
  for (std::size_t at = 0; at < owned; at += stretch) {
    const std::size_t end = std::min(at + stretch, owned);
    // Most stretches hold nothing larger than what came before, which is seen at once.
    std::uint64_t larger = 0;
    for (std::size_t i = at; i < end; ++i) larger |= std::abs(values[i]) > most ? 1 : 0;
    for (std::size_t i = at; larger != 0 && i < end; ++i) {
      const double size = std::abs(values[i]);
      if (solid[i] != 0 && std::isfinite(size)) most = size > most ? size : most;
    }
  }
  check_mpi(MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_DOUBLE, MPI_MAX, communicator),
            "MPI_Allreduce");
  if (!(most > 0.0)) return 1.0;
  // Subnormal maps would need an infinite factor.
  return 0x1p31 / power_of_two_below(std::max(most, 1e-290));
}

/// A coordinate folded into 0 ... size - 1.
std::int64_t fold(std::int64_t coordinate, std::int64_t size) {
  return ((coordinate % size) + size) % size;
}

template <int Dim>
HotSpot<Dim> hot_spot(const DomainPart& part, const PixelField<Dim>& map, double inverse_quantum) {
  HotSpot<Dim> spot;
  spot.pixels = part.pixels;
  spot.peak = part.peak;
  const auto count = static_cast<double>(part.pixels);
  spot.mean = static_cast<double>(part.value_sum) / inverse_quantum / count;
  spot.first = part.first;
  for (std::size_t axis = 0; axis < Dim; ++axis) {
    // In 2-D the parts keep the shock axis where 3-D keeps z.
    const std::size_t at = axis + 1 == Dim ? 2 : axis;
    const auto pixels = static_cast<std::int64_t>(map.layout.pixels[axis]);
    spot.low[axis] = part.low[at];
    spot.size[axis] = part.high[at] - part.low[at] + 1;
    std::int64_t sum = part.sum[at];
    if (axis + 1 < Dim && map.layout.periodic[axis]) {
      spot.winds[axis] = part.winds[axis] != 0;
      spot.low[axis] = spot.winds[axis] ? 0 : fold(spot.low[axis], pixels);
      spot.size[axis] = spot.winds[axis] ? pixels : spot.size[axis];
      sum = fold(sum, 2 * pixels * part.pixels);
    }
    const bool none = axis + 1 < Dim && spot.winds[axis];
    spot.centroid[axis] =
        none ? std::numeric_limits<double>::quiet_NaN() : static_cast<double>(sum) / (2.0 * count);
  }
  return spot;
}

}  // namespace

template <int Dim>
std::vector<HotSpot<Dim>> find_hot_spots(const PixelField<Dim>& map, std::size_t field,
                                         double threshold, Joining joining, MPI_Comm communicator) {
  const Slab slab = slab_of(map);
  const std::span<const double> values = map.values.at(field);
  const MapFrame frame{slab.nx, slab.ny, of_lower_ranks(slab.layers, communicator)};
  const double inverse_quantum = find_inverse_quantum(slab, values, map.solid, communicator);
  const Runs runs = find_runs(slab, values, map.solid, threshold);
  Labels labels(0);
  const auto labels_of_runs = label(slab, runs, joining == Joining::corners, labels);
  std::vector<DomainPart> domains =
      gather_domains(collect(slab, runs, values, inverse_quantum, frame, labels_of_runs, labels),
                     frame, communicator);
  std::sort(domains.begin(), domains.end(), [](const DomainPart& a, const DomainPart& b) {
    return a.pixels != b.pixels ? a.pixels > b.pixels : a.first < b.first;
  });
  std::vector<HotSpot<Dim>> spots;
  spots.reserve(domains.size());
  for (const DomainPart& part : domains) spots.push_back(hot_spot(part, map, inverse_quantum));
  return spots;
}

template std::vector<HotSpot<2>> find_hot_spots<2>(const PixelField<2>&, std::size_t, double,
                                                   Joining, MPI_Comm);
template std::vector<HotSpot<3>> find_hot_spots<3>(const PixelField<3>&, std::size_t, double,
                                                   Joining, MPI_Comm);

}  // namespace poreshock
