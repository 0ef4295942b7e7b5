#include "poreshock/output/snapshot.hpp"

#include <algorithm>
#include <type_traits>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/files/hdf5_file.hpp"
#include "poreshock/files/posix_file.hpp"
#include "poreshock/material/derived.hpp"
#include "poreshock/scene/transfer_scheme.hpp"
#include "root_attributes.hpp"

namespace poreshock {

namespace {

template <int Dim>
struct Source {
  const SnapshotInput<Dim>& input;
  bool coloured;          ///< on all ranks; one of them may have no particles, and then no colours
  double affine_inertia;  ///< m^2
  std::vector<double> temperature;
};

/// Whether a dataset is written; a reader needs the id and the position of every snapshot.
bool wanted(const Scene& scene, std::string_view name) {
  const std::vector<std::string>& list = scene.output.fields;
  return list.empty() || name == "id" || name == "position" ||
         std::find(list.begin(), list.end(), name) != list.end();
}

/// Calls visit(name, unit, components, value) for every dataset of the particles that the scene
/// wants; value(i, c) is component c of particle i, in the type of the column.
template <int Dim, class Visitor>
void for_each_dataset(const Source<Dim>& source, Visitor&& visit) {
  const SnapshotInput<Dim>& input = source.input;
  const Particles<Dim>& p = input.particles;
  const auto give = [&](std::string_view name, std::string_view unit, int components,
                        const auto& value) {
    if (wanted(input.scene, name)) visit(name, unit, components, value);
  };
  for_each_entry(
      [&](const auto& entry, const auto& member) {
        if (!entry.use.shown) return;
        if constexpr (has_components<std::remove_cvref_t<decltype(member)>>) {
          give(entry.name, entry.unit, static_cast<int>(member.size()),
               [&](std::size_t i, std::size_t c) { return member[c][i]; });
        } else {
          give(entry.name, entry.unit, 1, [&](std::size_t i, std::size_t) { return member[i]; });
        }
      },
      p);
  if (source.coloured) {
    give("colour", "1", 1, [&](std::size_t i, std::size_t) { return input.colour[i]; });
  }
  give("position", "m", Dim, [&](std::size_t i, std::size_t c) {
    return p.position[c][i] + input.shift[static_cast<Eigen::Index>(c)];
  });
  give("stress", "Pa", symmetric_size<Dim>, [&](std::size_t i, std::size_t c) {
    return p.deviator[c][i] - (c < 3 ? p.pressure[i] : 0.0);
  });
  give("temperature", "K", 1, [&](std::size_t i, std::size_t) { return source.temperature[i]; });
  if (can_melt(input.scene)) {
    give("molten", "1", 1, [&](std::size_t i, std::size_t) {
      return particle_phase<Dim>(p, input.materials, input.scene.thermal, i).molten;
    });
  }
  give("kinetic_energy", "J/kg", 1,
       [&](std::size_t i, std::size_t) { return kinetic_energy(p, source.affine_inertia, i); });
}

/// Type in the file of numbers that are of type T in the program.
template <class T>
NumberType type_in_file(const Scene& scene) {
  const bool single = scene.output.precision == Precision::single_precision;
  return std::is_same_v<T, double> && single ? NumberType::float32 : number_type_of<T>;
}

/// Type of the numbers of a dataset in the program.
template <class Value>
using Number = std::invoke_result_t<Value, std::size_t, std::size_t>;

const std::string map_folder = "/map/";

/// Rank whose slab a particle was in; how a run was cut is not part of its result.
constexpr const char* owner_path = "/slabs/owner";

template <int Dim>
FileSpec file_spec(const Source<Dim>& source, std::uint64_t rows, std::int64_t floored) {
  const SnapshotInput<Dim>& input = source.input;
  FileSpec spec;
  spec.attributes = root_attributes("snapshot", input.time, input.step, input.scene_text);
  spec.attributes.push_back({"record", input.record});
  spec.attributes.push_back({"dimension", std::int64_t{Dim}});
  spec.attributes.push_back(
      {"thermal", input.scene.thermal == Thermal::paper ? "paper" : "conserving"});
  // The low corner of the domain, m.
  for (int axis = 0; axis < Dim; ++axis) {
    const double low = input.shift[axis] + (axis + 1 < Dim ? 0.0 : input.bottom);
    spec.attributes.push_back({std::string("origin_") + "xyz"[axis], low});
  }
  for_each_dataset(
      source, [&](std::string_view name, std::string_view unit, int components, const auto& value) {
        std::vector<std::uint64_t> shape = {rows};
        if (components > 1) shape.push_back(static_cast<std::uint64_t>(components));
        spec.datasets.push_back({"/particles/" + std::string(name),
                                 type_in_file<Number<decltype(value)>>(input.scene),
                                 shape,
                                 std::string(unit),
                                 {}});
        if (name == "temperature") spec.datasets.back().attributes = {{"set_to_floor", floored}};
      });
  spec.datasets.push_back({owner_path, NumberType::int32, {rows}, "1", {}});
  for (const SnapshotMap& map : input.maps) {
    std::vector<Attribute> place = {{"pixel", map.pixel}};
    for (int axis = 0; axis < Dim; ++axis) {
      place.push_back({std::string("low_") + "xyz"[axis], map.low[axis]});
    }
    spec.datasets.push_back(
        {map_folder + map.name, type_in_file<double>(input.scene), map.shape, map.unit, place});
  }
  return spec;
}

/// Particles whose numbers one rank gathers for one call.
constexpr std::size_t rows_at_once = std::size_t{1} << 16;

/// Where the particles of this rank stand in the datasets.
struct RowsInFile {
  std::size_t count;
  std::uint64_t first;
  int pieces;  ///< the same on all ranks
};

/// Writes value(i, c) of all particles as numbers of type T in pieces, so that no second copy of a
/// whole field is ever held. Collective.
template <class T, class Value>
void write_pieces(const std::string& path, std::size_t components, const Value& value,
                  const RowsInFile& rows, Hdf5File& file) {
  std::vector<T> values;
  for (int piece = 0; piece < rows.pieces; ++piece) {
    const std::size_t begin = std::min(rows.count, static_cast<std::size_t>(piece) * rows_at_once);
    const std::size_t end = std::min(rows.count, begin + rows_at_once);
    values.clear();
    for (std::size_t i = begin; i < end; ++i) {
      for (std::size_t c = 0; c < components; ++c) values.push_back(static_cast<T>(value(i, c)));
    }
    file.write<T>(path, rows.first + begin, values);
  }
}

template <int Dim>
void write_particles(const Source<Dim>& source, const RowsInFile& rows, Hdf5File& file) {
  for_each_dataset(source,
                   [&](std::string_view name, std::string_view, int components, const auto& value) {
                     using T = Number<decltype(value)>;
                     const std::string path = "/particles/" + std::string(name);
                     const auto count = static_cast<std::size_t>(components);
                     if (type_in_file<T>(source.input.scene) == NumberType::float32) {
                       write_pieces<float>(path, count, value, rows, file);
                     } else {
                       write_pieces<T>(path, count, value, rows, file);
                     }
                   });
}

void write_map(const SnapshotMap& map, NumberType type, Hdf5File& file) {
  const std::string dataset = map_folder + map.name;
  if (type == NumberType::float32) {
    const std::vector<float> values(map.values.begin(), map.values.end());
    file.write<float>(dataset, map.first_row, values);
  } else {
    file.write<double>(dataset, map.first_row, map.values);
  }
}

}  // namespace

std::string snapshot_name(std::int64_t record) {
  return numbered_name("snapshot_", record, 6, ".h5");
}

template <int Dim>
std::size_t snapshot_bytes_per_particle(const SnapshotInput<Dim>& input, bool coloured) {
  std::size_t bytes = 0;
  const Source<Dim> source{input, coloured, 0.0, {}};
  for (const DatasetSpec& dataset : file_spec(source, 1, 0).datasets) {
    if (dataset.path.starts_with(map_folder)) continue;
    const std::uint64_t components = dataset.shape.size() > 1 ? dataset.shape[1] : 1;
    bytes += components * number_size(dataset.type);
  }
  return bytes;
}

template <int Dim>
std::int64_t write_snapshot(const std::string& path, const SnapshotInput<Dim>& input,
                            MPI_Comm communicator) {
  const std::size_t count = input.particles.size();
  Source<Dim> source{input,
                     sum(static_cast<std::int64_t>(input.colour.size()), communicator) > 0,
                     affine_inertia(input.scene.transfer, input.scene.domain.cell),
                     {}};
  std::int64_t floored = 0;
  if (wanted(input.scene, "temperature")) {
    floored = sum(derive_field("temperature", input.particles, input.materials, input.scene.thermal,
                               source.temperature),
                  communicator);
  }
  const RowRange rows = rows_in_rank_order(count, communicator);
  Hdf5File file = Hdf5File::create(path, file_spec(source, rows.total, floored), communicator,
                                   Replace::yes, Durable::later);
  const int pieces =
      largest(static_cast<int>((count + rows_at_once - 1) / rows_at_once), communicator);
  write_particles(source, {count, rows.first, pieces}, file);
  const std::vector<std::int32_t> owner(count, rank(communicator));
  file.write<std::int32_t>(owner_path, rows.first, owner);
  for (const SnapshotMap& map : input.maps) {
    write_map(map, type_in_file<double>(input.scene), file);
  }
  file.finish();
  return floored;
}

template std::size_t snapshot_bytes_per_particle<2>(const SnapshotInput<2>&, bool);
template std::size_t snapshot_bytes_per_particle<3>(const SnapshotInput<3>&, bool);
template std::int64_t write_snapshot<2>(const std::string&, const SnapshotInput<2>&, MPI_Comm);
template std::int64_t write_snapshot<3>(const std::string&, const SnapshotInput<3>&, MPI_Comm);

}  // namespace poreshock
