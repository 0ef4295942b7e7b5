#include "poreshock/image/image.hpp"

#include <array>
#include <cerrno>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string_view>

#include "image_format.hpp"
#include "poreshock/core/error.hpp"

namespace poreshock {
namespace {

std::string read_bytes(const std::string& path) {
  errno = 0;
  std::ifstream file(path, std::ios::binary);
  if (!file) refuse_image(path, std::string("cannot be opened (") + std::strerror(errno) + ")");
  std::string bytes{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  if (file.bad() || bytes.empty()) refuse_image(path, "cannot be read, or is empty");
  return bytes;
}

}  // namespace

void refuse_image(const std::string& path, const std::string& found) {
  throw InputError("sample.image: " + path + ": " + found +
                   ". Allowed is a PNG, TIFF or PGM (P2 or P5) file of at most 2^28 pixels.");
}

void require_image_size(const std::string& path, std::int64_t columns, std::int64_t rows) {
  if (columns > 0 && rows > 0 && columns <= most_image_pixels / rows) return;
  refuse_image(path, "has " + std::to_string(columns) + " x " + std::to_string(rows) +
                         " pixels in its header");
}

std::int64_t colour_value(std::int64_t red, std::int64_t green, std::int64_t blue, bool grey) {
  if (red == green && green == blue) return red;
  if (grey) return (299 * red + 587 * green + 114 * blue) / 1000;
  return (red << 32) + (green << 16) + blue;
}

Image read_image(const std::string& path, bool grey) {
  constexpr std::string_view png = "\x89PNG\r\n\x1a\n";
  const std::string bytes = read_bytes(path);
  if (bytes.starts_with(png)) return read_png(path, bytes, grey);
  if (bytes.starts_with("P2") || bytes.starts_with("P5")) return read_pgm(path, bytes);
  const bool tiff = bytes.starts_with(std::string_view("II*\0", 4)) ||
                    bytes.starts_with(std::string_view("MM\0*", 4)) ||
                    bytes.starts_with(std::string_view("II+\0", 4)) ||
                    bytes.starts_with(std::string_view("MM\0+", 4));
  if (tiff) return read_tiff(path, grey);
  refuse_image(path, "is neither a PNG, nor a TIFF, nor a PGM file");
}

}  // namespace poreshock
