#include "poreshock/output/checkpoint.hpp"

#include <algorithm>

#include "poreshock/core/error.hpp"
#include "poreshock/core/rank_zero.hpp"
#include "poreshock/files/block_hash.hpp"
#include "poreshock/files/hdf5_file.hpp"
#include "poreshock/files/posix_file.hpp"
#include "root_attributes.hpp"

namespace poreshock {

namespace {

constexpr std::int64_t checkpoint_format = 1;
constexpr const char* integers_path = "/state/integers";

std::string column_path(std::string_view name, int component) {
  std::string path = "/particles/" + std::string(name);
  if (component >= 0) path.append("_").append(std::to_string(component));
  return path;
}

template <class Column>
using Number = typename std::remove_cvref_t<Column>::value_type;

template <int Dim>
FileSpec file_spec(const std::string& scene_text, const RunState& state,
                   const Particles<Dim>& particles, std::uint64_t rows) {
  FileSpec spec;
  spec.attributes = root_attributes("checkpoint", state.time, state.step, scene_text);
  spec.attributes.push_back({"format", checkpoint_format});
  spec.attributes.push_back({"dimension", std::int64_t{Dim}});
  spec.attributes.push_back({"last_dt", state.last_dt});
  spec.attributes.push_back({"beat", state.beat});
  spec.attributes.push_back({"record", state.record});
  for_each_option(particles.options, [&](std::string_view name, bool on) {
    spec.attributes.push_back({std::string(name), std::int64_t{on}});
  });
  if (state.first_total) spec.attributes.push_back({"first_total", *state.first_total});
  spec.datasets.push_back({integers_path, NumberType::int64, {state.integers.size()}, "1", {}});
  for_each_entry(
      [&](const auto& entry, const auto& member) {
        for_each_component(
            [&](int component, const auto& column) {
              spec.datasets.push_back({column_path(entry.name, component),
                                       number_type_of<Number<decltype(column)>>,
                                       {rows},
                                       std::string(entry.unit),
                                       {}});
            },
            member);
      },
      particles);
  return spec;
}

/// Refuses what is not a checkpoint this program can read.
void check_kind(Hdf5File& file) {
  const auto kind = file.attribute("kind");
  if (!kind || *kind != AttributeValue("checkpoint")) {
    throw InputError(file.path() + ": not a checkpoint of poreshock");
  }
  const std::int64_t format = file.integer("format");
  if (format > checkpoint_format) {
    throw InputError(file.path() + ": written by a newer poreshock (" + file.text("version") +
                     "): checkpoint format " + std::to_string(format) +
                     ", this program reads up to " + std::to_string(checkpoint_format));
  }
}

/// Whether an optional column is there; files older than the column do not name it.
bool optional_column(Hdf5File& file, const std::string& name) {
  return file.attribute(name) && file.integer(name) != 0;
}

RunState read_state(Hdf5File& file) {
  RunState state;
  state.step = file.integer("step");
  state.time = file.number("time");
  state.last_dt = file.number("last_dt");
  state.beat = file.integer("beat");
  state.record = file.integer("record");
  if (file.attribute("first_total")) state.first_total = file.number("first_total");
  state.integers = file.read_all<std::int64_t>(integers_path);
  return state;
}

}  // namespace

std::string checkpoint_name(std::int64_t step) {
  return numbered_name("checkpoint_", step, 9, ".h5");
}

template <int Dim>
void write_checkpoint(const std::string& path, const std::string& scene_text, const RunState& state,
                      const Particles<Dim>& particles, MPI_Comm communicator) {
  const RowRange rows = rows_in_rank_order(particles.size(), communicator);
  Hdf5File file = Hdf5File::create(path, file_spec(scene_text, state, particles, rows.total),
                                   communicator, Replace::yes);
  const std::size_t integers = rank(communicator) == 0 ? state.integers.size() : 0;
  file.write<std::int64_t>(integers_path, 0, std::span(state.integers).first(integers));
  for_each_column(particles, [&](std::string_view name, int component, const auto& column) {
    file.write<Number<decltype(column)>>(column_path(name, component), rows.first, column);
  });
  file.finish();
}

template <int Dim>
void read_checkpoint(const std::string& path, MPI_Comm communicator, std::string& scene_text,
                     RunState& state, Particles<Dim>& particles) {
  verify(path, communicator);
  Hdf5File file = Hdf5File::open(path, communicator);
  check_kind(file);
  const std::int64_t dimension = file.integer("dimension");
  if (dimension != Dim) {
    throw InputError(path + ": holds a " + std::to_string(dimension) +
                     "-D run, the scene asks for " + std::to_string(Dim) + "-D");
  }
  scene_text = file.text("scene");
  state = read_state(file);
  particles = Particles<Dim>{};
  for_each_option(particles.options, [&](std::string_view name, bool& on) {
    on = optional_column(file, std::string(name));
  });
  const RowRange rows = equal_share(file.dataset(column_path("id", -1)).rows(), communicator);
  resize(particles, rows.count);
  for_each_column(particles, [&](std::string_view name, int component, auto& column) {
    using T = Number<decltype(column)>;
    file.read<T>(column_path(name, component), rows.first, std::span<T>(column));
  });
}

CheckpointHeader checkpoint_header(const std::string& path, MPI_Comm communicator) {
  // HDF5 itself may not survive a damaged file, so that nothing of it is read before.
  verify(path, communicator);
  Hdf5File file = Hdf5File::open(path, communicator);
  check_kind(file);
  CheckpointHeader header;
  header.dimension = static_cast<int>(file.integer("dimension"));
  header.step = file.integer("step");
  header.time = file.number("time");
  header.particles = static_cast<std::int64_t>(file.dataset(column_path("id", -1)).rows());
  header.scene_text = file.text("scene");
  return header;
}

std::string latest_checkpoint(const std::string& folder, MPI_Comm communicator, std::string& note) {
  note.clear();
  std::string names;
  on_rank_zero(communicator, [&] {
    for (const NumberedFile& file : numbered_files(folder, "checkpoint_", 9, ".h5")) {
      names.insert(0, file.path + '\n');
    }
  });
  broadcast(names, communicator);
  for (std::size_t at = 0; at < names.size();) {
    const std::size_t end = names.find('\n', at);
    const std::string path = names.substr(at, end - at);
    at = end + 1;
    try {
      checkpoint_header(path, communicator);
      return path;
    } catch (const std::runtime_error& failure) {
      note += std::string(note.empty() ? "" : "\n") + "passed over " + failure.what();
    }
  }
  throw InputError(folder + ": holds no usable checkpoint (checkpoint_NNNNNNNNN.h5)" +
                   (note.empty() ? "" : ":\n" + note));
}

void remove_checkpoints_after(const std::string& folder, std::int64_t step, MPI_Comm communicator) {
  on_rank_zero(communicator, [&] {
    for (const NumberedFile& file : numbered_files(folder, "checkpoint_", 9, ".h5")) {
      if (file.number > step) remove_file(file.path);
    }
  });
}

void prune_checkpoints(const std::string& folder, int keep, MPI_Comm communicator) {
  on_rank_zero(communicator, [&] {
    const auto files = numbered_files(folder, "checkpoint_", 9, ".h5");
    const auto kept = static_cast<std::size_t>(std::max(1, keep));
    for (std::size_t i = 0; i + kept < files.size(); ++i) remove_file(files[i].path);
  });
}

template void write_checkpoint<2>(const std::string&, const std::string&, const RunState&,
                                  const Particles<2>&, MPI_Comm);
template void write_checkpoint<3>(const std::string&, const std::string&, const RunState&,
                                  const Particles<3>&, MPI_Comm);
template void read_checkpoint<2>(const std::string&, MPI_Comm, std::string&, RunState&,
                                 Particles<2>&);
template void read_checkpoint<3>(const std::string&, MPI_Comm, std::string&, RunState&,
                                 Particles<3>&);

}  // namespace poreshock
