// Domains against flood fill and topology: every small image, random maps on any number of ranks.

#include <gtest/gtest.h>

#include <bit>

#include "poreshock/core/parallel.hpp"
#include "poreshock/morphology/analysis.hpp"
#include "support/domain_reference.hpp"
#include "support/images.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::reference;

const MPI_Comm world = MPI_COMM_WORLD;
constexpr double half[] = {0.5};

void expect_same(const DomainCounts& found, const DomainCounts& expected, const std::string& what) {
  EXPECT_EQ(found.pixels, expected.pixels) << what;
  EXPECT_EQ(found.n_W, expected.n_W) << what;
  EXPECT_EQ(found.n_B, expected.n_B) << what;
  EXPECT_EQ(found.n_B_frame, expected.n_B_frame) << what;
  EXPECT_EQ(found.white_winding, expected.white_winding) << what;
  EXPECT_EQ(found.black_winding, expected.black_winding) << what;
}

/// Counts by sweep and by flood fill; the map is dealt out to all ranks.
template <int Dim>
void check_counts(const Image& image, std::span<const double> thresholds, const std::string& what) {
  const PixelField<Dim> map = deal_out<Dim>(image, rank(world), size(world));
  for (const Joining joining : {Joining::corners, Joining::faces}) {
    expect_same(count_domains(map, 0, thresholds, joining, world),
                count_domains_plainly(image, thresholds, joining), what);
  }
}

/// Every small image in the window and on the cylinder: domains as flood fill finds them, and
/// n_W - n_B,inside - w = V - E + F (Alexander duality), for both joinings.
TEST(Domains, EverySmallImage) {
  if (size(world) > 1) GTEST_SKIP() << "a map of so few rows is not dealt out";
  constexpr std::array<std::array<int, 2>, 8> shapes = {
      {{1, 1}, {1, 6}, {6, 1}, {2, 5}, {5, 2}, {3, 4}, {4, 3}, {3, 3}}};
  for (const auto& [width, height] : shapes) {
    for (const bool periodic : {false, true}) {
      for (std::uint64_t bits = 0; bits < std::uint64_t{1} << (width * height); ++bits) {
        const Image image = image_of_bits(bits, {width, 1, height}, {periodic, false});
        const PixelField<2> map = deal_out<2>(image, 0, 1);
        const PixelCounts c = count_whole(image, half);
        for (const Joining joining : {Joining::corners, Joining::faces}) {
          const DomainCounts d = count_domains(map, 0, half, joining, MPI_COMM_SELF);
          const std::int64_t winds = d.white_winding[0] > 0 ? 1 : 0;
          const std::int64_t chi = joining == Joining::corners ? c.V[0] - c.E[0] + c.F[0]
                                                               : c.E[0] - 3 * c.F[0] + c.V4[0];
          ASSERT_EQ(d.n_W[0] - (d.n_B[0] - d.n_B_frame[0]) - winds, chi) << bits << periodic;
          const DomainCounts plain = count_domains_plainly(image, half, joining);
          ASSERT_EQ(d.n_W, plain.n_W) << bits;
          ASSERT_EQ(d.n_B, plain.n_B) << bits;
          ASSERT_EQ(d.n_B_frame, plain.n_B_frame) << bits;
          ASSERT_EQ(d.white_winding, plain.white_winding) << bits;
          ASSERT_EQ(d.black_winding, plain.black_winding) << bits;
        }
      }
    }
  }
}

std::int64_t choose(int n, int k) {
  if (k < 0 || k > n || n < 0) return 0;
  std::int64_t result = 1;
  for (int i = 1; i <= k; ++i) result = result * (n - k + i) / i;
  return result;
}

