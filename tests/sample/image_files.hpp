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

/// A grey PNG of 8 or 16 bits that holds the values as they are.
inline std::string write_png(const std::string& name, int columns, int rows,
                             const std::vector<int>& values, int bits) {
  std::FILE* file = std::fopen(name.c_str(), "wb");
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
  png_infop info = png_create_info_struct(png);
  png_init_io(png, file);
  png_set_IHDR(png, info, static_cast<png_uint_32>(columns), static_cast<png_uint_32>(rows), bits,
               PNG_COLOR_TYPE_GRAY, PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT,
               PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  for (int r = 0; r < rows; ++r) {
    std::vector<png_byte> row;
    for (int c = 0; c < columns; ++c) {
      const int v = values[static_cast<std::size_t>(r * columns + c)];
      if (bits == 16) row.push_back(static_cast<png_byte>(v / 256));
      row.push_back(static_cast<png_byte>(v % 256));
    }
    png_write_row(png, row.data());
  }
  png_write_end(png, nullptr);
  png_destroy_write_struct(&png, &info);
  std::fclose(file);
  return name;
}

}  // namespace poreshock::testing
