#include "poreshock/solver/measure.hpp"

#include "poreshock/morphology/analysis.hpp"
#include "poreshock/morphology/domains.hpp"

namespace poreshock {

namespace {

void append_counts(const PixelCounts& c, MorphologyRecord& record) {
  record.pixels = c.pixels;
  record.counts = {{"F", c.F}, {"E", c.E},         {"V", c.V},           {"V4", c.V4},
                   {"D", c.D}, {"B_int", c.B_int}, {"B_void", c.B_void}, {"B_frame", c.B_frame}};
  const Minkowski m = functionals(c);
  record.functionals = {{"A", m.A}, {"L", m.L}, {"chi", m.chi}, {"chi4", m.chi4}};
}

// The vertex count holds the name V, so the volume functional is spelt out.
void append_counts(const VoxelCounts& c, MorphologyRecord& record) {
  record.pixels = c.pixels;
  record.counts = {{"C", c.C},         {"F", c.F},           {"E", c.E},
                   {"V", c.V},         {"E4", c.E4},         {"V8", c.V8},
                   {"S_int", c.S_int}, {"S_void", c.S_void}, {"S_frame", c.S_frame}};
  const Minkowski3 m = functionals(c);
  record.functionals = {{"volume", m.V}, {"S", m.S}, {"M", m.M}, {"chi", m.chi}, {"chi6", m.chi6}};
}

void append_domains(const DomainCounts& d, MorphologyRecord& record) {
  record.counts.insert(record.counts.end(), {{"n_W", d.n_W},
                                             {"n_B", d.n_B},
                                             {"n_B_frame", d.n_B_frame},
                                             {"white_winding", d.white_winding},
                                             {"black_winding", d.black_winding}});
  record.functionals.emplace_back("chi_paper", chi_of_domains(d));
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

}  // namespace

template <int Dim>
MorphologyRecord measure(const PixelField<Dim>& map, std::size_t field, const MorphologyField& what,
                         const std::string& unit, const Morphology& morphology,
                         const Vector<Dim>& shift, MPI_Comm communicator) {
  MorphologyRecord record;
  record.field = what.name;
  record.unit = unit;
  record.threshold = what.thresholds;
  append_counts(count<Dim>(map, field, what.thresholds, communicator), record);
  if (morphology.domains) {
    append_domains(count_domains<Dim>(map, field, what.thresholds, Joining::corners, communicator),
                   record);
  }
  if (!what.hot_spots.empty()) record.spot_columns = spot_columns<Dim>(unit);
  for (const double threshold : what.hot_spots) {
    const auto spots = find_hot_spots<Dim>(map, field, threshold, Joining::corners, communicator);
    for (const HotSpot<Dim>& spot : spots) {
      append_spot(spot, threshold, map.layout.pixel_size, shift, record.spot_columns);
    }
    record.spots += spots.size();
  }
  return record;
}

template MorphologyRecord measure<2>(const PixelField<2>&, std::size_t, const MorphologyField&,
                                     const std::string&, const Morphology&, const Vector<2>&,
                                     MPI_Comm);
template MorphologyRecord measure<3>(const PixelField<3>&, std::size_t, const MorphologyField&,
                                     const std::string&, const Morphology&, const Vector<3>&,
                                     MPI_Comm);

}  // namespace poreshock
