#include "poreshock/files/array_file.hpp"

#include <fcntl.h>

#include <algorithm>
#include <bit>
#include <charconv>
#include <cstring>
#include <filesystem>
#include <optional>

#include "poreshock/core/rank_zero.hpp"
#include "poreshock/files/hdf5_file.hpp"
#include "poreshock/files/posix_file.hpp"

namespace poreshock {

namespace {

static_assert(std::endian::native == std::endian::little, "numbers are read as they are stored");

[[noreturn]] void refuse_header(const std::string& file, const std::string& found) {
  throw InputError(file + ": its header is damaged, it has " + found +
                   "; write it again with numpy.save(name, array)");
}

/// Value of a key of a .npy header, which is the text of a Python dictionary; a list in brackets as
/// a whole. Nothing when it is not there.
std::optional<std::string> header_value(const std::string& header, const std::string& key) {
  const std::size_t at = header.find("'" + key + "':");
  if (at == std::string::npos) return std::nullopt;
  const std::size_t begin = header.find_first_not_of(' ', at + key.size() + 3);
  if (begin == std::string::npos) return std::nullopt;
  const bool list = header[begin] == '(';
  const std::size_t end = list ? header.find(')', begin) : header.find_first_of(",}", begin);
  if (end == std::string::npos) return std::nullopt;
  return header.substr(begin, end + (list ? 1 : 0) - begin);
}

/// Extents in a text such as "(3, 4)" or "(5,)"; nothing when it is another one.
std::optional<std::vector<std::uint64_t>> extents(const std::string& text) {
  std::vector<std::uint64_t> shape;
  const char* at = text.data() + 1;
  const char* const end = text.data() + text.size() - 1;
  if (text.size() < 2 || text.front() != '(' || text.back() != ')') return std::nullopt;
  while (at != end) {
    std::uint64_t extent = 0;
    const auto read = std::from_chars(at, end, extent);
    if (read.ec != std::errc{}) return std::nullopt;
    shape.push_back(extent);
    at = read.ptr;
    if (at != end && *at != ',') return std::nullopt;
    while (at != end && (*at == ',' || *at == ' ')) ++at;
  }
  return shape;
}

/// Whole rows that a file of so many bytes has, at most those asked for; products may leave 64
/// bits.
std::uint64_t whole_rows(const StoredArray& array, std::uint64_t file_bytes) {
  const std::uint64_t rows = array.shape.empty() ? 1 : array.shape[0];
  if (file_bytes < array.data_begin) return 0;
  std::uint64_t room = (file_bytes - array.data_begin) / array.number_size();
  for (std::size_t axis = 1; axis < array.shape.size(); ++axis) {
    if (array.shape[axis] == 0) return rows;
    room /= array.shape[axis];
  }
  return std::min(room, rows);
}

/// "it ends in slice 7 of 9"; empty when nothing is missing.
std::string early_end(const StoredArray& array, std::uint64_t file_bytes, const std::string& row) {
  const std::uint64_t rows = array.shape.empty() ? 1 : array.shape[0];
  const std::uint64_t whole = whole_rows(array, file_bytes);
  if (whole == rows) return "";
  return "it ends in " + row + " " + std::to_string(whole + 1) + " of " + std::to_string(rows);
}

/// Text of the header of NumPy format 1.0 to 3.0: magic, version, length of the header, header.
std::string read_header_text(const FileDescriptor& file, StoredArray& array) {
  unsigned char start[12] = {};
  if (file.size() >= 12) file.read(0, reinterpret_cast<std::byte*>(start), 12);
  if (std::memcmp(start, "\x93NUMPY", 6) != 0) throw InputError(array.file + ": not a .npy file");
  if (start[6] < 1 || start[6] > 3) {
    refuse_header(array.file, "the version " + std::to_string(start[6]) + ", allowed are 1 to 3");
  }
  const bool old = start[6] == 1;
  std::uint64_t length = start[8] | (std::uint64_t{start[9]} << 8);
  if (!old) length |= (std::uint64_t{start[10]} << 16) | (std::uint64_t{start[11]} << 24);
  array.data_begin = (old ? 10 : 12) + length;
  if (array.data_begin > file.size()) throw InputError(array.file + ": truncated");
  std::string header(length, ' ');
  file.read(old ? 10 : 12, reinterpret_cast<std::byte*>(header.data()), length);
  return header;
}

void read_npy_header(const std::string& row, StoredArray& array) {
  if (!std::filesystem::is_regular_file(array.file)) throw InputError(array.file + ": not found");
  const FileDescriptor file(array.file, O_RDONLY);
  const std::string header = read_header_text(file, array);
  const auto type = header_value(header, "descr");
  const auto columns_first = header_value(header, "fortran_order");
  const auto shape = header_value(header, "shape");
  if (!type) refuse_header(array.file, "no type of the numbers ('descr')");
  if (!columns_first) refuse_header(array.file, "no order of the numbers ('fortran_order')");
  if (!shape) refuse_header(array.file, "no extents ('shape')");
  const std::string kinds[] = {"f8", "f4", "i8", "i4", "i2", "i1", "u8", "u4", "u2", "u1", "b1"};
  for (const std::string& kind : kinds) {
    if (*type == "'<" + kind + "'" || *type == "'|" + kind + "'") array.number = kind;
  }
  if (array.number.empty() || *columns_first != "False") {
    throw InputError(array.file + ": found numbers of type " + *type +
                     (*columns_first == "False" ? "" : ", columns first") +
                     "; allowed are little-endian f4, f8, i1 ... i8, u1 ... u8 and b1, rows first: "
                     "numpy.save(name, numpy.ascontiguousarray(array, dtype=\"f8\"))");
  }
  array.single_precision = array.number == "f4";
  const auto found = extents(*shape);
  if (!found) refuse_header(array.file, "the extents " + *shape + ", allowed are some like (3, 4)");
  array.shape = *found;
  const std::string end = early_end(array, file.size(), row);
  if (end.empty()) return;
  throw InputError(array.file + ": truncated, it is shorter than its header says: " + end);
}

/// Turns the bytes of every number around.
void swap_bytes(std::uint64_t width, std::vector<std::byte>& bytes) {
  for (auto number = bytes.begin(); number != bytes.end();) {
    const auto next = number + static_cast<std::ptrdiff_t>(width);
    std::reverse(number, next);
    number = next;
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

std::vector<double> read_plain_rows(const StoredArray& array, std::uint64_t first,
                                    std::uint64_t count) {
  std::vector<double> values(count * array.row_size());
  const std::uint64_t width = array.number_size();
  std::vector<std::byte> bytes(values.size() * width);
  const std::uint64_t begin = array.data_begin + first * array.row_size() * width;
  if (!array.inflated) {
    FileDescriptor(array.file, O_RDONLY).read(begin, bytes.data(), bytes.size());
  } else if (array.inflated->read(begin, bytes.data(), bytes.size()) < bytes.size()) {
    throw InputError(array.file + ": changed while it was read, its numbers end too early");
  }
  if (array.big_endian) swap_bytes(width, bytes);
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

StoredArray find_array(const std::string& name, MPI_Comm communicator, const std::string& row) {
  StoredArray array;
  const std::size_t colon = name.rfind(":/");
  array.file = name.substr(0, colon);
  if (colon != std::string::npos) {
    array.dataset = name.substr(colon + 1);
    Hdf5File file = Hdf5File::open(array.file, communicator);
    const DatasetInfo info = file.dataset(array.dataset);
    if (!info.numbers) {
      throw InputError(name + ": allowed are floating-point numbers of 32 and 64 bits, whole " +
                       "numbers and flags");
    }
    array.single_precision = info.type == NumberType::float32;
    array.shape = info.shape;
    array.unit = info.unit.empty() ? "1" : info.unit;
    return array;
  }
  // Every rank reads the header, which is short, after rank 0 has found nothing wrong with it.
  on_rank_zero(communicator, [&] {
    StoredArray trial = array;
    read_npy_header(row, trial);
  });
  agree(attempt([&] { read_npy_header(row, array); }), communicator);
  return array;
}

void require_numbers(const StoredArray& array, const std::string& row) {
  std::error_code error;
  if (!std::filesystem::is_regular_file(array.file, error)) {
    throw InputError(array.file + ": not found, or not a file");
  }
  const std::uint64_t wanted =
      array.data_begin + array.shape.at(0) * array.row_size() * array.number_size();
  const std::uint64_t found =
      array.inflated ? array.inflated->size(wanted + 1) : std::filesystem::file_size(array.file);
  const std::string end = early_end(array, found, row);
  std::string extents;
  for (const std::uint64_t n : array.shape) {
    extents += (extents.empty() ? "" : " x ") + std::to_string(n);
  }
  const std::string allowed = "Allowed are the bytes of " + extents + " numbers of " +
                              std::to_string(array.number_size()) + " bytes after byte " +
                              std::to_string(array.data_begin) + ".";
  const std::string damage = array.inflated ? array.inflated->damage() : "";
  const std::string has = array.file + ": has " + std::to_string(found) + " bytes, ";
  if (!end.empty()) {
    throw InputError(has + end + (damage.empty() ? "" : " (" + damage + ")") + ". " + allowed);
  }
  if (!damage.empty()) throw InputError(has + damage + ".");
  if (found == wanted) return;
  const std::string more = array.inflated ? "" : std::to_string(found - wanted) + " ";
  throw InputError(has + more + "more than its numbers need. " + allowed +
                   " Its size, type or beginning is another one.");
}

std::vector<double> read_rows(const StoredArray& array, std::uint64_t first, std::uint64_t count,
                              MPI_Comm communicator) {
  std::vector<double> values;
  if (array.dataset.empty()) {
    agree(attempt([&] { values = read_plain_rows(array, first, count); }), communicator);
    return values;
  }
  values.resize(count * array.row_size());
  Hdf5File file = Hdf5File::open(array.file, communicator);
  file.read<double>(array.dataset, first, values);
  return values;
}

}  // namespace poreshock
