#include "poreshock/run/measure.hpp"

#include <cmath>
#include <limits>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/morphology/analysis.hpp"
#include "poreshock/morphology/domains.hpp"
#include "poreshock/morphology/isoline.hpp"
#include "poreshock/morphology/isosurface.hpp"
#include "poreshock/morphology/quantiles.hpp"
#include "poreshock/morphology/voids.hpp"

namespace poreshock {

namespace {

template <class Counts>
void append_arrays(const Counts& counts, MorphologyRecord& record) {
  record.pixels = counts.pixels;
  for_each_count(counts, [&](std::string_view name, const std::vector<std::int64_t>& array) {
    record.counts.emplace_back(std::string(name), array);
  });
}

void append_counts(const PixelCounts& c, MorphologyRecord& record) {
  append_arrays(c, record);
  const Minkowski m = functionals(c);
  record.functionals = {
      {"A", m.A}, {"L", m.L}, {"L_crofton", m.L_crofton}, {"chi", m.chi}, {"chi4", m.chi4}};
}

// The vertex count holds the name V, so the volume functional is spelt out.
void append_counts(const VoxelCounts& c, MorphologyRecord& record) {
  append_arrays(c, record);
  const Minkowski3 m = functionals(c);
  record.functionals = {{"volume", m.V}, {"S", m.S},     {"S_crofton", m.S_crofton},
                        {"M", m.M},      {"chi", m.chi}, {"chi6", m.chi6}};
}

void append_domains(const DomainCounts& d, MorphologyRecord& record) {
  record.counts.insert(record.counts.end(), {{"n_W", d.n_W},
                                             {"n_B", d.n_B},
                                             {"n_B_frame", d.n_B_frame},
                                             {"white_winding", d.white_winding},
                                             {"black_winding", d.black_winding}});
  record.functionals.push_back({"chi_paper", chi_of_domains(d)});
}

std::vector<double>& curve(const std::string& name, MorphologyRecord& record) {
  for (Curve& found : record.functionals) {
    if (found.name == name) return found.values;
  }
  throw SystemError("a record of morphology has no " + name);
}

Voids voids_of(MapVoids voids) {
  switch (voids) {
    case MapVoids::white:
      return Voids::white;
    case MapVoids::fill:
      return Voids::fill;
    case MapVoids::exclude:
      return Voids::exclude;
    case MapVoids::black:
      break;
  }
  return Voids::black;
}

/// Replaces chi and its dual where voids are not black, which is what the counts hold.
template <int Dim>
void treat_voids(const PixelField<Dim>& map, std::size_t field, MapVoids voids,
                 MPI_Comm communicator, MorphologyRecord& record) {
  if (voids == MapVoids::black) return;
  EulerDensity density =
      euler_density<Dim>(map, field, record.threshold, voids_of(voids), communicator);
  curve("chi", record) = std::move(density.corners);
  curve(Dim == 2 ? "chi4" : "chi6", record) = std::move(density.faces);
}

/// The interpolated boundary per pixel.
template <int Dim>
void append_interpolated(const PixelField<Dim>& map, std::size_t field, MPI_Comm communicator,
                         MorphologyRecord& record) {
  Curve boundary;
  if constexpr (Dim == 2) {
    boundary = {"L_isoline", isoline_lengths(map, field, record.threshold, communicator)};
  } else {
    boundary = {"S_isosurface", isosurface_areas(map, field, record.threshold, communicator)};
  }
  for (double& value : boundary.values) {
    value = record.pixels > 0 ? value / static_cast<double>(record.pixels) : 0.0;
  }
  record.functionals.push_back(std::move(boundary));
}

/// From where on a value counts as at a threshold: 0.7 is reached by the nearest number of 32 bits
/// to it, which lies below, and by what rounding alone keeps from it.
template <int Dim>
std::vector<double> reached_from(const PixelField<Dim>& map, std::vector<double> thresholds) {
  for (double& threshold : thresholds) {
    if (map.single_precision) threshold = static_cast<float>(threshold);
    threshold -= map.rounding * std::abs(threshold);
  }
  return thresholds;
}

/// Measures at quantiles first as at any thresholds: none is reached where no pixel has a value.
std::vector<double> thresholds_at(std::vector<double> levels) {
  for (double& level : levels) {
    if (std::isnan(level)) level = std::numeric_limits<double>::infinity();
  }
  return levels;
}

/// All records of a run share their axis: the shares, with the values as a curve beside.
void use_shares(const std::vector<double>& shares, const std::vector<double>& levels,
                MorphologyRecord& record) {
  record.functionals.insert(record.functionals.begin(), {"level", levels, record.unit});
  record.threshold = shares;
  record.unit = "1";
}

/// Beside each functional that counts pixels to the power -k, the same per metre to that power.
template <int Dim>
void append_physical(double pixel, MorphologyRecord& record) {
  std::vector<std::pair<std::string, int>> names = {{"L", 1}, {"chi", 2}};
  if (Dim == 3) names = {{"S", 1}, {"M", 2}, {"chi", 3}};
  for (const auto& [name, power] : names) {
    Curve physical{name + "_physical", curve(name, record),
                   power == 1 ? "1/m" : "1/m^" + std::to_string(power)};
    for (double& value : physical.values) value /= std::pow(pixel, power);
    record.functionals.push_back(std::move(physical));
  }
}

/// Columns of the list of hot spots, still empty.
template <int Dim>
std::vector<SpotColumn> spot_columns(const std::string& unit) {
  using Kind = SpotColumn::Kind;
  return {{"threshold", unit},
          {"pixels", "1", Kind::integers},
          {Dim == 2 ? "area" : "volume", Dim == 2 ? "m^2" : "m^3"},
          {"peak", unit},
          {"mean", unit},
          {"centroid", "m", Kind::numbers, Dim},
          {"low", "m", Kind::numbers, Dim},
          {"extent", "m", Kind::numbers, Dim},
          {"winds", "1", Kind::integers, Dim - 1}};
}

template <int Dim>
void append_spot(const HotSpot<Dim>& spot, double threshold, double pixel, const Vector<Dim>& shift,
                 std::vector<SpotColumn>& columns) {
  double cell = 1.0;
  for (int axis = 0; axis < Dim; ++axis) cell *= pixel;
  columns[0].numbers.push_back(threshold);
  columns[1].integers.push_back(spot.pixels);
  columns[2].numbers.push_back(static_cast<double>(spot.pixels) * cell);
  columns[3].numbers.push_back(spot.peak);
  columns[4].numbers.push_back(spot.mean);
  for (std::size_t axis = 0; axis < Dim; ++axis) {
    const double from = shift[static_cast<Eigen::Index>(axis)];
    columns[5].numbers.push_back(spot.centroid[axis] * pixel + from);
    columns[6].numbers.push_back(static_cast<double>(spot.low[axis]) * pixel + from);
    columns[7].numbers.push_back(static_cast<double>(spot.size[axis]) * pixel);
  }
  for (const bool winds : spot.winds) columns[8].integers.push_back(winds ? 1 : 0);
}

/// The list of hot spots at every one of the thresholds.
template <int Dim>
void append_spots(const PixelField<Dim>& map, std::size_t field,
                  const std::vector<double>& thresholds, const Vector<Dim>& shift,
                  MPI_Comm communicator, MorphologyRecord& record) {
  if (thresholds.empty()) return;
  record.spot_columns = spot_columns<Dim>(record.unit);
  const std::vector<double> reached = reached_from(map, thresholds);
  for (std::size_t k = 0; k < thresholds.size(); ++k) {
    const auto spots = find_hot_spots<Dim>(map, field, reached[k], Joining::corners, communicator);
    for (const HotSpot<Dim>& spot : spots) {
      append_spot(spot, thresholds[k], map.layout.pixel_size, shift, record.spot_columns);
    }
    record.spots += spots.size();
  }
}

}  // namespace

template <int Dim>
MorphologyRecord measure(const PixelField<Dim>& map, std::size_t field, const MorphologyField& what,
                         const std::string& unit, const Morphology& morphology,
                         const Vector<Dim>& shift, MPI_Comm communicator) {
  MorphologyRecord record;
  record.field = what.name;
  record.unit = unit;
  record.threshold = reached_from(map, what.thresholds);
  std::vector<double> levels;
  if (!what.quantiles.empty()) {
    levels = quantiles<Dim>(map, field, what.quantiles, communicator);
    record.threshold = thresholds_at(levels);
  }
  append_counts(count<Dim>(map, field, record.threshold, communicator), record);
  treat_voids<Dim>(map, field, morphology.voids, communicator, record);
  if (morphology.length == BoundaryLength::isoline) {
    append_interpolated<Dim>(map, field, communicator, record);
  }
  append_physical<Dim>(map.layout.pixel_size, record);
  if (morphology.domains) {
    append_domains(count_domains<Dim>(map, field, record.threshold, Joining::corners, communicator),
                   record);
  }
  append_spots(map, field, what.hot_spots, shift, communicator, record);
  record.threshold = what.thresholds;
  if (!what.quantiles.empty()) use_shares(what.quantiles, levels, record);
  return record;
}

template MorphologyRecord measure<2>(const PixelField<2>&, std::size_t, const MorphologyField&,
                                     const std::string&, const Morphology&, const Vector<2>&,
                                     MPI_Comm);
template MorphologyRecord measure<3>(const PixelField<3>&, std::size_t, const MorphologyField&,
                                     const std::string&, const Morphology&, const Vector<3>&,
                                     MPI_Comm);

}  // namespace poreshock
