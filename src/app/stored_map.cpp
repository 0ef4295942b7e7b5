#include "stored_map.hpp"

#include <algorithm>
#include <cmath>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/morphology/lattice_map.hpp"
#include "poreshock/particles/derived.hpp"
#include "poreshock/scene/read_scene.hpp"

namespace poreshock {

namespace {

template <int Dim>
std::array<bool, Dim - 1> periodic_axes(const std::string& text) {
  std::array<bool, Dim - 1> periodic{};
  for (std::size_t axis = 0; axis + 1 < Dim; ++axis) {
    periodic[axis] = text.find("xy"[axis]) != std::string::npos;
  }
  const std::string_view allowed = Dim == 2 ? "x" : "xy";
  if (text.find_first_not_of(std::string(allowed) + ",") != std::string::npos) {
    throw InputError("--periodic: found \"" + text + "\", allowed " +
                     (Dim == 2 ? "x for a map of two dimensions" : "x, y or x,y"));
  }
  return periodic;
}

template <int Dim>
PixelLayout<Dim> layout_of(const StoredArray& array, const AnalyzeOptions& options) {
  PixelLayout<Dim> layout;
  for (std::size_t axis = 0; axis < Dim; ++axis) {
    const std::uint64_t extent = array.shape[Dim - 1 - axis];
    if (extent > 0x7fffffff) throw InputError(array.file + ": too large along one axis");
    layout.pixels[axis] = static_cast<int>(extent);
  }
  layout.pixel_size = options.pixel > 0.0 ? options.pixel : 1.0;
  layout.periodic = periodic_axes<Dim>(options.periodic);
  return layout;
}

/// 1 where the mask, or without one the value, says that there is material.
std::vector<std::uint8_t> read_solid(const StoredArray& array, const std::string& mask_name,
                                     const std::vector<double>& values, std::uint64_t first,
                                     std::uint64_t rows, MPI_Comm communicator) {
  std::vector<std::uint8_t> solid(values.size());
  if (mask_name.empty()) {
    for (std::size_t i = 0; i < solid.size(); ++i) solid[i] = std::isnan(values[i]) ? 0 : 1;
    return solid;
  }
  const StoredArray mask = find_array(mask_name, communicator);
  if (mask.shape != array.shape) {
    throw InputError("--mask: " + mask_name + " has another shape than " + array.file);
  }
  const std::vector<double> flags = read_rows(mask, first, rows, communicator);
  for (std::size_t i = 0; i < solid.size(); ++i) solid[i] = flags[i] != 0.0 ? 1 : 0;
  return solid;
}

/// One column of numbers of the particles of this rank.
struct Columns {
  RowRange rows;
  std::string path;
  Hdf5File& file;

