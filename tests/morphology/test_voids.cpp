// Void pixels in the Euler characteristic, interpolated boundaries and quantiles, on any number of
// ranks.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/morphology/analysis.hpp"
#include "poreshock/morphology/isoline.hpp"
#include "poreshock/morphology/quantiles.hpp"
#include "poreshock/morphology/voids.hpp"
#include "support/domain_reference.hpp"
#include "support/images.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::reference;

const MPI_Comm world = MPI_COMM_WORLD;

/// The rows of all ranks put together, on every rank.
template <int Dim>
std::vector<double> whole_map(const PixelField<Dim>& map) {
  std::size_t row = 1;
  for (std::size_t a = 0; a + 1 < Dim; ++a) row *= static_cast<std::size_t>(map.layout.pixels[a]);
  const int count = static_cast<int>(row * static_cast<std::size_t>(map.rows));
  std::vector<int> counts(static_cast<std::size_t>(size(world))), starts(counts.size(), 0);
  MPI_Allgather(&count, 1, MPI_INT, counts.data(), 1, MPI_INT, world);
  for (std::size_t r = 1; r < counts.size(); ++r) starts[r] = starts[r - 1] + counts[r - 1];
  std::vector<double> all(static_cast<std::size_t>(starts.back() + counts.back()));
  MPI_Allgatherv(map.values[0].data(), count, MPI_DOUBLE, all.data(), counts.data(), starts.data(),
                 MPI_DOUBLE, world);
  return all;
}

/// Least squared distance from a pixel to material, and whether material there has this value.
std::pair<int, bool> nearest_plainly(const Image& image, std::array<int, 3> at, double value) {
  int least = std::numeric_limits<int>::max();
  bool found = false;
  const auto apart = [](int a, int b, int n, bool periodic) {
    const int d = std::abs(a - b);
    return periodic ? std::min(d, n - d) : d;
  };
  for (int z = 0; z < image.height; ++z) {
    for (int y = 0; y < image.depth; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const auto i = static_cast<std::size_t>(index_of(image, x, y, z));
        if (image.solid[i] == 0) continue;
        const int dx = apart(at[0], x, image.width, image.periodic);
        const int dy = apart(at[1], y, image.depth, image.periodic_y);
        const int distance = dx * dx + dy * dy + (z - at[2]) * (z - at[2]);
        if (distance < least) found = false;
        least = std::min(least, distance);
        found = found || (distance == least && image.values[i] == value);
      }
    }
  }
  return {least, found};
}

template <int Dim>
void check_fill(Image image) {
  image.solid[image.size() / 2] = 1;  // without material there is nothing to fill with
  image.values[image.size() / 2] = 0.5;
  const PixelField<Dim> map = deal_out<Dim>(image, rank(world), size(world));
  const PixelField<Dim> filled = fill_voids(map, 0, world);
  const std::vector<double> values = whole_map(filled);
  ASSERT_EQ(values.size(), image.size());
  for (int z = 0; z < image.height; ++z) {
    for (int y = 0; y < image.depth; ++y) {
      for (int x = 0; x < image.width; ++x) {
        const auto i = static_cast<std::size_t>(index_of(image, x, y, z));
        const auto [distance, same] = nearest_plainly(image, {x, y, z}, values[i]);
        EXPECT_TRUE(same) << x << " " << y << " " << z << ": " << values[i] << " not at distance "
                          << distance;
      }
    }
  }
  // One rank alone finds the same of several nearest, and the ghost row is that of the neighbour.
  const PixelField<Dim> alone = fill_voids(deal_out<Dim>(image, 0, 1), 0, MPI_COMM_SELF);
  for (std::size_t i = 0; i < values.size(); ++i) EXPECT_EQ(values[i], alone.values[0][i]);
  const PixelField<Dim> expected = [&] {
    Image whole = image;
    whole.values.assign(alone.values[0].begin(),
                        alone.values[0].begin() + static_cast<std::ptrdiff_t>(image.size()));
    whole.solid.assign(image.size(), 1);
    return deal_out<Dim>(whole, rank(world), size(world));
  }();
  const std::size_t stored = values.size() / static_cast<std::size_t>(image.height) *
                             static_cast<std::size_t>(map.rows + (map.last ? 0 : 1));
  for (std::size_t i = 0; i < stored; ++i) EXPECT_EQ(filled.values[0][i], expected.values[0][i]);
}

TEST(Voids, FilledFromTheNearestMaterial) {
  Random random{5};
  for (int n = 0; n < 12; ++n) {
    const double voids = n % 3 == 0 ? 0.95 : 0.5;
    const bool x = random.below(2) == 0;
    const bool y = random.below(2) == 0;
    check_fill<2>(random_image(Texture::noise, {1 + random.below(9), 1, 8 + random.below(6)},
                               {x, false}, voids, random));
    check_fill<3>(random_image(Texture::noise, {1 + random.below(5), 1 + random.below(5), 7},
                               {x, y}, voids, random));
  }
}

