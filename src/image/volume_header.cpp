#include "volume_header.hpp"

#include <fcntl.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <map>
#include <sstream>
#include <vector>

#include "poreshock/core/error.hpp"
#include "poreshock/files/posix_file.hpp"

namespace poreshock {
namespace {

using Types = std::map<std::string, std::string>;

const Types meta_types{{"MET_UCHAR", "u1"}, {"MET_CHAR", "i1"},  {"MET_USHORT", "u2"},
                       {"MET_SHORT", "i2"}, {"MET_UINT", "u4"},  {"MET_INT", "i4"},
                       {"MET_FLOAT", "f4"}, {"MET_DOUBLE", "f8"}};
const Types nrrd_types{
    {"uchar", "u1"},        {"unsigned char", "u1"}, {"uint8", "u1"},
    {"uint8_t", "u1"},      {"signed char", "i1"},   {"int8", "i1"},
    {"int8_t", "i1"},       {"ushort", "u2"},        {"unsigned short", "u2"},
    {"uint16", "u2"},       {"uint16_t", "u2"},      {"unsigned short int", "u2"},
    {"short", "i2"},        {"int16", "i2"},         {"int16_t", "i2"},
    {"signed short", "i2"}, {"short int", "i2"},     {"uint", "u4"},
    {"unsigned int", "u4"}, {"uint32", "u4"},        {"uint32_t", "u4"},
    {"int", "i4"},          {"signed int", "i4"},    {"int32", "i4"},
    {"int32_t", "i4"},      {"float", "f4"},         {"double", "f8"}};

/// The fields of a header, all that is wrong with it, and where the numbers may begin.
struct Header {
  std::string path;
  std::map<std::string, std::string> fields;
  std::vector<std::string> problems;
  std::uint64_t end = 0;  ///< first byte after it

