#pragma once
// Grey values and labels of PNG, PGM and TIFF files.

#include <cstdint>
#include <string>
#include <vector>

namespace poreshock {

/// Values of an image, top row first as in the file.
struct Image {
  std::int64_t columns = 0, rows = 0;
  int depth = 8;              ///< bits of a sample in the file
  std::vector<double> value;  ///< not a number where the image is transparent
};

/// Reads a PNG file (grey, palette or colour, up to 16 bits), a PGM file (P2, P5) or a TIFF file of
/// one page (one sample per pixel: whole numbers of 1, 8, 16 or 32 bits, floating-point of 32; or
/// three of 8 or 16 bits, red, green and blue). A grey pixel has its grey value as stored; one of a
/// palette its number there, a coloured one red x 2^32 + green x 2^16 + blue as a label; with
/// `grey` both have their luminance (0.299 R + 0.587 G + 0.114 B, rounded down). A pixel less than
/// half opaque is transparent. Throws InputError that names the file, what was found and what is
/// allowed. Not collective.
Image read_image(const std::string& path, bool grey);

}  // namespace poreshock
