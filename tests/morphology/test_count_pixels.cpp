// Counts of pixel maps: one pass against thresholding each level by itself, blocks against the
// whole, single objects, identities, and what is refused.

#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "poreshock/core/error.hpp"
#include "poreshock/morphology/minkowski.hpp"
#include "support/images.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::reference;

constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr Texture textures[] = {Texture::noise, Texture::smooth, Texture::ties, Texture::steps};

std::vector<double> even_thresholds(int count) {
  std::vector<double> thresholds;
  for (int k = 0; k < count; ++k) thresholds.push_back((k + 0.5) / count);
  return thresholds;
}

/// Lists that stress the rank: on the values, repeated, infinite, clustered, one only, none.
std::vector<std::vector<double>> threshold_lists() {
  std::vector<double> crowd(40, 0.5);
  for (std::size_t i = 0; i < crowd.size(); ++i) crowd[i] += 1e-9 * static_cast<double>(i);
  crowd.insert(crowd.begin(), -1e6);
  crowd.push_back(1e6);
  return {{0.0, 0.125, 0.25, 0.375, 0.5, 0.625, 0.75, 0.875, 1.0},
          {-infinity, -1.0, 0.25, 0.25, 0.25, 0.5, 0.5, infinity, infinity},
          crowd,
          {0.5},
          {0.3, 0.3},
          {}};
}

TEST(CountPixels, OnePassEqualsThresholdingLevelByLevel) {
  Random random{1};
  const auto lists = threshold_lists();
  for (const Texture texture : textures) {
    for (int width = 1; width <= 70; ++width) {
      for (const bool periodic : {false, true}) {
        const double voids = width % 3 == 0 ? 0.0 : 0.2;
        const Image image = random_image(texture, {width, 1, 1 + random.below(5)},
                                         {periodic, false}, voids, random);
        for (const auto& thresholds : lists) {
          ASSERT_TRUE(count_whole(image, thresholds) == count_pixels_plainly(image, thresholds))
              << "width " << width << " periodic " << periodic << " levels " << thresholds.size();
        }
      }
    }
  }
}

TEST(CountPixels, RanksOfOneTwoAndFourBytes) {
  Random random{2};
  const Image image = random_image(Texture::noise, {9, 1, 4}, {true, false}, 0.1, random);
  for (const int count : {255, 256, 65535, 65536}) {
    const std::vector<double> thresholds = even_thresholds(count);
    EXPECT_TRUE(count_whole(image, thresholds) == count_pixels_plainly(image, thresholds)) << count;
  }
}

TEST(CountPixels, ThresholdsInClusters) {
  // Pairs, triples ... closer together than a cell of the table of ranks is wide.
  Random random{7};
  const Image image = random_image(Texture::noise, {67, 1, 41}, {true, false}, 0.1, random);
  for (const int together : {1, 2, 3, 4, 5}) {
    std::vector<double> thresholds;
    for (int k = 0; k < 20; ++k) {
      for (int n = 0; n < together; ++n) thresholds.push_back((k + 0.5) / 20 + 1e-4 * n);
    }
    EXPECT_TRUE(count_whole(image, thresholds) == count_pixels_plainly(image, thresholds))
        << together;
  }
}

TEST(CountPixels, WideRowsWithUniformStretches) {
  Random random{3};
  const std::vector<double> thresholds = even_thresholds(16);
  for (const int width : {64, 65, 127, 128, 129, 200, 333}) {
    for (const bool periodic : {false, true}) {
      const Image image =
          random_image(Texture::steps, {width, 1, 5}, {periodic, false}, 0.01, random);
      EXPECT_TRUE(count_whole(image, thresholds) == count_pixels_plainly(image, thresholds))
          << width;
    }
  }
}

TEST(CountPixels, BlocksOfEveryTilingAddUpToTheWhole) {
  Random random{4};
  const std::vector<double> thresholds = {0.1, 0.25, 0.5, 0.9};
  for (const Texture texture : textures) {
    for (const bool periodic : {false, true}) {
      for (int width = 1; width <= 6; ++width) {
        const int height = 6;
        const Image image =
            random_image(texture, {width, 1, height}, {periodic, false}, 0.2, random);
        const PixelCounts whole = count_whole(image, thresholds);
        // Bit r - 1 of `cuts` puts a cut below row r.
        for (int cuts = 0; cuts < 1 << (height - 1); ++cuts) {
          PixelCounts total;
          int first = 0;
          for (int row = 1; row <= height; ++row) {
            if (row < height && ((cuts >> (row - 1)) & 1) == 0) continue;
            const auto part = cut<PixelBlock>(image, first, row - first);
            add(count_pixels(part.block, thresholds), total);
            first = row;
          }
          ASSERT_TRUE(total == whole) << "cuts " << cuts << " width " << width;
        }
      }
    }
  }
}

