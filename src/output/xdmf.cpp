#include "poreshock/output/xdmf.hpp"

#include <array>
#include <charconv>
#include <filesystem>
#include <sstream>
#include <variant>
#include <vector>

#include "poreshock/core/rank_zero.hpp"
#include "poreshock/files/hdf5_file.hpp"
#include "poreshock/files/posix_file.hpp"

namespace poreshock {

namespace {

std::string shortest(double value) {
  char text[32];
  const auto end = std::to_chars(text, text + sizeof(text), value).ptr;
  return {text, end};
}

void write_item(const std::string& file, const DatasetInfo& info, std::ostream& out) {
  const bool integer = *info.type != NumberType::float64 && *info.type != NumberType::float32;
  out << "<DataItem Format=\"HDF\" NumberType=\"" << (integer ? "Int" : "Float")
      << "\" Precision=\"" << number_size(*info.type) << "\" Dimensions=\"";
  for (std::size_t d = 0; d < info.shape.size(); ++d) out << (d > 0 ? " " : "") << info.shape[d];
  out << "\">" << file << ":" << info.path << "</DataItem>";
}

std::string_view attribute_type(const DatasetInfo& info) {
  if (info.shape.size() == 1) return "Scalar";
  // Tensor6 would promise another order of components than ours, and Vector three of them.
  return info.shape[1] == 3 ? "Vector" : "Matrix";
}

void write_grid(const std::string& path, std::ostream& out) {
  Hdf5File snapshot = Hdf5File::open(path, MPI_COMM_SELF);
  const std::string name = std::filesystem::path(path).filename().string();
  const DatasetInfo position = snapshot.dataset("/particles/position");
  out << "   <Grid Name=\"" << std::filesystem::path(path).stem().string()
      << "\" GridType=\"Uniform\">\n    <Time Value=\"" << shortest(snapshot.number("time"))
      << "\"/>\n    <Topology TopologyType=\"Polyvertex\" NumberOfElements=\"" << position.rows()
      << "\" NodesPerElement=\"1\"/>\n    <Geometry GeometryType=\""
      << (position.shape.at(1) == 2 ? "XY" : "XYZ") << "\">";
  write_item(name, position, out);
  out << "</Geometry>\n";
  for (const DatasetInfo& info : snapshot.datasets()) {
    const bool shown = info.path.starts_with("/particles/") || info.path == "/slabs/owner";
    if (!shown || info.path == position.path || !info.type) continue;
    out << "    <Attribute Name=\"" << info.path.substr(info.path.rfind('/') + 1)
        << "\" Center=\"Node\" AttributeType=\"" << attribute_type(info) << "\">";
    write_item(name, info, out);
    out << "</Attribute>\n";
  }
  out << "   </Grid>\n";
}

void write_numbers(const std::array<double, 3>& numbers, std::ostream& out) {
  out << "<DataItem Format=\"XML\" NumberType=\"Float\" Precision=\"8\" Dimensions=\"3\">"
      << shortest(numbers[0]) << " " << shortest(numbers[1]) << " " << shortest(numbers[2])
      << "</DataItem>";
}

/// Mesh of a map, from the slowest axis to the fastest. A map of the plane is a layer as thick as a
/// pixel: ParaView turns plane meshes out of the plane of the particles.
void write_mesh(Hdf5File& snapshot, const DatasetInfo& info, std::ostream& out) {
  const double pixel = std::get<double>(snapshot.attribute("pixel", info.path).value());
  std::array<double, 3> low = {-0.5 * pixel, 0.0, 0.0};
  std::array<std::uint64_t, 3> nodes = {2, 0, 0};
  for (std::size_t axis = 0; axis < info.shape.size(); ++axis) {
    low[2 - axis] =
        std::get<double>(snapshot.attribute(std::string("low_") + "xyz"[axis], info.path).value());
    nodes[2 - axis] = info.shape[info.shape.size() - 1 - axis] + 1;
  }
  out << "    <Topology TopologyType=\"3DCoRectMesh\" Dimensions=\"" << nodes[0] << " " << nodes[1]
      << " " << nodes[2] << "\"/>\n    <Geometry GeometryType=\"ORIGIN_DXDYDZ\">";
  write_numbers(low, out);
  write_numbers({pixel, pixel, pixel}, out);
  out << "</Geometry>\n";
}

/// The maps of a snapshot as values of the cells of a mesh; nothing without maps.
void write_maps(const std::string& path, std::ostream& out) {
  Hdf5File snapshot = Hdf5File::open(path, MPI_COMM_SELF);
  std::vector<DatasetInfo> maps;
  for (const DatasetInfo& info : snapshot.datasets()) {
    if (info.path.starts_with("/map/") && info.type) maps.push_back(info);
  }
  if (maps.empty()) return;
  const std::filesystem::path file = path;
  out << "   <Grid Name=\"" << file.stem().string() << "\" GridType=\"Uniform\">\n"
      << "    <Time Value=\"" << shortest(snapshot.number("time")) << "\"/>\n";
  write_mesh(snapshot, maps.front(), out);
  for (DatasetInfo& info : maps) {
    if (info.shape.size() == 2) info.shape.insert(info.shape.begin(), 1);
    out << "    <Attribute Name=\"" << info.path.substr(info.path.rfind('/') + 1)
        << "\" Center=\"Cell\" AttributeType=\"Scalar\">";
    write_item(file.filename().string(), info, out);
    out << "</Attribute>\n";
  }
  out << "   </Grid>\n";
}

/// What write(path, out) says of the snapshots of a folder, one after the other.
template <class Write>
std::string grids(const std::string& folder, Write write) {
  std::string all;
  for (const NumberedFile& file : numbered_files(folder, "snapshot_", 6, ".h5")) {
    std::ostringstream grid;
    if (attempt([&] { write(file.path, grid); }).code == ExitCode::success) all += grid.str();
  }
  return all;
}

/// The file of a series in time.
std::string series(const std::string& name, const std::string& grids) {
  return "<?xml version=\"1.0\" ?>\n<Xdmf Version=\"3.0\">\n <Domain>\n  <Grid Name=\"" + name +
         "\" GridType=\"Collection\" CollectionType=\"Temporal\">\n" + grids +
         "  </Grid>\n </Domain>\n</Xdmf>\n";
}

}  // namespace

void write_xdmf(const std::string& folder, MPI_Comm communicator) {
  on_rank_zero(communicator, [&] {
    write_text(folder + "/snapshots.xdmf", series("particles", grids(folder, write_grid)));
    const std::string maps = grids(folder, write_maps);
    if (!maps.empty()) write_text(folder + "/maps.xdmf", series("maps", maps));
  });
}

}  // namespace poreshock
