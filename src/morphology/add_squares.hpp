#pragma once
// Adding a particle to the sums of the pixels that its square covers. Private to the layer.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <span>

#include "row_sums.hpp"
#include "squares.hpp"

namespace poreshock {

/// What a particle adds to the sums of a pixel; the compiler knows the usual numbers of fields.
template <std::size_t Fields = std::dynamic_extent>
struct Content {
  double density;
  std::span<const Addend, Fields> values;
};

/// Adds the content of a particle that covers `overlap` of a pixel, in 2^-18.
template <std::size_t Fields>
void add_to_pixel(double overlap, const Content<Fields>& content, std::uint64_t* pixel) {
  const std::int64_t weight = std::llrint(overlap * content.density);
  pixel[0] += static_cast<std::uint64_t>(std::llrint(overlap));
  pixel[1] += static_cast<std::uint64_t>(weight);
  // What weighs nothing has no say about the least value.
  const std::uint64_t counted = weight > 0 ? ~std::uint64_t{0} : 0;
  for (std::size_t k = 0; k < content.values.size(); ++k) {
    const Addend& value = content.values[k];
    std::uint64_t* sums = pixel + first_sum + 2 * k;
    sums[0] += static_cast<std::uint64_t>(weight * value.multiple);
    sums[1] = std::max(sums[1], value.key & counted);
  }
}

/// Adds one particle to the sums, along x innermost.
template <int Dim, std::size_t Fields>
void add_square(const std::array<Overlaps, Dim>& overlaps, int width,
                const Content<Fields>& content, RowSums& sums) {
  const Overlaps& x = overlaps[0];
  const Overlaps& last = overlaps[Dim - 1];
  const std::size_t middle = Dim == 3 ? overlaps[1].count : 1;
  for (std::size_t r = 0; r < last.count; ++r) {
    std::uint64_t* row = sums.row(last.pixel[r]);
    for (std::size_t m = 0; m < middle; ++m) {
      const double across = Dim == 3 ? last.length[r] * overlaps[1].length[m] : last.length[r];
      const std::size_t start = Dim == 3 ? static_cast<std::size_t>(overlaps[1].pixel[m]) *
                                               static_cast<std::size_t>(width)
                                         : 0;
      for (std::size_t i = 0; i < x.count; ++i) {
        add_to_pixel(x.length[i] * across * weight_unit, content,
                     row + (start + static_cast<std::size_t>(x.pixel[i])) * sums.components);
      }
    }
  }
}

/// Adds a square no larger than a pixel that lies inside the map, to four pixels, some of which it
/// may not reach. Without branches, since where a particle lies cannot be predicted. Says false,
/// and adds nothing, where the square is another one.
template <std::size_t Fields>
bool add_small_square(const Interval& x, const Interval& y, const std::array<int, 2>& pixels,
                      const Content<Fields>& content, RowSums& sums) {
  const double left = std::floor(x.low);
  const double bottom = std::floor(y.low);
  const bool small = x.high <= left + 2.0 && y.high <= bottom + 2.0 && left >= 0.0 &&
                     bottom >= 0.0 && left + 2.0 <= pixels[0] && bottom + 2.0 <= pixels[1];
  if (!small) return false;
  const auto two = [](const Interval& side, double at) {
    const double next = at + 1.0;
    const double first = (side.high < next ? side.high : next) - side.low;
    return std::array<double, 2>{first, side.high > next ? side.high - next : 0.0};
  };
  const auto in_x = two(x, left);
  const auto in_y = two(y, bottom);
  std::uint64_t* low =
      sums.row(static_cast<int>(bottom)) + static_cast<std::size_t>(left) * sums.components;
  std::uint64_t* high = low + sums.row_length;
  add_to_pixel(in_x[0] * in_y[0] * weight_unit, content, low);
  add_to_pixel(in_x[1] * in_y[0] * weight_unit, content, low + sums.components);
  add_to_pixel(in_x[0] * in_y[1] * weight_unit, content, high);
  add_to_pixel(in_x[1] * in_y[1] * weight_unit, content, high + sums.components);
  return true;
}

}  // namespace poreshock
