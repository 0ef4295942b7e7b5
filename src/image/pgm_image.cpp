// Netpbm, man page pgm(5): the plain (P2) and the raw (P5) grey map.

#include <algorithm>
#include <cctype>
#include <vector>

#include "image_format.hpp"

namespace poreshock {
namespace {

bool is_space(char c) {
  return std::isspace(static_cast<unsigned char>(c)) != 0;
}

/// First byte after the line of `at`, which ends with LF, CR LF or CR.
std::size_t next_line(const std::string& text, std::size_t at) {
  const std::size_t end = std::min(text.find_first_of("\r\n", at), text.size());
  if (text.compare(end, 2, "\r\n") == 0) return end + 2;
  return std::min(end + 1, text.size());
}

/// First byte from `at` that is neither white space nor in a comment.
std::size_t skip_space(const std::string& text, std::size_t at) {
  while (at < text.size() && (is_space(text[at]) || text[at] == '#')) {
    at = text[at] == '#' ? next_line(text, at) : at + 1;
  }
  return at;
}

/// Next number of a text, after white space and comments; -1 when there is none.
std::int64_t next_number(const std::string& text, std::size_t& at) {
  at = skip_space(text, at);
  std::int64_t number = -1;
  while (at < text.size() && std::isdigit(static_cast<unsigned char>(text[at])) != 0) {
    number = std::max(number, std::int64_t{0}) * 10 + (text[at++] - '0');
    if (number > most_image_pixels) return number;
  }
  return number;
}

/// Where the raw grey values may begin when the header ends at `at`: after one white space or one
/// CR LF, or after comments, which some programs write there too.
std::vector<std::size_t> raster_candidates(const std::string& text, std::size_t at) {
  std::vector<std::size_t> candidates;
  if (at < text.size() && is_space(text[at])) {
    candidates.push_back(at + (text.compare(at, 2, "\r\n") == 0 ? 2 : 1));
  }
  std::size_t comment = std::min(text.find_first_not_of(" \t\r\n", at), text.size());
  while (comment < text.size() && text[comment] == '#') {
    comment = next_line(text, comment);
    candidates.push_back(comment);
  }
  return candidates;
}

/// First byte of `size` raw grey values after a header that ends at `at`: the length of the file
/// tells. White space at the end of the file does no harm where there is no choice.
std::size_t raster_begin(const std::string& path, const std::string& text, std::size_t at,
                         std::size_t size) {
  const std::vector<std::size_t> candidates = raster_candidates(text, at);
  if (candidates.empty()) refuse_image(path, "has no white space after its PGM header");
  for (const std::size_t begin : candidates) {
    if (text.size() - begin == size) return begin;
  }
  const std::size_t begin = candidates.front();
  const std::size_t found = text.size() - begin;
  if (found < size) return begin;
  const bool blank =
      std::all_of(text.begin() + static_cast<std::ptrdiff_t>(begin + size), text.end(), is_space);
  if (candidates.size() == 1 && blank) return begin;
  refuse_image(path, "has " + std::to_string(found) + " bytes after its PGM header, whose pixels " +
                         "need " + std::to_string(size) +
                         ": its size is wrong, or its header ends in another way than with one "
                         "white space. Save it again, as one image");
}

[[noreturn]] void refuse_value(const std::string& path, const Image& image, std::int64_t most) {
  const auto i = static_cast<std::int64_t>(image.value.size());
  refuse_image(path, "has no grey value from 0 to " + std::to_string(most) + " at row " +
                         std::to_string(i / image.columns) + ", column " +
                         std::to_string(i % image.columns) + " (counted from 0)");
}

void read_raw(const std::string& path, const std::string& text, std::size_t at, std::int64_t most,
              Image& image) {
  const std::size_t width = most > 255 ? 2 : 1;
  const auto pixels = static_cast<std::size_t>(image.columns * image.rows);
  at = raster_begin(path, text, at, pixels * width);
  while (image.value.size() < pixels) {
    if (at + width > text.size()) refuse_value(path, image, most);
    std::int64_t value = 0;
    for (std::size_t b = 0; b < width; ++b) {
      value = value * 256 + static_cast<unsigned char>(text[at++]);
    }
    if (value > most) refuse_value(path, image, most);
    image.value.push_back(static_cast<double>(value));
  }
}

void read_plain(const std::string& path, const std::string& text, std::size_t at, std::int64_t most,
                Image& image) {
  const auto pixels = static_cast<std::size_t>(image.columns * image.rows);
  while (image.value.size() < pixels) {
    const std::int64_t value = next_number(text, at);
    if (value < 0 || value > most) refuse_value(path, image, most);
    image.value.push_back(static_cast<double>(value));
  }
  if (skip_space(text, at) == text.size()) return;
  refuse_image(path, "goes on after its " + std::to_string(image.columns) + " x " +
                         std::to_string(image.rows) + " grey values: its size is wrong, or there " +
                         "is more than one image in it");
}

}  // namespace

Image read_pgm(const std::string& path, const std::string& bytes) {
  std::size_t at = 2;
  Image image;
  image.columns = next_number(bytes, at);
  image.rows = next_number(bytes, at);
  const std::int64_t most = next_number(bytes, at);
  require_image_size(path, image.columns, image.rows);
  if (most < 1 || most > 65535) {
    refuse_image(path, "has a greatest grey value of " + std::to_string(most) +
                           " in its PGM header, where 1 to 65535 is allowed");
  }
  image.depth = most > 255 ? 16 : 8;
  bytes[1] == '5' ? read_raw(path, bytes, at, most, image)
                  : read_plain(path, bytes, at, most, image);
  return image;
}

}  // namespace poreshock
