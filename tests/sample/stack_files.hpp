#pragma once
// Small stacks of voxels for the tests, in every kind of file.

#include <tiffio.h>
#include <zlib.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "image_files.hpp"

namespace poreshock::testing {

/// Whole numbers on a grid, x fastest.
struct Voxels {
  std::array<int, 3> size{};
  std::vector<int> value;

  std::vector<int> slice(int k) const {
    const std::ptrdiff_t count = std::ptrdiff_t{size[0]} * size[1];
    return {value.begin() + k * count, value.begin() + (k + 1) * count};
  }
};

/// How a TIFF file holds its pages.
struct TiffKind {
  int bits = 8;
  std::uint16_t compression = COMPRESSION_NONE;
  std::uint16_t format = SAMPLEFORMAT_UINT;
  std::uint16_t meaning = PHOTOMETRIC_MINISBLACK;
  int samples = 1;            ///< of a pixel; three are the value, twice and three times it
  int tile = 0;               ///< edge of tiles; 0 = strips
  std::string description{};  ///< empty = none
};

inline void set_tiff_fields(TIFF* tiff, int columns, int rows, const TiffKind& kind) {
  TIFFSetField(tiff, TIFFTAG_IMAGEWIDTH, columns);
  TIFFSetField(tiff, TIFFTAG_IMAGELENGTH, rows);
  TIFFSetField(tiff, TIFFTAG_BITSPERSAMPLE, kind.bits);
  TIFFSetField(tiff, TIFFTAG_SAMPLESPERPIXEL, kind.samples);
  TIFFSetField(tiff, TIFFTAG_SAMPLEFORMAT, kind.format);
  TIFFSetField(tiff, TIFFTAG_PHOTOMETRIC, kind.meaning);
  TIFFSetField(tiff, TIFFTAG_PLANARCONFIG, PLANARCONFIG_CONTIG);
  TIFFSetField(tiff, TIFFTAG_COMPRESSION, kind.compression);
  if (!kind.description.empty()) {
    TIFFSetField(tiff, TIFFTAG_IMAGEDESCRIPTION, kind.description.c_str());
  }
  if (kind.tile > 0) {
    TIFFSetField(tiff, TIFFTAG_TILEWIDTH, kind.tile);
    TIFFSetField(tiff, TIFFTAG_TILELENGTH, kind.tile);
  } else {
    TIFFSetField(tiff, TIFFTAG_ROWSPERSTRIP, 2);
  }
}

/// Bytes of a number, lowest first, or highest.
inline std::string number_bytes(int value, int bits, bool big_endian = false) {
  std::string bytes;
  for (int b = 0; b < bits; b += 8) bytes += static_cast<char>((value >> b) & 255);
  if (big_endian) bytes = {bytes.rbegin(), bytes.rend()};
  return bytes;
}

inline std::string all_bytes(const std::vector<int>& values, int bits, bool big_endian = false) {
  std::string bytes;
  for (const int v : values) bytes += number_bytes(v, bits, big_endian);
  return bytes;
}

/// One bit for each number, the first one highest.
inline std::string bit_bytes(const std::vector<int>& values) {
  std::string bytes((values.size() + 7) / 8, '\0');
  for (std::size_t i = 0; i < values.size(); ++i) {
    bytes[i / 8] = static_cast<char>(bytes[i / 8] | (values[i] & 1) << (7 - i % 8));
  }
  return bytes;
}

/// The bytes of floating-point numbers.
inline std::string float_bytes(const std::vector<int>& values) {
  std::string bytes;
  for (const int v : values) {
    const auto number = static_cast<float>(v);
    bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
  }
  return bytes;
}

/// Writes one page with the mode of TIFFOpen: "w" for a new file, "w8" BigTIFF, "a" one page more.
inline void write_page(const std::string& name, const char* mode, int columns, int rows,
                       const std::vector<int>& values, const TiffKind& kind) {
  TIFF* tiff = TIFFOpen(name.c_str(), mode);
  set_tiff_fields(tiff, columns, rows, kind);
  const bool fractions = kind.format == SAMPLEFORMAT_IEEEFP;
  const int edge = kind.tile > 0 ? kind.tile : columns;
  for (int top = 0; top<rows; top += kind.tile> 0 ? edge : 1) {
    for (int left = 0; left < columns; left += edge) {
      std::vector<int> part;
      for (int y = top; y < top + (kind.tile > 0 ? edge : 1); ++y) {
        for (int x = left; x < left + edge; ++x) {
          const bool inside = x < columns && y < rows;
          const int value = inside ? values[static_cast<std::size_t>(y * columns + x)] : 99;
          for (int k = 1; k <= kind.samples; ++k) part.push_back(k * value);
        }
      }
      std::string bytes = fractions        ? float_bytes(part)
                          : kind.bits == 1 ? bit_bytes(part)
                                           : all_bytes(part, kind.bits);
      kind.tile > 0 ? TIFFWriteTile(tiff, bytes.data(), static_cast<std::uint32_t>(left),
                                    static_cast<std::uint32_t>(top), 0, 0)
                    : TIFFWriteScanline(tiff, bytes.data(), static_cast<std::uint32_t>(top), 0);
    }
  }
  TIFFWriteDirectory(tiff);
  TIFFClose(tiff);
}

/// A TIFF file with a page for each slice.
inline std::string write_tiff(const std::string& name, const Voxels& voxels,
                              const TiffKind& kind = {}, bool big = false) {
  for (int k = 0; k < voxels.size[2]; ++k) {
    write_page(name, k > 0 ? "a" : (big ? "w8" : "w"), voxels.size[0], voxels.size[1],
               voxels.slice(k), kind);
  }
  return name;
}

/// A new folder with one file for each slice, numbered from `first` on.
inline std::string write_slices(const std::string& folder, const Voxels& voxels,
                                const std::string& ending, int first = 8, int bits = 8) {
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  for (int k = 0; k < voxels.size[2]; ++k) {
    const std::string name = folder + "/scan2_" + std::to_string(first + k) + ending;
    const int columns = voxels.size[0], rows = voxels.size[1];
    if (ending == ".png") write_png(name, columns, rows, voxels.slice(k), bits);
    if (ending == ".pgm") write_pgm(name, columns, rows, voxels.slice(k));
    if (ending == ".tif") write_page(name, "w", columns, rows, voxels.slice(k), {.bits = bits});
  }
  return folder;
}

/// "4 3 5"
inline std::string size_text(const Voxels& voxels) {
  return std::to_string(voxels.size[0]) + " " + std::to_string(voxels.size[1]) + " " +
         std::to_string(voxels.size[2]);
}

inline std::string meta_header(const Voxels& voxels, const std::string& type,
                               const std::string& more, const std::string& file) {
  return "ObjectType = Image\nNDims = 3\nElementSpacing = 0.5 0.5 0.5\n" + more +
         "DimSize = " + size_text(voxels) + "\nElementType = " + type +
         "\nElementDataFile = " + file + "\n";
}

inline std::string nrrd_header(const Voxels& voxels, const std::string& type,
                               const std::string& more, const std::string& encoding = "raw") {
  return "NRRD0004\n# a comment\ntype: " + type + "\ndimension: 3\nsizes: " + size_text(voxels) +
         "\nspace directions: (2,0,0) (0,2,0) (0,0,2)\nencoding: " + encoding + "\nkey:=value\n" +
         more + "\n";
}

/// The bytes as gzip writes them, or as a zlib stream.
inline std::string compressed(std::string bytes, bool gzip = true) {
  z_stream stream{};
  deflateInit2(&stream, Z_BEST_COMPRESSION, Z_DEFLATED, gzip ? 31 : 15, 8, Z_DEFAULT_STRATEGY);
  std::string result(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<Bytef*>(bytes.data());
  stream.avail_in = static_cast<uInt>(bytes.size());
  stream.next_out = reinterpret_cast<Bytef*>(result.data());
  stream.avail_out = static_cast<uInt>(result.size());
  deflate(&stream, Z_FINISH);
  result.resize(stream.total_out);
  deflateEnd(&stream);
  return result;
}

/// An array as numpy.save writes it, slowest axis first.
inline std::string npy_bytes(const Voxels& voxels, const std::string& type,
                             const std::string& numbers) {
  std::string header = "{'descr': '" + type + "', 'fortran_order': False, 'shape': (" +
                       std::to_string(voxels.size[2]) + ", " + std::to_string(voxels.size[1]) +
                       ", " + std::to_string(voxels.size[0]) + "), }";
  header.resize(117, ' ');
  header += '\n';
  return std::string("\x93NUMPY\x01\0", 8) + static_cast<char>(header.size()) + '\0' + header +
         numbers;
}

}  // namespace poreshock::testing