/// Summed over all images of the 4 x 3 cylinder with m white pixels, domains obey the polynomials
/// of independent pixels: a cell of g pixels is white in C(12, m) - C(12 - g, m) images. 12 pixels;
/// 20 edges of two, 8 of one pixel; 8 vertices of four, 8 of two.
TEST(Domains, SumsOverAllImagesAreTheExactPolynomials) {
  if (size(world) > 1) GTEST_SKIP() << "a map of so few rows is not dealt out";
  std::array<std::int64_t, 13> sums{};
  for (std::uint64_t bits = 0; bits < 4096; ++bits) {
    const Image image = image_of_bits(bits, {4, 1, 3}, {true, false});
    const DomainCounts d =
        count_domains(deal_out<2>(image, 0, 1), 0, half, Joining::corners, MPI_COMM_SELF);
    sums[static_cast<std::size_t>(std::popcount(bits))] +=
        d.n_W[0] - (d.n_B[0] - d.n_B_frame[0]) - (d.white_winding[0] > 0 ? 1 : 0);
  }
  for (int m = 0; m <= 12; ++m) {
    const auto white = [&](int g) { return choose(12, m) - choose(12 - g, m); };
    EXPECT_EQ(sums[static_cast<std::size_t>(m)],
              12 * white(1) - (20 * white(2) + 8 * white(1)) + 8 * white(4) + 8 * white(2))
        << m << " white pixels";
  }
}

/// Maps a few pixels wide, with voids and ties: domains join, part and wind over every border.
TEST(Domains, NarrowMapsOnAnyNumberOfRanks) {
  Random random{11};
  const std::vector<double> thresholds = {0.125, 0.25, 0.5, 0.5, 0.75, 2.0};
  for (int n = 0; n < 60; ++n) {
    const int width = 1 + random.below(6);
    const int height = 6 + random.below(8);
    const bool periodic = random.below(2) == 0;
    const double voids = random.below(2) == 0 ? 0.0 : 0.2;
    const Image image =
        random_image(Texture::ties, {width, 1, height}, {periodic, false}, voids, random);
    check_counts<2>(image, thresholds, "map " + std::to_string(n));
  }
  for (int n = 0; n < 30; ++n) {
    const std::array<int, 3> extent = {1 + random.below(4), 1 + random.below(4),
                                       6 + random.below(3)};
    const std::array<bool, 2> periodic = {random.below(2) == 0, random.below(2) == 0};
    const Image image = random_image(Texture::ties, extent, periodic, 0.1, random);
    check_counts<3>(image, thresholds, "voxels " + std::to_string(n));
  }
}

TEST(Domains, LargeMapsOnAnyNumberOfRanks) {
  Random random{12};
  std::vector<double> thresholds;
  for (int i = 1; i < 20; ++i) thresholds.push_back(0.05 * i);
  for (const Texture texture : {Texture::noise, Texture::smooth, Texture::steps}) {
    for (const bool periodic : {false, true}) {
      check_counts<2>(random_image(texture, {130, 1, 47}, {periodic, false}, 0.05, random),
                      thresholds, "pixels");
      check_counts<3>(random_image(texture, {17, 9, 13}, {periodic, !periodic}, 0.05, random),
                      thresholds, "voxels");
    }
  }
}

/// A hot spiral that climbs through all slabs: one domain, which winds only when it closes.
TEST(Domains, SpiralWindsWhenItCloses) {
  for (const bool closed : {false, true}) {
    Image image;
    image.width = 8;
    image.height = 24;
    image.periodic = true;
    image.values.assign(image.size(), 0.0);
    image.solid.assign(image.size(), 1);
    for (int z = 0; z < 24; z += 3) {
      // A row with one gap, and a step up to the next such row on one side of the gap.
      for (int x = 0; x < 7; ++x) image.values[static_cast<std::size_t>(8 * z + x)] = 1.0;
      for (int up = 1; up < 3 && z + 3 < 24; ++up) {
        image.values[static_cast<std::size_t>(8 * (z + up) + 3)] = 1.0;
      }
    }
    if (closed) image.values[static_cast<std::size_t>(8 * 21 + 7)] = 1.0;
    const PixelField<2> map = deal_out<2>(image, rank(world), size(world));
    const DomainCounts d = count_domains(map, 0, half, Joining::corners, world);
    EXPECT_EQ(d.n_W[0], 1);
    EXPECT_EQ(d.white_winding[0], closed ? 1 : 0);
    // The two cold rows above the last hot one wind.
    EXPECT_EQ(d.black_winding[0], 1);
    const PixelCounts c = count(map, 0, half, world);
    EXPECT_EQ(d.n_W[0] - (d.n_B[0] - d.n_B_frame[0]) - d.white_winding[0],
              c.V[0] - c.E[0] + c.F[0]);
  }
}

