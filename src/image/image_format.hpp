#pragma once
// What the readers of the image formats share: pgm_image.cpp, png_image.cpp, tiff_image.cpp.
// Private to the layer.

#include <cstdint>
#include <string>

#include "poreshock/image/image.hpp"

namespace poreshock {

inline constexpr std::int64_t most_image_pixels = std::int64_t{1} << 28;

/// Throws InputError with what was found and what is allowed.
[[noreturn]] void refuse_image(const std::string& path, const std::string& found);

/// Throws InputError unless there are pixels, and not too many.
void require_image_size(const std::string& path, std::int64_t columns, std::int64_t rows);

/// Value of a coloured pixel: its luminance with `grey`, else a label; that of a grey one as it is.
std::int64_t colour_value(std::int64_t red, std::int64_t green, std::int64_t blue, bool grey);

/// read_image for the bytes of a PNG file.
Image read_png(const std::string& path, const std::string& bytes, bool grey);

/// read_image for a TIFF file.
Image read_tiff(const std::string& path, bool grey);

/// read_image for the bytes of a PGM file.
Image read_pgm(const std::string& path, const std::string& bytes);

}  // namespace poreshock
