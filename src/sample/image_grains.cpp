#include <cmath>

#include "block.hpp"
#include "grains.hpp"
#include "image.hpp"
#include "poreshock/core/error.hpp"
#include "text.hpp"

namespace poreshock {
namespace {

/// Number of the connected region of each solid pixel: pixels of one value that share a side.
class Flood {
 public:
  Flood(const Image& image, bool periodic, GrainImage& grains)
      : image_(image), periodic_(periodic), grains_(grains) {}

  /// Gives all pixels that hang together with this one to `grain` and returns their number.
  std::int64_t fill(std::int64_t pixel, std::int32_t grain) {
    std::int64_t count = 0;
    grains_.grain[static_cast<std::size_t>(pixel)] = grain;
    open_.assign(1, pixel);
    while (!open_.empty()) {
      const std::int64_t at = open_.back();
      open_.pop_back();
      ++count;
      const std::int64_t x = at % grains_.columns, y = at / grains_.columns;
      if (y > 0) visit(at, at - grains_.columns);
      if (y + 1 < grains_.rows) visit(at, at + grains_.columns);
      if (x > 0 || periodic_) visit(at, x > 0 ? at - 1 : at + grains_.columns - 1);
      const bool last = x + 1 == grains_.columns;
      if (!last || periodic_) visit(at, last ? at + 1 - grains_.columns : at + 1);
    }
    return count;
  }

 private:
  void visit(std::int64_t from, std::int64_t to) {
    const auto f = static_cast<std::size_t>(from), t = static_cast<std::size_t>(to);
    if (grains_.grain[t] != unseen || image_.value[t] != image_.value[f]) return;
    grains_.grain[t] = grains_.grain[f];
    open_.push_back(to);
  }

  const Image& image_;
  bool periodic_;
  GrainImage& grains_;
  std::vector<std::int64_t> open_;

 public:
  static constexpr std::int32_t unseen = -2;
};

void require_extent(const Scene& scene, const Image& image, int axis) {
  const bool height = axis == 1;
  const double pixels = static_cast<double>(height ? image.rows : image.columns);
  const double extent = pixels * scene.sample.pixel;
  const double wanted = height ? scene.sample.height : scene.domain.size[0];
  if (std::fabs(extent - wanted) <= 1e-9 * wanted) return;
  throw InputError(
      "sample.image: " + scene.sample.image + ": has " +
      std::to_string(height ? image.rows : image.columns) + (height ? " rows" : " columns") +
      " of sample.pixel = " + length_text(scene.sample.pixel) + ", " + length_text(extent) +
      " in all, but " + (height ? "sample.height" : "the domain's width") + " is " +
      length_text(wanted) + ". Allowed is the same length. Set " +
      (height ? "sample.height" : "domain.size") + " or sample.pixel.");
}

/// The image with its lowest row first and 0 for void, which what is transparent is too; solid
/// pixels keep their label, or have 1 where a threshold tells.
Image solid_pixels(const Sample& sample) {
  const Image read = read_image(sample.image, sample.threshold.has_value());
  Image image = read;
  for (std::int64_t y = 0; y < image.rows; ++y) {
    for (std::int64_t x = 0; x < image.columns; ++x) {
      const std::int64_t value =
          read.value[static_cast<std::size_t>((image.rows - 1 - y) * image.columns + x)];
      const bool opaque = value >= 0;
      const bool marked =
          sample.threshold ? static_cast<double>(value) >= *sample.threshold : value != 0;
      const bool solid = opaque && marked;
      image.value[static_cast<std::size_t>(y * image.columns + x)] =
          !solid ? 0 : (sample.threshold ? 1 : value);
    }
  }
  return image;
}

}  // namespace

GrainLayout grains_of_image(const Scene& scene) {
  const Image image = solid_pixels(scene.sample);
  require_extent(scene, image, 0);
  require_extent(scene, image, 1);
  GrainLayout layout;
  layout.image = {image.columns, image.rows,
                  std::vector<std::int32_t>(image.value.size(), Flood::unseen)};
  Flood flood(image, scene.domain.periodic[0], layout.image);
  const double area = scene.sample.pixel * scene.sample.pixel;
  std::int64_t solid = 0;
  for (std::size_t i = 0; i < image.value.size(); ++i) {
    std::int32_t& grain = layout.image.grain[i];
    if (image.value[i] == 0) grain = -1;
    if (grain != Flood::unseen) continue;
    const std::int64_t pixels =
        flood.fill(static_cast<std::int64_t>(i), static_cast<std::int32_t>(layout.grains.size()));
    solid += pixels;
    layout.grains.push_back({.measure = static_cast<double>(pixels) * area});
  }
  if (solid == 0) {
    throw InputError(
        "sample.image: " + scene.sample.image +
        ": has no solid pixel. Allowed is at least one pixel " +
        (scene.sample.threshold ? "of sample.threshold or more." : "with a label other than 0."));
  }
  layout.void_fraction = 1.0 - static_cast<double>(solid) / static_cast<double>(image.value.size());
  return layout;
}

}  // namespace poreshock