TEST(CountPixels, Identities) {
  Random random{5};
  for (int repeat = 0; repeat < 50; ++repeat) {
    const bool periodic = repeat % 2 == 0;
    const Image image =
        random_image(Texture::noise, {1 + random.below(20), 1, 1 + random.below(20)},
                     {periodic, false}, repeat % 3 == 0 ? 0.0 : 0.3, random);
    const std::vector<double> thresholds = {0.2, 0.5, 0.7};
    const PixelCounts c = count_whole(image, thresholds);
    for (std::size_t j = 0; j < thresholds.size(); ++j) {
      EXPECT_EQ(c.B_int[j] + c.B_void[j] + c.B_frame[j], 2 * c.E[j] - 4 * c.F[j]);
      const std::int64_t chi8 = c.V[j] - c.E[j] + c.F[j];
      const std::int64_t chi4 = c.E[j] - 3 * c.F[j] + c.V4[j];
      EXPECT_EQ(chi4 - chi8, count_ambiguous_blocks(image, thresholds[j]));
      std::int64_t white_white = 0;
      for (int z = 0; z < image.height; ++z) {
        for (int x = 0; x < image.width; ++x) {
          if (!is_white(image, thresholds[j], x, 0, z)) continue;
          white_white += is_white(image, thresholds[j], x + 1, 0, z) ? 1 : 0;
          white_white += is_white(image, thresholds[j], x, 0, z + 1) ? 1 : 0;
        }
      }
      EXPECT_EQ(white_white, 4 * c.F[j] - c.E[j]);
    }
  }
}

/// An image of zeros and ones from rows of text, the highest row first; '.' black, '#' white, 'o'
/// void.
Image drawn(std::vector<std::string> rows, bool periodic) {
  Image image;
  image.width = static_cast<int>(rows[0].size());
  image.height = static_cast<int>(rows.size());
  image.periodic = periodic;
  std::reverse(rows.begin(), rows.end());
  for (const std::string& row : rows) {
    for (const char pixel : row) {
      image.values.push_back(pixel == '#' ? 1.0 : 0.0);
      image.solid.push_back(pixel == 'o' ? 0 : 1);
    }
  }
  return image;
}

struct Expected {
  std::int64_t F, E, V, V4, D, B_int, B_void, B_frame, chi8, chi4;
};

void expect_counts(const Image& image, const Expected& expected) {
  const double threshold[] = {0.5};
  const PixelCounts c = count_whole(image, threshold);
  EXPECT_EQ(c.F[0], expected.F);
  EXPECT_EQ(c.E[0], expected.E);
  EXPECT_EQ(c.V[0], expected.V);
  EXPECT_EQ(c.V4[0], expected.V4);
  EXPECT_EQ(c.D[0], expected.D);
  EXPECT_EQ(c.B_int[0], expected.B_int);
  EXPECT_EQ(c.B_void[0], expected.B_void);
  EXPECT_EQ(c.B_frame[0], expected.B_frame);
  EXPECT_EQ(c.V[0] - c.E[0] + c.F[0], expected.chi8);
  EXPECT_EQ(c.E[0] - 3 * c.F[0] + c.V4[0], expected.chi4);
}