/// A ring of hot material around one void pixel and a cold one: V - E + F for each convention.
TEST(Voids, ConventionsOfARing) {
  if (size(world) > 6) GTEST_SKIP();
  Image image;
  image.width = 5;
  image.height = 7;
  image.values.assign(35, 400.0);
  image.solid.assign(35, 1);
  for (int z = 1; z < 6; ++z) {
    for (int x = 1; x < 4; ++x) image.values[static_cast<std::size_t>(x + 5 * z)] = 600.0;
  }
  image.solid[2 + 5 * 2] = 0;  // the void
  image.values[2 + 5 * 4] = 400.0;
  const PixelField<2> map = deal_out<2>(image, rank(world), size(world));
  const double threshold[] = {500.0};
  const auto chi = [&](Voids voids) {
    return 34.0 * euler_density(map, 0, threshold, voids, world).corners[0];
  };
  EXPECT_NEAR(chi(Voids::black), -1.0, 1e-12);  // two holes
  EXPECT_NEAR(chi(Voids::white), 0.0, 1e-12);   // one
  EXPECT_NEAR(chi(Voids::fill), 0.0, 1e-12);
  // Inside the material and the frame: 34 pixels, 13 white; 54 sides of two, 4 of them with the
  // void; 24 corners of four, 4 with the void. What is left of the sum has no topological meaning.
  const double F = 13.0 / 34.0;
  const auto found = euler_density(map, 0, threshold, Voids::exclude, world).corners[0];
  const double Ex = 18.0 / 26.0, Ey = 16.0 / 28.0, V = 20.0 / 20.0;
  EXPECT_NEAR(found, F - Ex - Ey + V, 1e-12);
}

/// Leaving out what touches a void keeps the mean of independent pixels: -q + 2 q^2 - q^4 and its
/// dual p - 2 p^2 + p^4 in 2-D, q - 3 q^2 + 3 q^4 - q^8 in 3-D.
TEST(Voids, ExcludedVoidsKeepTheMeanOfNoise) {
  const double q = 0.6;
  const double p = 1.0 - q;
  const double threshold[] = {q};
  const auto z_score = [&](auto density, double mean) {
    double sum = 0.0, squares = 0.0;
    for (const double value : density) sum += value, squares += value * value;
    const double n = static_cast<double>(density.size());
    const double deviation = std::sqrt((squares - sum * sum / n) / (n - 1.0) / n);
    return (sum / n - mean) / deviation;
  };
  std::vector<double> corners, faces, deep;
  Random random{17};
  for (int n = 0; n < 24; ++n) {
    const Image flat = random_image(Texture::noise, {60, 1, 60}, {n % 2 == 0, false}, 0.3, random);
    const auto found = euler_density(deal_out<2>(flat, rank(world), size(world)), 0, threshold,
                                     Voids::exclude, world);
    corners.push_back(found.corners[0]);
    faces.push_back(found.faces[0]);
    const Image cube = random_image(Texture::noise, {16, 16, 16}, {true, false}, 0.2, random);
    deep.push_back(euler_density(deal_out<3>(cube, rank(world), size(world)), 0, threshold,
                                 Voids::exclude, world)
                       .corners[0]);
  }
  EXPECT_LT(std::abs(z_score(corners, -q + 2 * q * q - std::pow(q, 4))), 4.5);
  EXPECT_LT(std::abs(z_score(faces, p - 2 * p * p + std::pow(p, 4))), 4.5);
  EXPECT_LT(std::abs(z_score(deep, q - 3 * q * q + 3 * std::pow(q, 4) - std::pow(q, 8))), 4.5);
}

/// An image of a function of the pixel centres.
template <class Function>
Image image_of(int width, int height, bool periodic, Function f) {
  Image image;
  image.width = width;
  image.height = height;
  image.periodic = periodic;
  for (int z = 0; z < height; ++z) {
    for (int x = 0; x < width; ++x) image.values.push_back(f(x, z));
  }
  image.solid.assign(image.size(), 1);
  return image;
}

std::vector<double> isoline(const Image& image, std::span<const double> thresholds) {
  return isoline_lengths(deal_out<2>(image, rank(world), size(world)), 0, thresholds, world);
}

TEST(Isoline, PlaneFrontsAreExactAtAnyAngle) {
  for (const double degrees : {0.0, 10.0, 22.5, 35.0, 45.0, 60.0}) {
    const double c = std::cos(degrees * std::numbers::pi / 180.0);
    const double s = std::sin(degrees * std::numbers::pi / 180.0);
    const Image image = image_of(40, 60, false, [&](int x, int z) { return s * x + c * z; });
    // The line s x + c z = t between x = 0 and x = 39, where it stays between z = 0 and z = 59.
    if (degrees < 45.0) {
      const double threshold[] = {s * 19.5 + c * 29.25};
      EXPECT_NEAR(isoline(image, threshold)[0], 39.0 / c, 1e-7) << degrees;
    } else {
      // Through the low left part: from the left side to the low side.
      const double threshold[] = {20.25};
      EXPECT_NEAR(isoline(image, threshold)[0], 20.25 / (s * c), 1e-7) << degrees;
    }
  }
  const Image band = image_of(16, 12, true, [](int, int z) { return z; });
  const double thresholds[] = {2.5, 5.0, 20.0};
  EXPECT_EQ(isoline(band, thresholds), (std::vector<double>{16.0, 16.0, 0.0}));
}

