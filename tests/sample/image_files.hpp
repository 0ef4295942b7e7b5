#pragma once
// Small image files for the tests, in the working directory.

#include <png.h>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

namespace poreshock::testing {

inline std::string write_bytes(const std::string& name, const std::string& bytes) {
  std::ofstream(name, std::ios::binary) << bytes;
  return name;
}

inline std::string read_bytes(const std::string& name) {
  std::ifstream file(name, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline std::string pgm_header(const char* magic, int columns, int rows) {
  return std::string(magic) + "\n# a comment\n" + std::to_string(columns) + " " +
         std::to_string(rows) + "\n255\n";
}

inline std::string write_pgm(const std::string& name, int columns, int rows,
                             const std::vector<int>& values) {
  std::string bytes = pgm_header("P5", columns, rows);
  for (const int v : values) bytes += static_cast<char>(v);
  return write_bytes(name, bytes);
}

inline std::string write_text_pgm(const std::string& name, int columns, int rows,
                                  const std::vector<int>& values) {
  std::string text = pgm_header("P2", columns, rows);
  for (const int v : values) text += std::to_string(v) + " ";
  return write_bytes(name, text);
}

/// What a PNG file holds besides its samples.
struct PngKind {
  int bits = 8;
  int colour_type = PNG_COLOR_TYPE_GRAY;
  std::vector<png_color> palette{};
  std::vector<png_byte> opacity{};  ///< of the colours of the palette
  const png_color_16* clear = nullptr;
  bool interlaced = false;
};

inline int channels_of(const PngKind& kind) {
  const bool coloured = (kind.colour_type & PNG_COLOR_MASK_COLOR) != 0 && kind.palette.empty();
  return (coloured ? 3 : 1) + ((kind.colour_type & PNG_COLOR_MASK_ALPHA) != 0 ? 1 : 0);
}

/// Bytes of one row of samples, packed as the kind asks for.
inline std::vector<png_byte> packed_row(const std::vector<int>& samples, std::size_t first,
                                        std::size_t count, int bits) {
  std::vector<png_byte> row;
  int filled = 0;
  for (std::size_t i = first; i < first + count; ++i) {
    if (bits == 16) row.push_back(static_cast<png_byte>(samples[i] / 256));
    if (filled % 8 == 0) row.push_back(0);
    const int shift = bits < 8 ? 8 - bits - filled % 8 : 0;
    row.back() = static_cast<png_byte>(row.back() | ((samples[i] % 256) << shift));
    filled += bits < 8 ? bits : 8;
  }
  return row;
}

/// A PNG that holds the samples as they are, channel after channel of each pixel.
inline std::string write_png(const std::string& name, int columns, int rows,
                             const std::vector<int>& samples, const PngKind& kind) {
  std::FILE* file = std::fopen(name.c_str(), "wb");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_set_check_for_invalid_index(png, 0);  // a test may want one
  png_set_IHDR(png, info, static_cast<png_uint_32>(columns), static_cast<png_uint_32>(rows),
               kind.bits, kind.colour_type,
               kind.interlaced ? PNG_INTERLACE_ADAM7 : PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  if (!kind.palette.empty()) {
    png_set_PLTE(png, info, kind.palette.data(), static_cast<int>(kind.palette.size()));
  }
  if (!kind.opacity.empty() || kind.clear != nullptr) {
    png_set_tRNS(png, info, kind.opacity.data(), static_cast<int>(kind.opacity.size()), kind.clear);
  }
  png_write_info(png, info);
  const auto width = static_cast<std::size_t>(columns * channels_of(kind));
  std::vector<std::vector<png_byte>> packed;
  std::vector<png_bytep> row;
  for (std::size_t r = 0; r < static_cast<std::size_t>(rows); ++r) {
    packed.push_back(packed_row(samples, r * width, width, kind.bits));
  }
  for (std::vector<png_byte>& one : packed) row.push_back(one.data());
  png_write_image(png, row.data());
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
  return name;
}

/// A grey PNG of some bits.
inline std::string write_png(const std::string& name, int columns, int rows,
                             const std::vector<int>& values, int bits) {
  return write_png(name, columns, rows, values, PngKind{.bits = bits});
}

}  // namespace poreshock::testing
