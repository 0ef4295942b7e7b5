// TIFF files as libtiff reads them: grey, palette or colour, in strips or tiles, however
// compressed.

#include <tiffio.h>

#include <algorithm>
#include <array>
#include <cstdarg>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <vector>

#include "image_format.hpp"
#include "tiff_file.hpp"

namespace poreshock {
namespace {

/// What a page says of itself.
struct Page {
  std::uint32_t columns = 0, rows = 0;
  std::uint16_t bits = 1, samples = 1, format = SAMPLEFORMAT_UINT, meaning = PHOTOMETRIC_MINISBLACK;
  std::uint16_t planes = PLANARCONFIG_CONTIG;
  bool grey = false;  ///< colours are wanted as luminances

  bool in_colour() const { return meaning == PHOTOMETRIC_RGB; }
};

int keep_reason(TIFF*, void* reason, const char*, const char* format, va_list arguments) {
  char text[256];
  std::vsnprintf(text, sizeof text, format, arguments);
  *static_cast<std::string*>(reason) = text;
  return 1;
}

int ignore_warning(TIFF*, void*, const char*, const char*, va_list) {
  return 1;
}

Page describe(TIFF* handle) {
  Page page;
  TIFFGetField(handle, TIFFTAG_IMAGEWIDTH, &page.columns);
  TIFFGetField(handle, TIFFTAG_IMAGELENGTH, &page.rows);
  TIFFGetFieldDefaulted(handle, TIFFTAG_BITSPERSAMPLE, &page.bits);
  TIFFGetFieldDefaulted(handle, TIFFTAG_SAMPLESPERPIXEL, &page.samples);
  TIFFGetFieldDefaulted(handle, TIFFTAG_SAMPLEFORMAT, &page.format);
  TIFFGetFieldDefaulted(handle, TIFFTAG_PLANARCONFIG, &page.planes);
  TIFFGetField(handle, TIFFTAG_PHOTOMETRIC, &page.meaning);
  return page;
}

bool is_allowed(const Page& page) {
  if (page.in_colour()) {
    return page.samples == 3 && page.planes == PLANARCONFIG_CONTIG &&
           page.format == SAMPLEFORMAT_UINT && (page.bits == 8 || page.bits == 16);
  }
  const bool mask = page.bits == 1 && page.format == SAMPLEFORMAT_UINT;
  const bool whole = page.format == SAMPLEFORMAT_UINT || page.format == SAMPLEFORMAT_INT;
  const bool number = (whole && (page.bits == 8 || page.bits == 16 || page.bits == 32)) ||
                      (page.format == SAMPLEFORMAT_IEEEFP && page.bits == 32);
  const bool grey = page.meaning == PHOTOMETRIC_MINISBLACK ||
                    page.meaning == PHOTOMETRIC_MINISWHITE || page.meaning == PHOTOMETRIC_PALETTE;
  return page.samples == 1 && (number || mask) && grey;
}

template <class T>
double number_at(const unsigned char* bytes, std::size_t i) {
  T value{};
  std::memcpy(&value, bytes + i * sizeof(T), sizeof(T));
  return static_cast<double>(value);
}

double sample_at(const Page& page, const unsigned char* bytes, std::size_t i) {
  const bool with_sign = page.format == SAMPLEFORMAT_INT;
  if (page.format == SAMPLEFORMAT_IEEEFP) return number_at<float>(bytes, i);
  switch (page.bits) {
    case 1:  // the first pixel is the highest bit
      return (bytes[i / 8] >> (7 - i % 8)) & 1;
    case 8:
      return with_sign ? number_at<std::int8_t>(bytes, i) : number_at<std::uint8_t>(bytes, i);
    case 16:
      return with_sign ? number_at<std::int16_t>(bytes, i) : number_at<std::uint16_t>(bytes, i);
    default:
      return with_sign ? number_at<std::int32_t>(bytes, i) : number_at<std::uint32_t>(bytes, i);
  }
}

double pixel_at(const Page& page, const unsigned char* bytes, std::size_t i) {
  if (!page.in_colour()) return sample_at(page, bytes, i);
  std::array<std::int64_t, 3> colour{};
  for (std::size_t k = 0; k < 3; ++k) {
    colour[k] = static_cast<std::int64_t>(sample_at(page, bytes, 3 * i + k));
  }
  return static_cast<double>(colour_value(colour[0], colour[1], colour[2], page.grey));
}

bool read_strips(TIFF* handle, const Page& page, Image& image) {
  std::vector<unsigned char> row(static_cast<std::size_t>(TIFFScanlineSize64(handle)));
  for (std::uint32_t y = 0; y < page.rows; ++y) {
    if (TIFFReadScanline(handle, row.data(), y, 0) < 0) return false;
    for (std::size_t x = 0; x < page.columns; ++x) {
      image.value[static_cast<std::size_t>(y) * page.columns + x] = pixel_at(page, row.data(), x);
    }
  }
  return true;
}

bool read_tiles(TIFF* handle, const Page& page, Image& image) {
  std::uint32_t width = 0, height = 0;
  TIFFGetField(handle, TIFFTAG_TILEWIDTH, &width);
  TIFFGetField(handle, TIFFTAG_TILELENGTH, &height);
  const std::uint64_t pixels = std::uint64_t{width} * height;
  if (pixels == 0 || pixels > most_image_pixels) return false;
  std::vector<unsigned char> tile(static_cast<std::size_t>(TIFFTileSize64(handle)));
  if (tile.size() < pixels * page.samples * page.bits / 8) return false;
  for (std::uint32_t top = 0; top < page.rows; top += height) {
    for (std::uint32_t left = 0; left < page.columns; left += width) {
      if (TIFFReadTile(handle, tile.data(), left, top, 0, 0) < 0) return false;
      const std::uint32_t rows = std::min(height, page.rows - top);
      const std::uint32_t columns = std::min(width, page.columns - left);
      for (std::size_t y = 0; y < rows; ++y) {
        for (std::size_t x = 0; x < columns; ++x) {
          image.value[(top + y) * page.columns + left + x] =
              pixel_at(page, tile.data(), y * width + x);
        }
      }
    }
  }
  return true;
}

/// Makes stored numbers luminances where they are not.
void find_luminance(TIFF* handle, const Page& page, Image& image) {
  if (page.format != SAMPLEFORMAT_UINT) return;
  if (page.meaning == PHOTOMETRIC_MINISWHITE) {
    const double most = static_cast<double>((std::uint64_t{1} << page.bits) - 1);
    for (double& value : image.value) value = most - value;
  }
  std::uint16_t *red = nullptr, *green = nullptr, *blue = nullptr;
  if (page.meaning != PHOTOMETRIC_PALETTE || page.bits > 16 ||
      TIFFGetField(handle, TIFFTAG_COLORMAP, &red, &green, &blue) == 0) {
    return;
  }
  for (double& value : image.value) {
    const auto i = static_cast<std::size_t>(value);
    value = static_cast<double>(colour_value(red[i] >> 8, green[i] >> 8, blue[i] >> 8, page.grey));
  }
}

/// Programs that write one page for a whole stack say so in its description only.
bool hides_slices(TIFF* handle) {
  char* text = nullptr;
  if (TIFFGetField(handle, TIFFTAG_IMAGEDESCRIPTION, &text) == 0 || text == nullptr) return false;
  const char* images = std::strstr(text, "images=");
  return std::strncmp(text, "ImageJ=", 7) == 0 && images != nullptr &&
         std::strtol(images + 7, nullptr, 10) > 1;
}

}  // namespace

TiffFile::TiffFile(const std::string& path)
    : path_(path), reason_(std::make_unique<std::string>()) {
  std::error_code ignored;
  if (!std::filesystem::is_regular_file(path, ignored)) refuse("cannot be opened, it is no file");
  TIFFOpenOptions* options = TIFFOpenOptionsAlloc();
  TIFFOpenOptionsSetErrorHandlerExtR(options, keep_reason, reason_.get());
  TIFFOpenOptionsSetWarningHandlerExtR(options, ignore_warning, nullptr);
  TIFFOpenOptionsSetMaxSingleMemAlloc(options, tmsize_t{1} << 32);
  handle_ = TIFFOpenExt(path.c_str(), "r", options);
  TIFFOpenOptionsFree(options);
  if (handle_ == nullptr) refuse("is a damaged TIFF file: " + *reason_);
}

TiffFile::~TiffFile() {
  TIFFClose(handle_);
}

void TiffFile::refuse(const std::string& found) const {
  refuse_image(path_, found);
}

std::int64_t TiffFile::pages() {
  reason_->clear();
  const std::int64_t pages = TIFFNumberOfDirectories(handle_);
  if (!reason_->empty()) {
    refuse("is a damaged TIFF file: page " + std::to_string(pages + 1) +
           " cannot be found: " + *reason_);
  }
  if (pages == 1 && hides_slices(handle_)) {
    refuse("holds one page and says that it is a stack of ImageJ; save it as an image sequence");
  }
  return pages;
}

Image TiffFile::read(std::int64_t page, bool grey) {
  const std::string name = "is a damaged TIFF file: page " + std::to_string(page + 1) + ": ";
  reason_->clear();
  const auto number = static_cast<tdir_t>(page);
  if (TIFFCurrentDirectory(handle_) != number && TIFFSetDirectory(handle_, number) == 0) {
    refuse(name + *reason_);
  }
  Page found = describe(handle_);
  found.grey = grey;
  require_image_size(path_, found.columns, found.rows);
  if (!is_allowed(found)) {
    refuse(
        "has " + std::to_string(found.samples) + " samples of " + std::to_string(found.bits) +
        " bits per pixel in page " + std::to_string(page + 1) +
        "; allowed in TIFF is one, of 1, 8, 16 or 32 bits, grey or of a palette, or three of 8 or "
        "16 bits, red, green and blue of each pixel together");
  }
  // No way to compress makes data more than some thousand times smaller: a header alone takes no
  // memory.
  const double bytes =
      static_cast<double>(found.columns) * found.rows * found.samples * found.bits / 8.0;
  if (bytes > 4096.0 * static_cast<double>(std::filesystem::file_size(path_))) {
    refuse(name + "the file is too short for its size in pixels");
  }
  Image image{found.columns, found.rows, found.bits, {}};
  image.value.resize(std::size_t{found.columns} * found.rows);
  const bool good = TIFFIsTiled(handle_) != 0 ? read_tiles(handle_, found, image)
                                              : read_strips(handle_, found, image);
  if (!good) refuse(name + (reason_->empty() ? "it cannot be decoded" : *reason_));
  if (grey) find_luminance(handle_, found, image);
  return image;
}

Image read_tiff(const std::string& path, bool grey) {
  TiffFile file(path);
  const std::int64_t pages = file.pages();
  if (pages != 1) {
    refuse_image(path, "has " + std::to_string(pages) + " pages, where one is allowed");
  }
  return file.read(0, grey);
}

}  // namespace poreshock
