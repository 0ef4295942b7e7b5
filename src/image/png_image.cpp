// PNG files as libpng reads them, without any change to the stored samples.

#include <png.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <limits>
#include <vector>

#include "image_format.hpp"

namespace poreshock {
namespace {

/// Bytes still to be read, and the reason why reading stopped.
struct PngSource {
  const char* next;
  std::size_t left;
  std::array<char, 128> reason;
};

/// Samples as stored: one byte each, or two, high byte first, with 16 bits.
struct PngRows {
  std::size_t columns = 0, rows = 0;
  std::size_t channels = 1;  ///< alpha included
  int depth = 8;             ///< bits of a sample in the file
  bool palette = false;
  int colours = 0;  ///< of the palette
  std::array<png_color, 256> colour{};
  std::array<png_byte, 256> opacity{};  ///< of the colours of the palette
  bool has_clear = false;               ///< one colour of the others is transparent
  png_color_16 clear{};
  std::vector<unsigned char> bytes;
  std::vector<unsigned char*> row;

  std::size_t sample_bytes() const { return depth == 16 ? 2 : 1; }
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
  // A damaged palette or transparency may not go by as a missing one.
  png_set_crc_action(png, PNG_CRC_ERROR_QUIT, PNG_CRC_ERROR_QUIT);
  png_read_info(png, info);
  rows.columns = png_get_image_width(png, info);
  rows.rows = png_get_image_height(png, info);
  rows.depth = png_get_bit_depth(png, info);
  rows.channels = png_get_channels(png, info);
  rows.palette = png_get_color_type(png, info) == PNG_COLOR_TYPE_PALETTE;
  rows.opacity.fill(255);
  png_colorp colours = nullptr;
  if (rows.palette && png_get_PLTE(png, info, &colours, &rows.colours) != 0) {
    std::copy_n(colours, rows.colours, rows.colour.begin());
  }
  png_bytep opacity = nullptr;
  png_color_16p clear = nullptr;
  int count = 0;
  if (png_get_tRNS(png, info, &opacity, &count, &clear) == 0) return;
  if (rows.palette) {
    std::copy_n(opacity, std::min(count, 256), rows.opacity.begin());
  } else {
    rows.has_clear = true;
    rows.clear = *clear;
  }
}

void read_rows(png_structp png, png_infop info, PngRows& rows) {
  png_set_packing(png);
  png_set_interlace_handling(png);
  png_read_update_info(png, info);
  png_read_image(png, rows.row.data());
  png_read_end(png, nullptr);
}

/// Calls step with libpng's error jump set; false when it jumped. Nothing on its stack needs a
/// destructor, as a jump passes over them.
template <class Step>
bool guarded(png_structp png, Step step) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  step();
  return true;
}

/// Whether a file of so many bytes can hold the rows: deflate makes data at most 1032 times
/// smaller, so a header alone takes no memory.
bool can_hold(const PngRows& rows, std::size_t file_bytes) {
  const double bits = static_cast<double>(rows.columns) * static_cast<double>(rows.rows) *
                      static_cast<double>(rows.channels) * rows.depth;
  return bits / 8.0 <= 1032.0 * static_cast<double>(file_bytes);
}

PngRows decode(const std::string& path, const std::string& bytes) {
  PngSource source{bytes.data(), bytes.size(), {}};
  PngRows rows;
  png_structp png =
      png_create_read_struct(PNG_LIBPNG_VER_STRING, &source, keep_reason, ignore_warning);
  png_infop info = png != nullptr ? png_create_info_struct(png) : nullptr;
  if (info == nullptr) refuse_image(path, "found no memory to read it");
  png_set_read_fn(png, &source, take_bytes);
  bool good = guarded(png, [&] { read_header(png, info, rows); });
  const bool fits = rows.columns * rows.rows <= static_cast<std::size_t>(most_image_pixels);
  const bool held = can_hold(rows, bytes.size());
  if (good && fits && held) {
    const std::size_t width = rows.columns * rows.channels * rows.sample_bytes();
    rows.bytes.resize(width * rows.rows);
    for (std::size_t r = 0; r < rows.rows; ++r) rows.row.push_back(rows.bytes.data() + r * width);
    good = guarded(png, [&] { read_rows(png, info, rows); });
  }
  png_destroy_read_struct(&png, &info, nullptr);
  if (!good) refuse_image(path, std::string("is a damaged PNG file: ") + source.reason.data());
  require_image_size(path, static_cast<std::int64_t>(rows.columns),
                     static_cast<std::int64_t>(rows.rows));
  if (!held) refuse_image(path, "is a damaged PNG file: it is too short for its size in pixels");
  return rows;
}

using Samples = std::array<std::int64_t, 4>;

Samples samples_at(const PngRows& rows, std::size_t pixel) {
  const std::size_t size = rows.sample_bytes();
  const unsigned char* from = rows.bytes.data() + pixel * rows.channels * size;
  Samples samples{};
  for (std::size_t k = 0; k < rows.channels; ++k) {
    for (std::size_t b = 0; b < size; ++b) samples[k] = samples[k] * 256 + *from++;
  }
  return samples;
}

bool is_transparent(const PngRows& rows, const Samples& s) {
  if (rows.palette) return rows.opacity[static_cast<std::size_t>(s[0])] < 128;
  if (rows.channels % 2 == 0) return s[rows.channels - 1] < (std::int64_t{1} << (rows.depth - 1));
  if (!rows.has_clear) return false;
  if (rows.channels == 1) return s[0] == rows.clear.gray;
  return s[0] == rows.clear.red && s[1] == rows.clear.green && s[2] == rows.clear.blue;
}

double value_at(const PngRows& rows, const Samples& s, bool grey) {
  if (is_transparent(rows, s)) return std::numeric_limits<double>::quiet_NaN();
  if (rows.palette && grey) {
    const png_color& colour = rows.colour[static_cast<std::size_t>(s[0])];
    return static_cast<double>(colour_value(colour.red, colour.green, colour.blue, true));
  }
  return static_cast<double>(rows.channels < 3 ? s[0] : colour_value(s[0], s[1], s[2], grey));
}

}  // namespace

Image read_png(const std::string& path, const std::string& bytes, bool grey) {
  const PngRows rows = decode(path, bytes);
  Image image{static_cast<std::int64_t>(rows.columns),
              static_cast<std::int64_t>(rows.rows),
              rows.depth,
              {}};
  image.value.reserve(rows.columns * rows.rows);
  for (std::size_t pixel = 0; pixel < rows.columns * rows.rows; ++pixel) {
    const Samples samples = samples_at(rows, pixel);
    if (rows.palette && samples[0] >= rows.colours) {
      refuse_image(path, "is a damaged PNG file: a pixel has the colour " +
                             std::to_string(samples[0]) + " of a palette of " +
                             std::to_string(rows.colours));
    }
    image.value.push_back(value_at(rows, samples, grey));
  }
  return image;
}

}  // namespace poreshock