/// Discs at random (Boolean model), sampled at pixel centres. With U_k the area of k neighbouring
/// discs' union and q_k = exp(-intensity U_k), the mean of the Euler characteristic over maps of
/// n x m pixels in a black plane follows from cells of 1, 2 and 4 pixels, exactly.
TEST(Domains, BooleanDiscsHaveTheExactMean) {
  constexpr int width = 60;
  constexpr int height = 60;
  constexpr double radius = 4.0;
  constexpr double intensity = 0.014;
  Random random{13};
  double sum = 0.0;
  double squares = 0.0;
  constexpr int maps = 100;
  for (int map_number = 0; map_number < maps; ++map_number) {
    Image image;
    image.width = width;
    image.height = height;
    image.values.assign(image.size(), 0.0);
    image.solid.assign(image.size(), 1);
    double z = -radius;
    // Points of a Poisson process in a strip: exponential distances along it.
    while ((z -= std::log(1.0 - random.uniform()) / (intensity * (width + 2 * radius))) <
           height + radius) {
      const double x = random.uniform() * (width + 2 * radius) - radius;
      for (int j = 0; j < height; ++j) {
        for (int i = 0; i < width; ++i) {
          if ((i + 0.5 - x) * (i + 0.5 - x) + (j + 0.5 - z) * (j + 0.5 - z) < radius * radius) {
            image.values[static_cast<std::size_t>(j * width + i)] = 1.0;
          }
        }
      }
    }
    const PixelField<2> map = deal_out<2>(image, rank(world), size(world));
    const DomainCounts d = count_domains(map, 0, half, Joining::corners, world);
    const auto chi = static_cast<double>(d.n_W[0] - (d.n_B[0] - d.n_B_frame[0]));
    sum += chi;
    squares += chi * chi;
  }
  // g = int_0^(1/2) sqrt(R^2 - x^2) dx; two discs one pixel apart cover U1 + 4 g less the overlap.
  const double g =
      0.25 * std::sqrt(radius * radius - 0.25) + 0.5 * radius * radius * std::asin(0.5 / radius);
  const double u1 = M_PI * radius * radius;
  const double u2 = u1 + 4.0 * g;
  const double u4 = 2.0 * u2 - u1 + 1.0;
  const auto p = [&](double area) { return 1.0 - std::exp(-intensity * area); };
  const double pixels = width * height;
  const double inner_edges = (width - 1) * height + width * (height - 1);
  const double inner_vertices = (width - 1) * (height - 1);
  const double frame = 2.0 * (width + height);
  const double expected = pixels * p(u1) - inner_edges * p(u2) - frame * p(u1) +
                          inner_vertices * p(u4) + (frame - 4.0) * p(u2) + 4.0 * p(u1);
  const double mean = sum / maps;
  const double error = std::sqrt((squares / maps - mean * mean) / (maps - 1));
  EXPECT_LT(std::abs(mean - expected), 4.5 * error) << mean << " against " << expected;
  EXPECT_LT(error, 0.05 * 15.0);
}

TEST(Domains, NothingToCount) {
  const Image image = image_of_bits(0, {3, 1, 12}, {true, false});
  PixelField<2> map = deal_out<2>(image, rank(world), size(world));
  const DomainCounts cold = count_domains(map, 0, half, Joining::corners, world);
  EXPECT_EQ(cold.n_W[0], 0);
  EXPECT_EQ(cold.n_B[0], 1);
  EXPECT_EQ(chi_of_domains(cold), (std::vector<double>{-1.0 / 36.0}));
  std::fill(map.solid.begin(), map.solid.end(), std::uint8_t{0});
  const DomainCounts none = count_domains(map, 0, half, Joining::corners, world);
  EXPECT_EQ(none.pixels, 0);
  EXPECT_EQ(none.n_B[0], 0);
  EXPECT_EQ(chi_of_domains(none), (std::vector<double>{0.0}));
  EXPECT_TRUE(count_domains(map, 0, {}, Joining::corners, world).n_W.empty());
}

}  // namespace