  /// Components of a dataset, each as a column. InputError when it is not stored. Collective.
  std::vector<std::vector<double>> read(const std::string& name, std::size_t components) const {
    const std::string dataset = "/particles/" + name;
    const auto all = file.datasets();
    if (std::none_of(all.begin(), all.end(),
                     [&](const DatasetInfo& info) { return info.path == dataset; })) {
      throw InputError(path + ": holds no " + dataset +
                       ", which is needed; take it up into output.fields of the scene");
    }
    std::vector<double> values(rows.count * components);
    file.read<double>(dataset, rows.first, values);
    std::vector<std::vector<double>> columns(components, std::vector<double>(rows.count));
    for (std::size_t i = 0; i < values.size(); ++i) {
      columns[i % components][i / components] = values[i];
    }
    return columns;
  }
};

/// A field of the particles, by the names of the scene.
template <int Dim>
std::vector<double> read_field(const std::string& name, const Columns& columns) {
  derived_unit(name);
  std::vector<double> result(columns.rows.count);
  if (name == "speed") {
    const auto velocity = columns.read("velocity", Dim);
    for (std::size_t i = 0; i < result.size(); ++i) {
      double sum = 0.0;
      for (const auto& component : velocity) sum += component[i] * component[i];
      result[i] = std::sqrt(sum);
    }
    return result;
  }
  if (name != "von_mises") return std::move(columns.read(name, 1)[0]);
  const auto stress = columns.read("stress", symmetric_size<Dim>);
  for (std::size_t i = 0; i < result.size(); ++i) {
    const double mean = (stress[0][i] + stress[1][i] + stress[2][i]) / 3.0;
    SymmetricTensor<Dim> deviator;
    for (std::size_t c = 0; c < deviator.size(); ++c) {
      deviator[c] = stress[c][i] - (c < 3 ? mean : 0.0);
    }
    result[i] = std::sqrt(1.5 * contract<Dim>(deviator, deviator));
  }
  return result;
}

template <int Dim>
PixelLayout<Dim> layout_of(const Scene& scene, double pixel) {
  PixelLayout<Dim> layout;
  layout.pixel_size = pixel;
  for (int a = 0; a < Dim; ++a) {
    const double pixels = scene.domain.size[a] / pixel;
    if (!(std::round(pixels) >= 1.0) ||
        std::abs(pixels - std::round(pixels)) > 1e-9 * std::round(pixels)) {
      throw InputError("--pixel: allowed are whole parts of the domain, which is " +
                       std::to_string(scene.domain.size[a] * 1e6) + "e-6 m along an axis");
    }
    layout.pixels[a] = static_cast<int>(std::lround(pixels));
    if (a + 1 < Dim) layout.periodic[a] = scene.domain.periodic[a];
  }
  return layout;
}

}  // namespace

template <int Dim>
StoredMap<Dim> map_of_array(const StoredArray& array, const AnalyzeOptions& options,
                            MPI_Comm communicator) {
  const PixelGrid<Dim> grid(communicator, layout_of<Dim>(array, options));
  StoredMap<Dim> result;
  PixelField<Dim>& map = result.map;
  map.layout = grid.layout();
  map.single_precision = array.single_precision;
  map.rows = grid.rows();
  map.first = grid.first_row() == 0;
  map.last = grid.first_row() + grid.rows() == map.layout.pixels[Dim - 1];
  const auto first = static_cast<std::uint64_t>(grid.first_row());
  const auto rows = static_cast<std::uint64_t>(map.rows) + (map.last ? 0U : 1U);
  std::vector<double> values = read_rows(array, first, rows, communicator);
  map.solid = read_solid(array, options.mask, values, first, rows, communicator);
  const std::size_t stored = (static_cast<std::size_t>(map.rows) + 1) * grid.row_size();
  values.resize(stored, std::nan(""));
  map.solid.resize(stored, 0);
  map.values = {std::move(values)};
  const std::string own = array.dataset.substr(array.dataset.rfind('/') + 1);
  result.field = !options.field.empty() ? options.field : own.empty() ? "array" : own;
  result.unit = array.unit;
  result.stamp.numbers["pixel"] = map.layout.pixel_size;
  return result;
}

template <int Dim>
StoredMap<Dim> map_of_snapshot(const std::string& path, const AnalyzeOptions& options,
                               MPI_Comm communicator) {
  Hdf5File file = Hdf5File::open(path, communicator);
  const Scene scene = parse_scene(file.text("scene"), path);
  const bool sites = scene.morphology.lattice == MapLattice::lagrangian;
  const double own_pixel = scene.morphology.pixel;
  if (sites && options.pixel > 0.0) {
    throw InputError(
        "--pixel: the run measured on the lattice of its particles, which has pixels "
        "of its own");
  }
  const double pixel = options.pixel > 0.0 ? options.pixel : own_pixel;
  const PixelGrid<Dim> grid(communicator, layout_of<Dim>(scene, pixel));
  StoredMap<Dim> result;
  result.field = options.field.empty() ? "temperature" : options.field;
  result.unit = std::string(derived_unit(result.field));
  result.stamp = {file.integer("record"),
                  file.integer("step"),
                  file.number("time"),
                  file.text("scene"),
                  {{"pixel", pixel}}};
  const Columns columns{equal_share(file.dataset("/particles/id").rows(), communicator), path,
                        file};
  const std::vector<double> values = read_field<Dim>(result.field, columns);
  const bool single = scene.output.precision == Precision::single_precision;
  if (sites) {
    std::vector<std::int64_t> id(columns.rows.count);
    file.read<std::int64_t>("/particles/id", columns.rows.first, id);
    result.map = place_on_lattice<Dim>(id, {values}, grid);
    result.map.single_precision = single;
    return result;
  }
  auto position = columns.read("position", Dim);
  const auto mass = columns.read("mass", 1);
  const auto density = columns.read("density", 1);
  PixelSources<Dim> sources;
  for (std::size_t a = 0; a < Dim; ++a) {
    result.shift[static_cast<Eigen::Index>(a)] = file.number(std::string("origin_") + "xyz"[a]);
    for (double& x : position[a]) x -= result.shift[static_cast<Eigen::Index>(a)];
    sources.position[a] = position[a];
  }
  sources.mass = mass[0];
  sources.density = density[0];
  PixelScales scales = {0.0, 2.0 * scene.domain.cell};
  for (const MaterialParameters& m : scene.materials) {
    scales.density = std::max(scales.density, initial_density(make_material(m)));
  }
  result.map = deposit<Dim>(sources, {values}, scales, grid);
  result.map.single_precision = single;
  return result;
}

template StoredMap<2> map_of_array<2>(const StoredArray&, const AnalyzeOptions&, MPI_Comm);
template StoredMap<3> map_of_array<3>(const StoredArray&, const AnalyzeOptions&, MPI_Comm);
template StoredMap<2> map_of_snapshot<2>(const std::string&, const AnalyzeOptions&, MPI_Comm);
template StoredMap<3> map_of_snapshot<3>(const std::string&, const AnalyzeOptions&, MPI_Comm);

}  // namespace poreshock
