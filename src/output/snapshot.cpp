#include "poreshock/output/snapshot.hpp"

#include <algorithm>
#include <array>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/output/hdf5_file.hpp"
#include "poreshock/output/posix_file.hpp"
#include "poreshock/particles/derived.hpp"
#include "root_attributes.hpp"

namespace poreshock {

namespace {

template <int Dim>
struct Source {
  const SnapshotInput<Dim>& input;
  std::vector<double> temperature;
  double affine_inertia;  ///< m^2
};

/// One dataset of floating-point numbers: component c of particle i.
template <int Dim>
struct Field {
  std::string_view name;
  int components;
  std::string_view unit;
  double (*value)(const Source<Dim>& source, std::size_t i, std::size_t c);
};

template <int Dim>
auto fields() {
  using S = const Source<Dim>&;
  using N = std::size_t;
  return std::array<Field<Dim>, 11>{{
      {"position", Dim, "m",
       [](S s, N i, N c) {
         return s.input.particles.position[c][i] + s.input.shift[static_cast<Eigen::Index>(c)];
       }},
      {"velocity", Dim, "m/s", [](S s, N i, N c) { return s.input.particles.velocity[c][i]; }},
      {"mass", 1, Dim == 2 ? "kg/m" : "kg", [](S s, N i, N) { return s.input.particles.mass[i]; }},
      {"density", 1, "kg/m^3", [](S s, N i, N) { return s.input.particles.density[i]; }},
      {"pressure", 1, "Pa", [](S s, N i, N) { return s.input.particles.pressure[i]; }},
      {"stress", symmetric_size<Dim>, "Pa",
       [](S s, N i, N c) {
         const Particles<Dim>& p = s.input.particles;
         return p.deviator[c][i] - (c < 3 ? p.pressure[i] : 0.0);
       }},
      {"temperature", 1, "K", [](S s, N i, N) { return s.temperature[i]; }},
      {"plastic_strain", 1, "1", [](S s, N i, N) { return s.input.particles.plastic_strain[i]; }},
      {"plastic_work", 1, "J/kg", [](S s, N i, N) { return s.input.particles.plastic_work[i]; }},
      {"internal_energy", 1, "J/kg",
       [](S s, N i, N) { return s.input.particles.internal_energy[i]; }},
      {"kinetic_energy", 1, "J/kg",
       [](S s, N i, N) { return kinetic_energy(s.input.particles, s.affine_inertia, i); }},
  }};
}

/// Datasets of the physics that only some scenes ask for: none without.
template <int Dim>
std::vector<Field<Dim>> optional_fields(const Particles<Dim>& particles) {
  std::vector<Field<Dim>> list;
  if (particles.options.conducted_heat) {
    list.push_back(
        {"conducted_heat", 1, "J/kg", [](const Source<Dim>& s, std::size_t i, std::size_t) {
           return s.input.particles.conducted_heat[i];
         }});
  }
  return list;
}

/// The datasets of floating-point numbers of one snapshot.
template <int Dim>
std::vector<Field<Dim>> fields_of(const Particles<Dim>& particles) {
  const auto common = fields<Dim>();
  std::vector<Field<Dim>> list(common.begin(), common.end());
  for (const auto& field : optional_fields(particles)) list.push_back(field);
  return list;
}

/// Whether a dataset is written; a reader needs the id and the position of every snapshot.
bool wanted(const Scene& scene, std::string_view name) {
  const std::vector<std::string>& list = scene.output.fields;
  return list.empty() || name == "id" || name == "position" ||
         std::find(list.begin(), list.end(), name) != list.end();
}

const std::string map_folder = "/map/";

/// Rank whose slab a particle was in; how a run was cut is not part of its result.
constexpr const char* owner_path = "/slabs/owner";

template <int Dim>
FileSpec file_spec(const SnapshotInput<Dim>& input, std::uint64_t rows, std::int64_t floored,
                   bool coloured) {
  FileSpec spec;
  spec.attributes = root_attributes("snapshot", input.time, input.step, input.scene_text);
  spec.attributes.push_back({"record", input.record});
  spec.attributes.push_back({"dimension", std::int64_t{Dim}});
  spec.attributes.push_back(
      {"thermal", input.scene.thermal == Thermal::paper ? "paper" : "conserving"});
  // The low corner of the grid, m; positions less this are those on the grid.
  for (int axis = 0; axis < Dim; ++axis) {
    spec.attributes.push_back({std::string("origin_") + "xyz"[axis], input.shift[axis]});
  }
  const auto add = [&](std::string_view name, NumberType type, int components,
                       std::string_view unit) {
    if (!wanted(input.scene, name)) return;
    std::vector<std::uint64_t> shape = {rows};
    if (components > 1) shape.push_back(static_cast<std::uint64_t>(components));
    spec.datasets.push_back(
        {"/particles/" + std::string(name), type, shape, std::string(unit), {}});
    if (name == "temperature") spec.datasets.back().attributes = {{"set_to_floor", floored}};
  };
  add("id", NumberType::int64, 1, "1");
  add("grain", NumberType::int32, 1, "1");
  add("material", NumberType::int32, 1, "1");
  if (input.particles.options.failed) add("failed", NumberType::int32, 1, "1");
  if (coloured) add("colour", NumberType::int32, 1, "1");
  const bool single = input.scene.output.precision == Precision::single_precision;
  for (const auto& field : fields_of(input.particles)) {
    add(field.name, single ? NumberType::float32 : NumberType::float64, field.components,
        field.unit);
  }
  spec.datasets.push_back({owner_path, NumberType::int32, {rows}, "1", {}});
  for (const SnapshotMap& map : input.maps) {
    std::vector<Attribute> place = {{"pixel", map.pixel}};
    for (int axis = 0; axis < Dim; ++axis) {
      place.push_back({std::string("low_") + "xyz"[axis], map.low[axis]});
    }
    spec.datasets.push_back({map_folder + map.name,
                             single ? NumberType::float32 : NumberType::float64, map.shape,
                             map.unit, place});
  }
  return spec;
}

/// Particles whose numbers one rank gathers for one call.
constexpr std::size_t rows_at_once = std::size_t{1} << 16;

/// Writes one dataset in pieces, so that no second copy of a whole field is ever held. Collective;
/// all ranks give the same number of `pieces`.
template <class T, int Dim>
void write_field(const Field<Dim>& field, const Source<Dim>& source, std::uint64_t first_row,
                 int pieces, Hdf5File& file) {
  const std::size_t count = source.input.particles.size();
  const auto components = static_cast<std::size_t>(field.components);
  const std::string path = "/particles/" + std::string(field.name);
  std::vector<T> values;
  for (int piece = 0; piece < pieces; ++piece) {
    const std::size_t begin = std::min(count, static_cast<std::size_t>(piece) * rows_at_once);
    const std::size_t end = std::min(count, begin + rows_at_once);
    values.clear();
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t c = 0; c < components; ++c) {
        values.push_back(static_cast<T>(field.value(source, i, c)));
      }
    }
    file.write<T>(path, first_row + begin, values);
  }
}

}  // namespace

