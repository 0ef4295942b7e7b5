// Independent noise: every count has an exact mean and variance at finite pixel size.

#include <gtest/gtest.h>

#include <cmath>

#include "support/images.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::reference;

constexpr double sigmas = 4.5;

/// Variance per cell of the number of 2 x 2 blocks that are empty, for chance s of an empty pixel:
/// a block shares two pixels with 4 others and one with 4 more.
double block_variance(double s) {
  const double s8 = std::pow(s, 8);
  return (std::pow(s, 4) - s8) + 4.0 * (std::pow(s, 6) - s8) + 4.0 * (std::pow(s, 7) - s8);
}

TEST(Noise, CountsOfALargeImageAgreeWithTheirExactMeans) {
  Random random{11};
  constexpr int width = 700;
  constexpr int height = 600;
  constexpr double pixels = width * height;
  const std::vector<double> thresholds = {0.1, 0.3, 0.5, 0.7, 0.9};
  const Image image = random_image(Texture::noise, {width, 1, height}, {true, false}, 0.0, random);
  const PixelCounts c = count_whole(image, thresholds);
  for (std::size_t j = 0; j < thresholds.size(); ++j) {
    const double q = thresholds[j];
    const double p = 1.0 - q;
    const auto close = [&](std::int64_t found, double mean, double variance_per_pixel) {
      const double z = (static_cast<double>(found) - mean) / std::sqrt(pixels * variance_per_pixel);
      EXPECT_LT(std::abs(z), sigmas) << "at " << q << ": " << found << " for " << mean;
    };
    const double inner_edges = 2.0 * pixels - width;
    const double inner_vertices = pixels - width;
    const double edge_variance =
        2.0 * (std::pow(q, 2) - std::pow(q, 4)) + 12.0 * (std::pow(q, 3) - std::pow(q, 4));
    close(c.F[j], pixels * p, p * q);
    close(c.E[j], inner_edges * (1.0 - q * q) + 2.0 * width * p, edge_variance);
    close(c.V[j], inner_vertices * (1.0 - std::pow(q, 4)) + 2.0 * width * (1.0 - q * q),
          block_variance(q));
    close(c.V4[j], inner_vertices * std::pow(p, 4), block_variance(p));
  }
}

/// chi8 = -q + 2 q^2 - q^4 and chi4 = p - 2 p^2 + p^4 per pixel of a torus. On the cylinder one row
/// of inner edges and vertices becomes two rows on the frame.
TEST(Noise, EulerCharacteristicsHaveTheirExactMeans) {
  Random random{12};
  constexpr int width = 60;
  constexpr int height = 50;
  constexpr int images = 200;
  const std::vector<double> thresholds = {0.2, 0.4, 0.6, 0.8};
  std::vector<std::array<double, 4>> moments(thresholds.size());  // sums of chi8, chi4 and squares
  for (int i = 0; i < images; ++i) {
    const Image image =
        random_image(Texture::noise, {width, 1, height}, {true, false}, 0.0, random);
    const PixelCounts c = count_whole(image, thresholds);
    for (std::size_t j = 0; j < thresholds.size(); ++j) {
      const auto chi8 = static_cast<double>(c.V[j] - c.E[j] + c.F[j]);
      const auto chi4 = static_cast<double>(c.E[j] - 3 * c.F[j] + c.V4[j]);
      moments[j][0] += chi8;
      moments[j][1] += chi4;
      moments[j][2] += chi8 * chi8;
      moments[j][3] += chi4 * chi4;
    }
  }
  for (std::size_t j = 0; j < thresholds.size(); ++j) {
    const double q = thresholds[j];
    const double p = 1.0 - q;
    const double torus8 = -q + 2.0 * q * q - std::pow(q, 4);
    const double torus4 = p - 2.0 * p * p + std::pow(p, 4);
    const double pixels = width * height;
    const double exact8 = pixels * torus8 + width * (2.0 * (1.0 - q * q) - (1.0 - std::pow(q, 4))) -
                          width * (2.0 * p - (1.0 - q * q));
    const double exact4 =
        pixels * torus4 + width * (2.0 * p - (1.0 - q * q)) - width * std::pow(p, 4);
    const double exact[] = {exact8, exact4};
    for (std::size_t k = 0; k < 2; ++k) {
      const double mean = moments[j][k] / images;
      const double variance = (moments[j][k + 2] / images - mean * mean) / (images - 1);
      EXPECT_LT(std::abs(mean - exact[k]), sigmas * std::sqrt(variance)) << k << " at " << q;
    }
  }
}

}  // namespace
