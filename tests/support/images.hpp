#pragma once
// Random images for the tests of the counts.

#include <cmath>

#include "support/pixel_reference.hpp"
#include "support/random_numbers.hpp"

namespace poreshock::reference {

enum class Texture { noise, smooth, ties, steps };

/// Values between 0 and 1: noise; a plane wave of a few pixels; noise rounded to eighths (the
/// thresholds of the tests); rows that are uniform over long stretches.
inline double texture_value(Texture texture, double phase, int x, int y, int z, Random& random) {
  const double noise = random.uniform();
  switch (texture) {
    case Texture::noise:
      return noise;
    case Texture::smooth:
      return 0.5 + 0.5 * std::sin(phase + 0.31 * x + 0.47 * y + 0.23 * z);
    case Texture::ties:
      return std::floor(8.0 * noise) / 8.0;
    case Texture::steps:
      return noise < 0.02 ? noise : (x < 66 ? 0.625 : 0.25);
  }
  return 0.0;
}

/// An image of the given size without pixels yet.
inline Image blank_image(std::array<int, 3> size, std::array<bool, 2> periodic) {
  Image image;
  image.width = size[0];
  image.depth = size[1];
  image.height = size[2];
  image.periodic = periodic[0];
  image.periodic_y = periodic[1];
  return image;
}

/// An image of the given size in which `voids` of the pixels are void. Voids hold NaN, or values
/// above every threshold that must not count.
inline Image random_image(Texture texture, std::array<int, 3> size, std::array<bool, 2> periodic,
                          double voids, Random& random) {
  Image image = blank_image(size, periodic);
  const double phase = 6.0 * random.uniform();
  for (int z = 0; z < size[2]; ++z) {
    for (int y = 0; y < size[1]; ++y) {
      for (int x = 0; x < size[0]; ++x) {
        const bool solid = random.uniform() >= voids;
        const double rubbish = random.below(2) == 0 ? NAN : 1e9;
        const double value = texture_value(texture, phase, x, y, z, random);
        image.values.push_back(solid ? value : rubbish);
        image.solid.push_back(solid ? 1 : 0);
      }
    }
  }
  return image;
}

/// The image whose pixel i is white (1, else 0) where bit i is set, pixels from 64 on black; all
/// material.
inline Image image_of_bits(std::uint64_t bits, std::array<int, 3> size,
                           std::array<bool, 2> periodic) {
  Image image = blank_image(size, periodic);
  image.solid.assign(image.size(), 1);
  for (std::size_t i = 0; i < image.size(); ++i) {
    image.values.push_back(i < 64 ? static_cast<double>((bits >> i) & 1) : 0.0);
  }
  return image;
}

}  // namespace poreshock::reference
