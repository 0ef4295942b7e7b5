#include "image.hpp"

#include <png.h>

#include <array>
#include <cctype>
#include <cstring>
#include <fstream>
#include <iterator>

#include "poreshock/core/error.hpp"

namespace poreshock {
namespace {

constexpr std::int64_t most_pixels = std::int64_t{1} << 28;

[[noreturn]] void refuse(const std::string& path, const std::string& found) {
  throw InputError("sample.image: " + path + ": " + found +
                   ". Allowed is a PNG file, or a PGM file (P2 or P5), of at most 2^28 pixels.");
}

void require_size(const std::string& path, std::int64_t columns, std::int64_t rows) {
  if (columns > 0 && rows > 0 && columns <= most_pixels / rows) return;
  refuse(path,
         "has " + std::to_string(columns) + " x " + std::to_string(rows) + " pixels in its header");
}

std::string read_bytes(const std::string& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse(path, std::string("cannot be opened (") + std::strerror(errno) + ")");
  std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (file.bad() || bytes.empty()) refuse(path, "cannot be read, or is empty");
  return bytes;
}

/// Bytes still to be read, and the reason why reading stopped.
struct PngSource {
  const char* next;
  std::size_t left;
  std::array<char, 128> reason;
};

/// Rows of samples as decoded: red, green, blue, 16 bits each, high byte first.
struct PngRows {
  std::size_t columns = 0, rows = 0;
  int depth = 8;  ///< bits of a sample as stored in the file
  std::vector<unsigned char> bytes;
  std::vector<unsigned char*> row;
};

void take_bytes(png_structp png, png_bytep target, png_size_t count) {
  auto* source = static_cast<PngSource*>(png_get_io_ptr(png));
  if (count > source->left) png_error(png, "the file ends too early");
  std::memcpy(target, source->next, count);
  source->next += count;
  source->left -= count;
}

void keep_reason(png_structp png, png_const_charp text) {
  auto* source = static_cast<PngSource*>(png_get_error_ptr(png));
  std::strncpy(source->reason.data(), text, source->reason.size() - 1);
  png_longjmp(png, 1);
}

void ignore_warning(png_structp, png_const_charp) {}

void read_header(png_structp png, png_infop info, PngRows& rows) {
  png_read_info(png, info);
  rows.columns = png_get_image_width(png, info);
  rows.rows = png_get_image_height(png, info);
  rows.depth =
      png_get_color_type(png, info) == PNG_COLOR_TYPE_PALETTE ? 8 : png_get_bit_depth(png, info);
}

void read_rows(png_structp png, png_infop info, PngRows& rows) {
  // A palette becomes colours; grey of 1, 2 or 4 bits stays as stored, so that labels survive.
  if (png_get_color_type(png, info) == PNG_COLOR_TYPE_PALETTE) png_set_palette_to_rgb(png);
  png_set_packing(png);
  png_set_strip_alpha(png);
  png_set_gray_to_rgb(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  png_read_image(png, rows.row.data());
}

/// Calls step with libpng's error jump set; false when it jumped. Nothing on its stack needs a
/// destructor, as a jump passes over them.
template <class Step>
bool guarded(png_structp png, Step step) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  step();
  return true;
}

PngRows read_png(const std::string& path, const std::string& bytes) {
  PngSource source{bytes.data(), bytes.size(), {}};
  PngRows rows;
  png_structp png =
      png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, keep_reason, ignore_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  if (info == nullptr) refuse(path, "found no memory to read it");
  png_set_read_fn(png, &source, take_bytes);
  bool good = guarded(png, [&] { read_header(png, info, rows); });
  const bool fits = good && rows.columns * rows.rows <= static_cast<std::size_t>(most_pixels);
  if (fits) {
    const std::size_t width = rows.columns * 3 * (rows.depth == 16 ? 2 : 1);
    rows.bytes.resize(width * rows.rows);
    for (std::size_t r = 0; r < rows.rows; ++r) rows.row.push_back(rows.bytes.data() + r * width);
    good = guarded(png, [&] { read_rows(png, info, rows); });
  }
  png_destroy_read_struct(&png, &info, nullptr);
  if (!good) refuse(path, std::string("is a damaged PNG file: ") + source.reason.data());
  require_size(path, static_cast<std::int64_t>(rows.columns), static_cast<std::int64_t>(rows.rows));
  return rows;
}

std::int64_t value_of(const std::array<std::int64_t, 3>& c, bool grey) {
  if (c[0] == c[1] && c[1] == c[2]) return c[0];
  if (grey) return (299 * c[0] + 587 * c[1] + 114 * c[2]) / 1000;
  return (c[0] << 32) + (c[1] << 16) + c[2];
}

Image image_of(const PngRows& rows, bool grey) {
  Image image{static_cast<std::int64_t>(rows.columns), static_cast<std::int64_t>(rows.rows), {}};
  const std::size_t size = rows.depth == 16 ? 2 : 1;
  image.value.reserve(rows.columns * rows.rows);
  for (std::size_t at = 0; at < rows.bytes.size(); at += 3 * size) {
    std::array<std::int64_t, 3> colour{};
    for (std::size_t k = 0; k < 3; ++k) {
      for (std::size_t b = 0; b < size; ++b) {
        colour[k] = colour[k] * 256 + rows.bytes[at + k * size + b];
      }
    }
    image.value.push_back(value_of(colour, grey));
  }
  return image;
}

/// Next number of a PGM text, after white space and comments; -1 when there is none.
std::int64_t next_number(const std::string& text, std::size_t& at) {
  while (at < text.size() &&
         (std::isspace(static_cast<unsigned char>(text[at])) != 0 || text[at] == '#')) {
    if (text[at] == '#') at = std::min(text.find('\n', at), text.size());
    if (at < text.size()) ++at;
  }
  std::int64_t number = -1;
  while (at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0) {
    number = std::max(number, std::int64_t{0}) * 10 + (text[at++] - '0');
    if (number > most_pixels) return number;
  }
  return number;
}

Image read_pgm(const std::string& path, const std::string& text) {
  std::size_t at = 2;
  Image image;
  image.columns = next_number(text, at);
  image.rows = next_number(text, at);
  const std::int64_t most = next_number(text, at);
  require_size(path, image.columns, image.rows);
  if (most < 1 || most > 65535) {
    refuse(path, "has a greatest grey value of " + std::to_string(most) +
                     " in its PGM header, where 1 to 65535 is allowed");
  }
  const bool binary = text[1] == '5';
  const std::size_t size = most > 255 ? 2 : 1;
  if (binary) ++at;  // one white space ends the header
  const std::int64_t pixels = image.columns * image.rows;
  for (std::int64_t i = 0; i < pixels; ++i) {
    std::int64_t value = -1;
    if (!binary) {
      value = next_number(text, at);
    } else if (at + size <= text.size()) {
      value = 0;
      for (std::size_t b = 0; b < size; ++b) {
        value = value * 256 + static_cast<unsigned char>(text[at++]);
      }
    }
    if (value < 0 || value > most) {
      refuse(path, "has no grey value from 0 to " + std::to_string(most) + " at row " +
                       std::to_string(i / image.columns) + ", column " +
                       std::to_string(i % image.columns) + " (counted from 0)");
    }
    image.value.push_back(value);
  }
  return image;
}

}  // namespace

Image read_image(const std::string& path, bool grey) {
  const std::string bytes = read_bytes(path);
  const bool png =
      bytes.size() >= 8 && png_sig_cmp(reinterpret_cast<png_const_bytep>(bytes.data()), 0, 8) == 0;
  if (png) return image_of(read_png(path, bytes), grey);
  if (bytes.compare(0, 2, "P2") == 0 || bytes.compare(0, 2, "P5") == 0) {
    return read_pgm(path, bytes);
  }
  refuse(path, "is neither a PNG nor a PGM file");
}

}  // namespace poreshock
