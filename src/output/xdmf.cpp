#include "poreshock/output/xdmf.hpp"

#include <charconv>
#include <filesystem>
#include <sstream>

#include "poreshock/output/hdf5_file.hpp"
#include "poreshock/output/posix_file.hpp"
#include "poreshock/output/rank_zero.hpp"

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

}  // namespace

void write_xdmf(const std::string& folder, MPI_Comm communicator) {
  on_rank_zero(communicator, [&] {
    std::ostringstream out;
    out << "<?xml version=\"1.0\" ?>\n<Xdmf Version=\"3.0\">\n <Domain>\n"
        << "  <Grid Name=\"particles\" GridType=\"Collection\" CollectionType=\"Temporal\">\n";
    for (const NumberedFile& file : numbered_files(folder, "snapshot_", 6, ".h5")) {
      std::ostringstream grid;
      if (attempt([&] { write_grid(file.path, grid); }).code == ExitCode::success)
        out << grid.str();
    }
    out << "  </Grid>\n </Domain>\n</Xdmf>\n";
    write_text(folder + "/snapshots.xdmf", out.str());
  });
}

}  // namespace poreshock