  /// The text of a field, `standard` where it is missing.
  std::string text(const std::string& key, const std::string& standard = "") const {
    const auto at = fields.find(key);
    return at == fields.end() ? standard : at->second;
  }
  void refuse(const std::string& key, const std::string& allowed) {
    const bool known = fields.contains(key);
    problems.push_back("its header has " + (known ? key + " = " + fields[key] : "no " + key) +
                       ", allowed is " + allowed);
  }
};

std::string lower(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return text;
}

std::string trimmed(const std::string& text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  if (begin == std::string::npos) return "";
  return text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

/// The first bytes of a file, among which a header ends.
std::string first_bytes(const std::string& path) {
  constexpr std::uint64_t longest_header = 65536;
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) {
    throw InputError("sample.image: " + path + ": not found, or not a file");
  }
  const FileDescriptor file(path, O_RDONLY);
  std::string bytes(std::min(file.size(), longest_header), '\0');
  file.read(0, reinterpret_cast<std::byte*>(bytes.data()), bytes.size());
  return bytes;
}

/// Lines "key = value" up to that of the file of the numbers, which is the last.
Header read_meta(const std::string& path) {
  Header header{path, {}, {}, 0};
  const std::string bytes = first_bytes(path);
  while (header.end < bytes.size() && !header.fields.contains("ElementDataFile")) {
    const std::size_t line_end = std::min(bytes.find('\n', header.end), bytes.size());
    const std::string line = bytes.substr(header.end, line_end - header.end);
    const std::size_t equal = line.find('=');
    if (equal != std::string::npos) {
      header.fields[trimmed(line.substr(0, equal))] = trimmed(line.substr(equal + 1));
    }
    header.end = line_end + 1;
  }
  return header;
}

/// Lines "field: value" up to an empty line; keys of users, "key:=value", mean nothing here.
Header read_nrrd(const std::string& path) {
  Header header{path, {}, {}, 0};
  const std::string bytes = first_bytes(path);
  if (!bytes.starts_with("NRRD000")) {
    header.problems.push_back("it does not begin with NRRD000 and a version");
  }
  while (header.end < bytes.size()) {
    const std::size_t line_end = std::min(bytes.find('\n', header.end), bytes.size());
    const std::string line = trimmed(bytes.substr(header.end, line_end - header.end));
    header.end = line_end + 1;
    if (line.empty()) break;
    const std::size_t colon = line.find(": ");
    if (line[0] == '#' || colon == std::string::npos) continue;
    std::string key = lower(line.substr(0, colon));
    if (key == "datafile") key = "data file";
    if (key == "byteskip") key = "byte skip";
    if (key == "lineskip") key = "line skip";
    header.fields[key] = trimmed(line.substr(colon + 1));
  }
  return header;
}

/// Numbers of a text, parted by anything else; as many as can be read.
std::vector<double> numbers(const std::string& text) {
  std::string plain = text;
  std::replace_if(
      plain.begin(), plain.end(), [](char c) { return c == '(' || c == ')' || c == ','; }, ' ');
  std::istringstream stream(plain);
  std::vector<double> result;
  for (std::string word; stream >> word;) {
    double value = 0.0;
    const auto read = std::from_chars(word.data(), word.data() + word.size(), value);
    if (read.ec != std::errc{} || read.ptr != word.data() + word.size()) return {};
    result.push_back(value);
  }
  return result;
}

void find_shape(const std::string& key, int dimension, Header& header, StoredArray& array) {
  const std::vector<double> sizes = numbers(header.text(key));
  const bool whole = std::all_of(sizes.begin(), sizes.end(), [](double n) {
    return n >= 1.0 && n <= 1e9 && n == std::floor(n);
  });
  if (sizes.size() != static_cast<std::size_t>(dimension) || !whole) {
    header.refuse(key, std::to_string(dimension) +
                           " whole numbers from 1 to 1e9, voxels along x, " +
                           (dimension == 3 ? "y and z" : "y"));
    return;
  }
  for (const double n : sizes) {
    array.shape.insert(array.shape.begin(), static_cast<std::uint64_t>(n));
  }
}

void find_type(const std::string& key, const Types& types, Header& header, StoredArray& array) {
  const auto type = types.find(header.text(key));
  if (type != types.end()) {
    array.number = type->second;
    return;
  }
  std::string names;
  for (const auto& [name, number] : types) names += (names.empty() ? "" : ", ") + name;
  header.refuse(key, "one of " + names);
}

/// Voxels are cubes: edges that differ by more than rounding are a problem.
void check_edges(const std::string& key, const std::vector<double>& edges, Header& header) {
  for (const double edge : edges) {
    if (std::fabs(edge / edges[0] - 1.0) <= 1e-4) continue;
    header.refuse(key, "equal edges: voxels are cubes. Resample it");
    return;
  }
}

/// Where the numbers lie: after the header, or in a file beside it. A skip of -1 puts them at the
/// end of their file; bytes of compressed numbers are skipped after they were decompressed.
void find_numbers(const std::string& file, const std::string& skip_key, bool compressed,
                  Header& header, StoredArray& array) {
  const bool attached = file.empty() || file == "LOCAL";
  if (file.starts_with("LIST") || file.find('%') != std::string::npos) {
    header.problems.push_back("its numbers lie in several files (" + file +
                              "), allowed is one. Give the folder of the slices instead");
  }
  const std::filesystem::path folder = std::filesystem::path(header.path).parent_path();
  array.file = attached ? header.path : (folder / file).string();
  array.data_begin = attached ? header.end : 0;
  const std::vector<double> skip = numbers(header.text(skip_key, "0"));
  const double least = compressed ? 0.0 : -1.0;
  if (skip.size() != 1 || skip[0] < least || skip[0] > 1e15 || skip[0] != std::floor(skip[0])) {
    header.refuse(skip_key, compressed ? "a whole number of bytes, not -1 as they are compressed"
                                       : "a whole number of bytes, or -1");
    return;
  }
  if (compressed) {
    array.inflated = std::make_shared<InflatedFile>(array.file, array.data_begin);
    array.data_begin = 0;
  }
  if (skip[0] > 0.0) array.data_begin += static_cast<std::uint64_t>(skip[0]);
  if (skip[0] < 0.0 && header.problems.empty()) {
    std::error_code ignored;
    const std::uint64_t size = std::filesystem::file_size(array.file, ignored);
    const std::uint64_t bytes = array.shape[0] * array.row_size() * array.number_size();
    array.data_begin = !ignored && size > bytes ? size - bytes : 0;
  }
}

void read_meta_fields(int dimension, Header& header, StoredArray& array) {
  if (header.text("NDims") != std::to_string(dimension)) {
    header.refuse("NDims", std::to_string(dimension));
  }
  find_shape("DimSize", dimension, header, array);
  find_type("ElementType", meta_types, header, array);
  const auto is_on = [&](const std::string& key) {
    const std::string value = lower(header.text(key, "false"));
    return value == "true" || value == "1";
  };
  if (lower(header.text("BinaryData", "true")) == "false") header.refuse("BinaryData", "True");
  if (header.text("ElementNumberOfChannels", "1") != "1") {
    header.refuse("ElementNumberOfChannels", "1");
  }
  array.big_endian = is_on("BinaryDataByteOrderMSB") || is_on("ElementByteOrderMSB");
  const char* edges = header.fields.contains("ElementSpacing") ? "ElementSpacing" : "ElementSize";
  check_edges(edges, numbers(header.text(edges)), header);
  if (!header.fields.contains("ElementDataFile")) {
    header.refuse("ElementDataFile", "the name of the file of the numbers, or LOCAL");
    return;
  }
  find_numbers(header.text("ElementDataFile"), "HeaderSize", is_on("CompressedData"), header,
               array);
}

void read_nrrd_fields(int dimension, Header& header, StoredArray& array) {
  if (header.text("dimension") != std::to_string(dimension)) {
    header.refuse("dimension", std::to_string(dimension));
  }
  find_shape("sizes", dimension, header, array);
  find_type("type", nrrd_types, header, array);
  const std::string encoding = lower(header.text("encoding"));
  const bool compressed = encoding == "gzip" || encoding == "gz";
  if (!compressed && encoding != "raw") header.refuse("encoding", "raw or gzip. Write it so");
  array.big_endian = lower(header.text("endian", "little")) == "big";
  if (header.text("line skip", "0") != "0") header.refuse("line skip", "0");
  check_edges("spacings", numbers(header.text("spacings")), header);
  const std::vector<double> vectors = numbers(header.text("space directions"));
  std::vector<double> edges;
  for (std::size_t i = 0; i + 3 <= vectors.size(); i += 3) {
    edges.push_back(std::hypot(vectors[i], vectors[i + 1], vectors[i + 2]));
  }
  check_edges("space directions", edges, header);
  find_numbers(header.text("data file"), "byte skip", compressed, header, array);
}

}  // namespace

bool names_volume(const std::string& path) {
  return path.ends_with(".mhd") || path.ends_with(".mha") || path.ends_with(".nrrd") ||
         path.ends_with(".nhdr");
}

StoredArray read_volume_header(const std::string& path, int dimension) {
  const bool meta = path.ends_with(".mhd") || path.ends_with(".mha");
  Header header = meta ? read_meta(path) : read_nrrd(path);
  StoredArray array;
  if (header.problems.empty()) {
    meta ? read_meta_fields(dimension, header, array) : read_nrrd_fields(dimension, header, array);
  }
  std::string text;
  for (const std::string& problem : header.problems) {
    if (!text.empty()) text += ".\n";
    text.append("sample.image: ").append(path).append(": ").append(problem);
  }
  if (!text.empty()) throw InputError(text + ".");
  return array;
}

}  // namespace poreshock
