#include "poreshock/output/array_file.hpp"

#include <fcntl.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <filesystem>

#include "poreshock/output/hdf5_file.hpp"
#include "poreshock/output/posix_file.hpp"
#include "poreshock/output/rank_zero.hpp"

namespace poreshock {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are read as they are stored");

/// Value of a key of a .npy header, which is the text of a Python dictionary.
std::string header_value(const std::string& header, const std::string& key) {
  const std::size_t at = header.find("'" + key + "':");
  if (at == std::string::npos) return "";
  const std::size_t begin = header.find_first_not_of(' ', at + key.size() + 3);
  const char close = header[begin] == '(' ? ')' : ',';
  return header.substr(begin, header.find(close, begin) - begin);
}

/// Extents in a text such as "(3, 4, ".
std::vector<std::uint64_t> extents(const std::string& text) {
  std::vector<std::uint64_t> shape;
  for (std::size_t i = 0; i < text.size(); ++i) {
    if (text[i] < '0' || text[i] > '9') continue;
    std::size_t used = 0;
    shape.push_back(std::stoull(text.substr(i), &used));
    i += used;
  }
  return shape;
}

/// NumPy format 1.0 to 3.0: magic, version, length of the header, header, numbers.
void read_npy_header(StoredArray& array) {
  if (!std::filesystem::is_regular_file(array.file)) throw InputError(array.file + ": not found");
  const FileDescriptor file(array.file, O_RDONLY);
  unsigned char start[12] = {};
  if (file.size() >= 12) file.read(0, reinterpret_cast<std::byte*>(start), 12);
  if (std::memcmp(start, "\x93NUMPY", 6) != 0) throw InputError(array.file + ": not a .npy file");
  const bool old = start[6] == 1;
  std::uint64_t length = start[8] | (std::uint64_t{start[9]} << 8);
  if (!old) length |= (std::uint64_t{start[10]} << 16) | (std::uint64_t{start[11]} << 24);
  array.data_begin = (old ? 10 : 12) + length;
  if (array.data_begin > file.size()) throw InputError(array.file + ": truncated");
  std::string header(length, ' ');
  file.read(old ? 10 : 12, reinterpret_cast<std::byte*>(header.data()), length);
  const std::string type = header_value(header, "descr");
  const std::string kinds[] = {"f8", "f4", "i8", "i4", "i2", "i1", "u8", "u4", "u2", "u1", "b1"};
  for (const std::string& kind : kinds) {
    if (type == "'<" + kind + "'" || type == "'|" + kind + "'") array.number = kind;
  }
  if (array.number.empty() || header_value(header, "fortran_order") != "False") {
    throw InputError(array.file + ": found numbers of type " + type +
                     (header_value(header, "fortran_order") == "False" ? "" : ", columns first") +
                     "; allowed are little-endian f4, f8, i1 ... i8, u1 ... u8 and b1, rows first: "
                     "numpy.save(name, numpy.ascontiguousarray(array, dtype=\"f8\"))");
  }
  array.single_precision = array.number == "f4";
  array.shape = extents(header_value(header, "shape"));
  const std::uint64_t rows = array.shape.empty() ? 0 : array.shape[0];
  const std::uint64_t bytes = static_cast<std::uint64_t>(array.number[1] - '0');
  if (file.size() < array.data_begin + rows * array.row_size() * bytes) {
    throw InputError(array.file + ": truncated, it is shorter than its header says");
  }
}

template <class T>
void convert(const std::vector<std::byte>& bytes, std::vector<double>& values) {
  for (std::size_t i = 0; i < values.size(); ++i) {
    T value{};
    std::memcpy(&value, &bytes[i * sizeof(T)], sizeof(T));
    values[i] = static_cast<double>(value);
  }
}

std::vector<double> read_npy_rows(const StoredArray& array, std::uint64_t first,
                                  std::uint64_t count) {
  std::vector<double> values(count * array.row_size());
  const auto width = static_cast<std::uint64_t>(array.number[1] - '0');
  std::vector<std::byte> bytes(values.size() * width);
  const FileDescriptor file(array.file, O_RDONLY);
  file.read(array.data_begin + first * array.row_size() * width, bytes.data(), bytes.size());
  const std::string& n = array.number;
  if (n == "f8") convert<double>(bytes, values);
  if (n == "f4") convert<float>(bytes, values);
  if (n == "i8") convert<std::int64_t>(bytes, values);
  if (n == "i4") convert<std::int32_t>(bytes, values);
  if (n == "i2") convert<std::int16_t>(bytes, values);
  if (n == "i1") convert<std::int8_t>(bytes, values);
  if (n == "u8") convert<std::uint64_t>(bytes, values);
  if (n == "u4") convert<std::uint32_t>(bytes, values);
  if (n == "u2") convert<std::uint16_t>(bytes, values);
  if (n == "u1" || n == "b1") convert<std::uint8_t>(bytes, values);
  return values;
}

}  // namespace

bool names_array(const std::string& name) {
  return name.ends_with(".npy") || name.find(":/") != std::string::npos;
}

StoredArray find_array(const std::string& name, MPI_Comm communicator) {
  StoredArray array;
  const std::size_t colon = name.rfind(":/");
  array.file = name.substr(0, colon);
  if (colon != std::string::npos) {
    array.dataset = name.substr(colon + 1);
    Hdf5File file = Hdf5File::open(array.file, communicator);
    const DatasetInfo info = file.dataset(array.dataset);
    if (!info.type) {
      throw InputError(name +
                       ": allowed are numbers of type float64, float32, int64, int32 and "
                       "uint8 (flags as uint8)");
    }
    array.single_precision = info.type == NumberType::float32;
    array.shape = info.shape;
    array.unit = info.unit.empty() ? "1" : info.unit;
    return array;
  }
  // Every rank reads the header, which is short, after rank 0 has found nothing wrong with it.
  on_rank_zero(communicator, [&] {
    StoredArray trial = array;
    read_npy_header(trial);
  });
  agree(attempt([&] { read_npy_header(array); }), communicator);
  return array;
}

std::vector<double> read_rows(const StoredArray& array, std::uint64_t first, std::uint64_t count,
                              MPI_Comm communicator) {
  std::vector<double> values;
  if (array.dataset.empty()) {
    agree(attempt([&] { values = read_npy_rows(array, first, count); }), communicator);
    return values;
  }
  values.resize(count * array.row_size());
  Hdf5File file = Hdf5File::open(array.file, communicator);
  file.read<double>(array.dataset, first, values);
  return values;
}

}  // namespace poreshock
