// Every hot spot by itself: against flood fill, and discs whose numbers are known.

#include <gtest/gtest.h>

#include "poreshock/core/parallel.hpp"
#include "support/domain_reference.hpp"
#include "support/images.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::reference;

const MPI_Comm world = MPI_COMM_WORLD;

std::int64_t fold(std::int64_t x, std::int64_t n) {
  return ((x % n) + n) % n;
}

template <int Dim>
void expect_same(const HotSpot<Dim>& spot, const PlainDomain& plain, const Image& image) {
  EXPECT_EQ(spot.pixels, plain.pixels);
  EXPECT_EQ(spot.peak, plain.peak);
  EXPECT_EQ(spot.first, plain.first);
  EXPECT_NEAR(spot.mean, plain.sum / static_cast<double>(plain.pixels), 1e-9);
  const std::array<int, 3> all = {image.width, image.depth, image.height};
  const std::array<bool, 3> wraps = {image.periodic, image.periodic_y, false};
  for (std::size_t axis = 0; axis < Dim; ++axis) {
    const std::size_t at = axis + 1 == Dim ? 2 : axis;
    if (at < 2) {
      EXPECT_EQ(spot.winds[axis], plain.winds[at]);
    }
    if (at < 2 && plain.winds[at]) {
      EXPECT_EQ(spot.low[axis], 0);
      EXPECT_EQ(spot.size[axis], all[at]);
      EXPECT_TRUE(std::isnan(spot.centroid[axis]));
      continue;
    }
    EXPECT_EQ(spot.low[axis], wraps[at] ? fold(plain.low[at], all[at]) : plain.low[at]);
    EXPECT_EQ(spot.size[axis], plain.high[at] - plain.low[at] + 1);
    const auto n = static_cast<double>(plain.pixels);
    double centre = static_cast<double>(plain.position_sum[at]) / n + 0.5;
    if (wraps[at]) centre -= all[at] * std::floor(centre / all[at]);
    EXPECT_NEAR(spot.centroid[axis], centre, 1e-12 * (1.0 + all[at]));
  }
}

template <int Dim>
void check_spots(const Image& image, double threshold) {
  const PixelField<Dim> map = deal_out<Dim>(image, rank(world), size(world));
  for (const Joining joining : {Joining::corners, Joining::faces}) {
    const auto spots = find_hot_spots(map, 0, threshold, joining, world);
    if (rank(world) != 0) {
      EXPECT_TRUE(spots.empty());
      continue;
    }
    PlainDomains plain(image, threshold, true, joining == Joining::corners);
    std::stable_sort(
        plain.domains.begin(), plain.domains.end(),
        [](const PlainDomain& a, const PlainDomain& b) { return a.pixels > b.pixels; });
    ASSERT_EQ(spots.size(), plain.domains.size());
    for (std::size_t i = 0; i < spots.size(); ++i) expect_same(spots[i], plain.domains[i], image);
  }
}

TEST(HotSpots, AsFloodFillFindsThem) {
  Random random{21};
  for (int n = 0; n < 60; ++n) {
    const bool periodic = random.below(2) == 0;
    const std::array<int, 3> pixels = {1 + random.below(7), 1, 6 + random.below(8)};
    check_spots<2>(random_image(Texture::noise, pixels, {periodic, false}, 0.1, random), 0.45);
    const std::array<int, 3> voxels = {1 + random.below(4), 1 + random.below(4),
                                       6 + random.below(3)};
    check_spots<3>(
        random_image(Texture::noise, voxels, {periodic, random.below(2) == 0}, 0.1, random), 0.75);
  }
  for (const Texture texture : {Texture::noise, Texture::smooth, Texture::steps}) {
    check_spots<2>(random_image(texture, {150, 1, 40}, {true, false}, 0.05, random), 0.6);
    check_spots<3>(random_image(texture, {15, 11, 14}, {true, true}, 0.05, random), 0.85);
  }
}

/// Discs around pixel centres, on a seam and on every border between ranks: the number of lattice
/// points of each (Gauss circle: 1, 5, 13, 29, 49 for radius 0 ... 4), its centre to the bit, its
/// peak in the middle.
TEST(HotSpots, DiscsKeepTheirNumbers) {
  constexpr std::array<std::int64_t, 5> points = {1, 5, 13, 29, 49};
  constexpr std::array<std::array<int, 2>, 5> centres = {
      {{5, 4}, {0, 10}, {31, 18}, {16, 25}, {3, 33}}};
  Image image;
  image.width = 32;
  image.height = 40;
  image.periodic = true;
  image.values.assign(image.size(), 300.0);
  image.solid.assign(image.size(), 1);
  for (int r = 0; r < 5; ++r) {
    const auto [cx, cz] = centres[static_cast<std::size_t>(r)];
    for (int z = -r; z <= r; ++z) {
      for (int x = -r; x <= r; ++x) {
        if (x * x + z * z > r * r) continue;
        const auto at = static_cast<std::size_t>((cz + z) * 32 + (cx + x + 32) % 32);
        image.values[at] = x == 0 && z == 0 ? 1000.0 + r : 600.0;
      }
    }
  }
  const PixelField<2> map = deal_out<2>(image, rank(world), size(world));
  const auto spots = find_hot_spots(map, 0, 500.0, Joining::corners, world);
  if (rank(world) != 0) return;
  ASSERT_EQ(spots.size(), 5u);
  for (int r = 0; r < 5; ++r) {
    const HotSpot<2>& spot = spots[static_cast<std::size_t>(4 - r)];
    const auto [cx, cz] = centres[static_cast<std::size_t>(r)];
    const std::int64_t n = points[static_cast<std::size_t>(r)];
    EXPECT_EQ(spot.pixels, n);
    EXPECT_EQ(spot.peak, 1000.0 + r);
    EXPECT_NEAR(spot.mean,
                (600.0 * static_cast<double>(n - 1) + 1000.0 + r) / static_cast<double>(n),
                1000.0 * 0x1p-31);
    EXPECT_EQ(spot.centroid[0], cx + 0.5);
    EXPECT_EQ(spot.centroid[1], cz + 0.5);
    EXPECT_EQ(spot.low[0], (cx - r + 32) % 32);
    EXPECT_EQ(spot.low[1], cz - r);
    EXPECT_EQ(spot.size[0], 2 * r + 1);
    EXPECT_EQ(spot.size[1], 2 * r + 1);
    EXPECT_FALSE(spot.winds[0]);
  }
}

/// A band around the cylinder has no centre along x; its other numbers stand.
TEST(HotSpots, BandWinds) {
  Image image = image_of_bits(0, {70, 1, 12}, {true, false});
  for (std::size_t i = 5 * 70; i < 8 * 70; ++i) image.values[i] = 2.0;
  const auto spots =
      find_hot_spots(deal_out<2>(image, rank(world), size(world)), 0, 1.0, Joining::faces, world);
  if (rank(world) != 0) return;
  ASSERT_EQ(spots.size(), 1u);
  EXPECT_TRUE(spots[0].winds[0]);
  EXPECT_TRUE(std::isnan(spots[0].centroid[0]));
  EXPECT_EQ(spots[0].centroid[1], 6.5);
  EXPECT_EQ(spots[0].pixels, 210);
  EXPECT_EQ(spots[0].mean, 2.0);
  EXPECT_EQ(spots[0].size, (std::array<std::int64_t, 2>{70, 3}));
}

}  // namespace