TEST(CountPixels, SingleObjects) {
  expect_counts(drawn({"....", ".#..", "...."}, false), {1, 4, 4, 0, 4, 4, 0, 0, 1, 1});
  expect_counts(drawn({".....", ".##..", ".##..", "....."}, false),
                {4, 12, 9, 1, 14, 8, 0, 0, 1, 1});
  // Two pixels that touch in a corner: one domain with 8 neighbours, two with 4.
  expect_counts(drawn({"....", ".#..", "..#.", "...."}, false), {2, 8, 7, 0, 7, 8, 0, 0, 1, 2});
  expect_counts(drawn({".....", ".###.", ".#.#.", ".###.", "....."}, false),
                {8, 24, 16, 0, 28, 16, 0, 0, 0, 0});
  // The hole of the ring is void: its four edges move from B_int to B_void.
  expect_counts(drawn({".....", ".###.", ".#o#.", ".###.", "....."}, false),
                {8, 24, 16, 0, 28, 12, 4, 0, 0, 0});
  expect_counts(drawn({"##", "##"}, false), {4, 12, 9, 1, 14, 0, 0, 8, 1, 1});
  // The same square on a cylinder is a band around it.
  expect_counts(drawn({"##", "##"}, true), {4, 10, 6, 2, 12, 0, 0, 4, 0, 0});
  expect_counts(drawn({"#"}, false), {1, 4, 4, 0, 4, 0, 0, 4, 1, 1});
  expect_counts(drawn({"#"}, true), {1, 3, 2, 0, 4, 0, 0, 2, 0, 0});
}

TEST(CountPixels, FunctionalsPerMaterialPixel) {
  const double thresholds[] = {0.5, 2.0};
  const PixelCounts counts =
      count_whole(drawn({"....", ".##.", ".o..", "...."}, false), thresholds);
  ASSERT_EQ(counts.pixels, 15);
  const Minkowski result = functionals(counts);
  EXPECT_EQ(result.A, (std::vector<double>{2.0 / 15.0, 0.0}));
  EXPECT_EQ(result.L, (std::vector<double>{5.0 / 15.0, 0.0}));
  EXPECT_EQ(result.chi, (std::vector<double>{1.0 / 15.0, 0.0}));
  EXPECT_EQ(result.chi4, (std::vector<double>{1.0 / 15.0, 0.0}));
}

TEST(CountPixels, MapWithoutMaterialHasZeroFunctionals) {
  const double thresholds[] = {-infinity, 0.0};
  const PixelCounts counts = count_whole(drawn({"oo", "oo"}, true), thresholds);
  EXPECT_EQ(counts.pixels, 0);
  EXPECT_EQ(counts.E, (std::vector<std::int64_t>{0, 0}));
  EXPECT_EQ(functionals(counts).A, (std::vector<double>{0.0, 0.0}));
  EXPECT_EQ(functionals(counts).chi, (std::vector<double>{0.0, 0.0}));
}

TEST(CountPixels, NotANumberIsBlackAndStillMaterial) {
  Image image = drawn({"###"}, false);
  image.values = {NAN, 1.0, -infinity};
  const double thresholds[] = {-infinity, 0.5, infinity};
  const PixelCounts counts = count_whole(image, thresholds);
  EXPECT_EQ(counts.pixels, 3);
  EXPECT_EQ(counts.F, (std::vector<std::int64_t>{2, 1, 0}));
  EXPECT_EQ(counts.B_int, (std::vector<std::int64_t>{1, 2, 0}));
}

std::string message_of(const PixelBlock& block, std::span<const double> thresholds) {
  try {
    count_pixels(block, thresholds);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(CountPixels, RefusesThresholdsAndShapesThatDoNotFit) {
  const Image image = drawn({"##"}, false);
  const auto stored = cut<PixelBlock>(image, 0, 1);
  const double descending[] = {1.0, 0.5};
  EXPECT_EQ(message_of(stored.block, descending),
            "threshold 2 of 2 is 0.500000, below the one before it, 1.000000. Thresholds ascend; "
            "equal and infinite ones are allowed. Sort the list.");
  const double invalid[] = {NAN};
  EXPECT_EQ(message_of(stored.block, invalid),
            "threshold 1 of 1 is nan, not a number. Thresholds ascend; equal and infinite ones are "
            "allowed. Sort the list.");
  PixelBlock block = stored.block;
  block.rows = 2;
  EXPECT_EQ(
      message_of(block, {}),
      "a pixel block of 2 rows of 2 pixels needs 6 values and mask entries, one row more than "
      "it owns, and at least one pixel a row; it has 4 values and 4 mask entries.");
}

TEST(CountPixels, AddRefusesOtherThresholds) {
  const Image image = drawn({"##"}, false);
  const double one[] = {0.5};
  const double two[] = {0.5, 0.6};
  PixelCounts total = count_whole(image, one);
  EXPECT_THROW(add(count_whole(image, two), total), InputError);
}

}  // namespace
