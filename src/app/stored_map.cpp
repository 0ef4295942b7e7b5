#include "stored_map.hpp"

#include <algorithm>
#include <cmath>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/material/derived.hpp"
#include "poreshock/morphology/lattice_map.hpp"
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
  layout.pixel_size = options.pixel.value_or(1.0);
  layout.periodic = periodic_axes<Dim>(options.periodic);
  return layout;
}

/// Values of a map and where there is material, with the row of the upper neighbour.
struct SolidValues {
  std::vector<double> values;
  std::vector<std::uint8_t> solid;
  std::int64_t unknown = 0;  ///< material of the mask, on all ranks, without a value
};

/// Throws InputError when the owned pixels of no rank are material. Collective.
void require_material(const SolidValues& map, std::size_t owned, const std::string& message,
                      MPI_Comm communicator) {
  const auto end = map.solid.begin() + static_cast<std::ptrdiff_t>(owned);
  if (sum(std::int64_t{std::count(map.solid.begin(), end, 1)}, communicator) == 0) {
    throw InputError(message);
  }
}

/// Finds material where there is a value and the mask, if any, is not zero; `owned` pixels of this
/// rank come before those of its neighbour. Collective.
void find_solid(const StoredArray& array, const std::string& mask_name, RowRange rows,
                std::size_t owned, MPI_Comm communicator, SolidValues& map) {
  for (const double value : map.values) map.solid.push_back(std::isnan(value) ? 0 : 1);
  require_material(map, owned, array.name() + ": found nothing but NaN, allowed are numbers",
                   communicator);
  if (mask_name.empty()) return;
  const StoredArray mask = find_array(mask_name, communicator);
  if (mask.shape != array.shape) {
    throw InputError("--mask: " + mask_name + " has another shape than " + array.file);
  }
  const std::vector<double> flags = read_rows(mask, rows.first, rows.count, communicator);
  std::int64_t doubtful = 0;
  for (std::size_t i = 0; i < flags.size(); ++i) {
    doubtful += i < owned && std::isnan(flags[i]) ? 1 : 0;
    map.unknown += i < owned && flags[i] != 0.0 && map.solid[i] == 0 ? 1 : 0;
    map.solid[i] = flags[i] != 0.0 ? map.solid[i] : 0;
  }
  doubtful = sum(doubtful, communicator);
  map.unknown = sum(map.unknown, communicator);
  if (doubtful > 0) {
    throw InputError("--mask: " + mask_name + " has " + std::to_string(doubtful) +
                     " NaN, allowed are 0 for void and other numbers for material");
  }
  require_material(map, owned,
                   "--mask: " + mask_name +
                       " leaves no pixel with a value; allowed are 0 for void " +
                       "and other numbers for material, at least one",
                   communicator);
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

/// A field of the particles as pixels, their places relative to a grid that has moved by `shift`
/// (m). Collective.
template <int Dim>
PixelField<Dim> map_in_space(const std::vector<double>& values, const Columns& columns,
                             const Scene& scene, const Vector<Dim>& shift,
                             const PixelGrid<Dim>& grid) {
  auto position = columns.read("position", Dim);
  const auto mass = columns.read("mass", 1);
  const auto density = columns.read("density", 1);
  PixelSources<Dim> sources;
  for (std::size_t a = 0; a < Dim; ++a) {
    for (double& x : position[a]) x -= shift[static_cast<Eigen::Index>(a)];
    sources.position[a] = position[a];
  }
  sources.mass = mass[0];
  sources.density = density[0];
  PixelScales scales = {0.0, 2.0 * scene.domain.cell};
  for (const MaterialParameters& m : scene.materials) {
    scales.density = std::max(scales.density, m.density);
  }
  return deposit<Dim>(sources, {values}, scales, grid);
}

template <int Dim>
PixelLayout<Dim> layout_of(const Scene& scene, double pixel) {
  PixelLayout<Dim> layout;
  layout.pixel_size = pixel;
  for (int a = 0; a < Dim; ++a) {
    const double pixels = scene.domain.size[a] / pixel;
    if (!(std::round(pixels) >= 1.0 && pixels < 0x1p31) ||
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
  const RowRange rows = {static_cast<std::uint64_t>(grid.first_row()),
                         static_cast<std::uint64_t>(map.rows) + (map.last ? 0U : 1U), 0};
  const std::size_t owned = static_cast<std::size_t>(map.rows) * grid.row_size();
  SolidValues read{read_rows(array, rows.first, rows.count, communicator), {}};
  find_solid(array, options.mask, rows, owned, communicator, read);
  result.unknown = read.unknown;
  read.values.resize(owned + grid.row_size(), std::nan(""));
  read.solid.resize(owned + grid.row_size(), 0);
  map.values = {std::move(read.values)};
  map.solid = std::move(read.solid);
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
  if (sites && options.pixel) {
    throw InputError(
        "--pixel: the run measured on the lattice of its particles, which has pixels "
        "of its own");
  }
  const double pixel = options.pixel.value_or(scene.morphology.pixel);
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
  if (sites) {
    std::vector<std::int64_t> id(columns.rows.count);
    file.read<std::int64_t>("/particles/id", columns.rows.first, id);
    result.map = place_on_lattice<Dim>(id, {values}, grid);
  } else {
    for (int a = 0; a < Dim; ++a) {
      result.shift[a] = file.number(std::string("origin_") + "xyz"[a]);
    }
    result.map = map_in_space<Dim>(values, columns, scene, result.shift, grid);
  }
  result.map.single_precision = scene.output.precision == Precision::single_precision;
  return result;
}

template StoredMap<2> map_of_array<2>(const StoredArray&, const AnalyzeOptions&, MPI_Comm);
template StoredMap<3> map_of_array<3>(const StoredArray&, const AnalyzeOptions&, MPI_Comm);
template StoredMap<2> map_of_snapshot<2>(const std::string&, const AnalyzeOptions&, MPI_Comm);
template StoredMap<3> map_of_snapshot<3>(const std::string&, const AnalyzeOptions&, MPI_Comm);

}  // namespace poreshock