std::string snapshot_name(std::int64_t record) {
  return numbered_name("snapshot_", record, 6, ".h5");
}

template <int Dim>
std::size_t snapshot_bytes_per_particle(const SnapshotInput<Dim>& input, bool coloured) {
  std::size_t bytes = 0;
  for (const DatasetSpec& dataset : file_spec(input, 1, 0, coloured).datasets) {
    if (dataset.path.starts_with(map_folder)) continue;
    const std::uint64_t components = dataset.shape.size() > 1 ? dataset.shape[1] : 1;
    bytes += components * number_size(dataset.type);
  }
  return bytes;
}

template <int Dim>
std::int64_t write_snapshot(const std::string& path, const SnapshotInput<Dim>& input,
                            MPI_Comm communicator) {
  const Particles<Dim>& particles = input.particles;
  Source<Dim> source{input, {}, affine_inertia(input.scene.transfer, input.scene.domain.cell)};
  std::int64_t floored = 0;
  if (wanted(input.scene, "temperature")) {
    floored = sum(derive_field("temperature", particles, input.materials, input.scene.thermal,
                               source.temperature),
                  communicator);
  }
  const RowRange rows = rows_in_rank_order(particles.size(), communicator);
  // A rank may have no particles, and then no colours.
  const bool coloured = sum(static_cast<std::int64_t>(input.colour.size()), communicator) > 0;
  Hdf5File file = Hdf5File::create(path, file_spec(input, rows.total, floored, coloured),
                                   communicator, Replace::yes, Durable::later);
  const auto write_integers = [&](std::string_view name, const auto& column) {
    using T = typename std::remove_cvref_t<decltype(column)>::value_type;
    if (!wanted(input.scene, name)) return;
    file.write<T>("/particles/" + std::string(name), rows.first, column);
  };
  write_integers("id", particles.id);
  write_integers("grain", particles.grain);
  write_integers("material", particles.material);
  if (particles.options.failed) write_integers("failed", particles.failed);
  if (coloured) write_integers("colour", input.colour);
  const int pieces =
      largest(static_cast<int>((particles.size() + rows_at_once - 1) / rows_at_once), communicator);
  for (const auto& field : fields_of(particles)) {
    if (!wanted(input.scene, field.name)) continue;
    if (input.scene.output.precision == Precision::single_precision) {
      write_field<float>(field, source, rows.first, pieces, file);
    } else {
      write_field<double>(field, source, rows.first, pieces, file);
    }
  }
  const std::vector<std::int32_t> owner(particles.size(), rank(communicator));
  file.write<std::int32_t>(owner_path, rows.first, owner);
  for (const SnapshotMap& map : input.maps) {
    const std::string dataset = map_folder + map.name;
    if (input.scene.output.precision == Precision::single_precision) {
      const std::vector<float> values(map.values.begin(), map.values.end());
      file.write<float>(dataset, map.first_row, values);
    } else {
      file.write<double>(dataset, map.first_row, map.values);
    }
  }
  file.finish();
  return floored;
}

template std::size_t snapshot_bytes_per_particle<2>(const SnapshotInput<2>&, bool);
template std::size_t snapshot_bytes_per_particle<3>(const SnapshotInput<3>&, bool);
template std::int64_t write_snapshot<2>(const std::string&, const SnapshotInput<2>&, MPI_Comm);
template std::int64_t write_snapshot<3>(const std::string&, const SnapshotInput<3>&, MPI_Comm);

}  // namespace poreshock