TEST(Isoline, CirclesAndSaddles) {
  const Image disc =
      image_of(60, 60, false, [](int x, int z) { return -std::hypot(x - 29.7, z - 30.1); });
  const double radius[] = {-20.0, -10.0};
  const auto found = isoline(disc, radius);
  EXPECT_NEAR(found[0] / (2.0 * std::numbers::pi * 20.0), 1.0, 1e-3);
  EXPECT_NEAR(found[1] / (2.0 * std::numbers::pi * 10.0), 1.0, 2e-3);
  if (size(world) > 2) return;
  // One square with white corners 1 and 3: at 0.4 below the mean they join, at 0.6 they do not, and
  // either way two pieces cut off corners at equal places by symmetry.
  const Image saddle = image_of(2, 2, false, [](int x, int z) { return x == z ? 0.0 : 1.0; });
  const double thresholds[] = {0.4, 0.6};
  const auto pieces = isoline(saddle, thresholds);
  EXPECT_NEAR(pieces[0], 2.0 * 0.4 * std::numbers::sqrt2, 1e-8);
  EXPECT_NEAR(pieces[1], 2.0 * 0.4 * std::numbers::sqrt2, 1e-8);
}

TEST(Isoline, VoidsAndRanksDoNotMatterToTheBit) {
  Random random{3};
  const std::vector<double> thresholds = {0.1, 0.35, 0.5, 0.8};
  for (int n = 0; n < 6; ++n) {
    const Image image = random_image(n % 2 == 0 ? Texture::noise : Texture::smooth, {13, 1, 17},
                                     {n < 3, false}, 0.1, random);
    EXPECT_EQ(isoline(image, thresholds),
              isoline_lengths(deal_out<2>(image, 0, 1), 0, thresholds, MPI_COMM_SELF));
  }
}

TEST(Quantiles, AreTheSortedValues) {
  Random random{23};
  const std::vector<double> shares = {0.0, 0.01, 0.25, 0.5, 0.9, 1.0};
  for (const Texture texture : {Texture::noise, Texture::ties, Texture::smooth}) {
    Image image = random_image(texture, {11, 1, 19}, {true, false}, 0.2, random);
    for (std::size_t i = 0; i < image.size(); ++i) image.values[i] -= 0.5;  // both signs
    image.values[30] = image.values[31] = std::numeric_limits<double>::infinity();
    image.values[90] = -std::numeric_limits<double>::infinity();
    std::vector<double> sorted;
    for (std::size_t i = 0; i < image.size(); ++i) {
      if (image.solid[i] != 0) sorted.push_back(image.values[i]);
    }
    std::sort(sorted.begin(), sorted.end());
    const auto found = quantiles(deal_out<2>(image, rank(world), size(world)), 0, shares, world);
    for (std::size_t k = 0; k < shares.size(); ++k) {
      const auto number = static_cast<std::size_t>(
          std::max(1.0, std::ceil(shares[k] * static_cast<double>(sorted.size()))));
      EXPECT_EQ(found[k], sorted[number - 1]) << shares[k];
    }
  }
}

TEST(Quantiles, OfEqualFewAndNoValues) {
  const std::vector<double> shares = {0.0, 0.5, 1.0};
  const auto found = [&](const Image& image) {
    return quantiles(deal_out<2>(image, rank(world), size(world)), 0, shares, world);
  };
  Image image = image_of(5, 7, false, [](int, int) { return -0.375; });
  EXPECT_EQ(found(image), (std::vector<double>{-0.375, -0.375, -0.375}));
  // One pixel with a value, on one rank only.
  std::fill(image.solid.begin(), image.solid.end(), std::uint8_t{0});
  image.solid[32] = 1;
  image.values[32] = 4.0;
  EXPECT_EQ(found(image), (std::vector<double>{4.0, 4.0, 4.0}));
  image.values[32] = std::numeric_limits<double>::infinity();
  EXPECT_EQ(found(image)[1], std::numeric_limits<double>::infinity());
  image.solid[32] = 0;
  for (const double none : found(image)) EXPECT_TRUE(std::isnan(none));
  const std::vector<double> wrong = {0.5, 1.25};
  EXPECT_THROW(quantiles(deal_out<2>(image, rank(world), size(world)), 0, wrong, world),
               InputError);
}

}  // namespace
