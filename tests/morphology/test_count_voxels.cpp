// Counts of voxel maps: single objects, one pass against thresholding, layers against the whole.

#include <gtest/gtest.h>

#include "poreshock/core/error.hpp"
#include "support/images.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::reference;

constexpr double threshold[] = {0.5};

Image black_box(std::array<int, 3> size, std::array<bool, 2> periodic) {
  return image_of_bits(0, size, periodic);
}

void paint(Image& image, int x, int y, int z) {
  image.values[static_cast<std::size_t>(index_of(image, x, y, z))] = 1.0;
}

struct Expected {
  std::int64_t C, F, E, V, surface, breadth, chi26, chi6;
};

void expect_counts(const Image& image, const Expected& expected) {
  const VoxelCounts c = count_whole_voxels(image, threshold);
  EXPECT_EQ(c.C[0], expected.C);
  EXPECT_EQ(c.F[0], expected.F);
  EXPECT_EQ(c.E[0], expected.E);
  EXPECT_EQ(c.V[0], expected.V);
  EXPECT_EQ(2 * c.F[0] - 6 * c.C[0], expected.surface);
  EXPECT_EQ(c.S_int[0] + c.S_void[0] + c.S_frame[0], expected.surface);
  EXPECT_EQ(3 * c.C[0] - 2 * c.F[0] + c.E[0], expected.breadth);
  EXPECT_EQ(c.F[0] - c.C[0] - c.E[0] + c.V[0], expected.chi26);
  EXPECT_EQ(c.F[0] - 5 * c.C[0] + c.E4[0] - c.V8[0], expected.chi6);
}

TEST(CountVoxels, SingleObjects) {
  Image cube = black_box({4, 4, 4}, {false, false});
  paint(cube, 1, 2, 1);
  expect_counts(cube, {1, 6, 12, 8, 6, 3, 1, 1});

  Image corner_of_map = black_box({3, 3, 3}, {false, false});
  paint(corner_of_map, 2, 2, 2);
  expect_counts(corner_of_map, {1, 6, 12, 8, 6, 3, 1, 1});
  EXPECT_EQ(count_whole_voxels(corner_of_map, threshold).S_frame[0], 3);

  Image sharing_a_face = cube;
  paint(sharing_a_face, 2, 2, 1);
  expect_counts(sharing_a_face, {2, 11, 20, 12, 10, 4, 1, 1});

  // One domain with 26 neighbours, two with 6.
  Image sharing_an_edge = cube;
  paint(sharing_an_edge, 2, 2, 2);
  expect_counts(sharing_an_edge, {2, 12, 23, 14, 12, 5, 1, 2});

  Image sharing_a_corner = cube;
  paint(sharing_a_corner, 2, 1, 2);
  expect_counts(sharing_a_corner, {2, 12, 24, 15, 12, 6, 1, 2});
}

TEST(CountVoxels, BoxHasItsIntrinsicVolumes) {
  Image box = black_box({6, 6, 7}, {false, false});
  for (int z = 2; z < 6; ++z) {
    for (int y = 1; y < 4; ++y) {
      for (int x = 1; x < 3; ++x) paint(box, x, y, z);
    }
  }
  const VoxelCounts c = count_whole_voxels(box, threshold);
  const Minkowski3 result = functionals(c);
  EXPECT_EQ(c.pixels, 252);
  EXPECT_EQ(result.V[0], 24.0 / 252.0);
  EXPECT_EQ(result.S[0], 2.0 * (2 * 3 + 3 * 4 + 4 * 2) / 252.0);
  EXPECT_EQ(result.M[0], (2.0 + 3.0 + 4.0) / 252.0);
  EXPECT_EQ(result.chi[0], 1.0 / 252.0);
  EXPECT_EQ(result.chi6[0], 1.0 / 252.0);
}

TEST(CountVoxels, ShellAndTorusesHaveTheirEulerCharacteristic) {
  Image shell = black_box({5, 5, 5}, {false, false});
  for (int z = 1; z < 4; ++z) {
    for (int y = 1; y < 4; ++y) {
      for (int x = 1; x < 4; ++x) {
        if (x != 2 || y != 2 || z != 2) paint(shell, x, y, z);
      }
    }
  }
  expect_counts(shell, {26, 108, 144, 64, 60, 6, 2, 2});

  // A bar around one periodic axis is a solid torus, a slab around both a thick torus.
  Image bar = black_box({3, 4, 4}, {true, true});
  for (int x = 0; x < 3; ++x) paint(bar, x, 1, 2);
  expect_counts(bar, {3, 15, 24, 12, 12, 3, 0, 0});

  Image slab = bar;
  for (int y = 0; y < 4; ++y) {
    for (int x = 0; x < 3; ++x) paint(slab, x, y, 2);
  }
  expect_counts(slab, {12, 48, 60, 24, 24, 0, 0, 0});
}

TEST(CountVoxels, OnePassEqualsThresholdingLevelByLevel) {
  Random random{21};
  const std::vector<double> thresholds = {0.0, 0.125, 0.25, 0.25, 0.5, 0.75, 1.0};
  for (int repeat = 0; repeat < 300; ++repeat) {
    const auto texture = static_cast<Texture>(repeat % 4);
    const std::array<bool, 2> periodic = {random.below(2) == 0, random.below(2) == 0};
    const int widest = repeat % 10 == 0 ? 70 : 6;
    const Image image =
        random_image(texture, {1 + random.below(widest), 1 + random.below(5), 1 + random.below(5)},
                     periodic, repeat % 3 == 0 ? 0.0 : 0.25, random);
    ASSERT_TRUE(count_whole_voxels(image, thresholds) == count_voxels_plainly(image, thresholds))
        << image.width << " x " << image.depth << " x " << image.height;
  }
}

TEST(CountVoxels, LayersOfEveryTilingAddUpToTheWhole) {
  Random random{22};
  const std::vector<double> thresholds = {0.2, 0.5, 0.8};
  for (int repeat = 0; repeat < 20; ++repeat) {
    const int height = 5;
    const Image image =
        random_image(Texture::noise, {1 + random.below(5), 1 + random.below(5), height},
                     {random.below(2) == 0, random.below(2) == 0}, 0.2, random);
    const VoxelCounts whole = count_whole_voxels(image, thresholds);
    for (int cuts = 0; cuts < 1 << (height - 1); ++cuts) {
      VoxelCounts total;
      int first = 0;
      for (int layer = 1; layer <= height; ++layer) {
        if (layer < height && ((cuts >> (layer - 1)) & 1) == 0) continue;
        const auto part = cut<VoxelBlock>(image, first, layer - first);
        add(count_voxels(part.block, thresholds), total);
        first = layer;
      }
      ASSERT_TRUE(total == whole) << "cuts " << cuts;
    }
  }
}

/// A map one voxel deep along a framed y is the pixel map with a lid and a floor: cells of the
/// pixels appear on both lids, and upright ones once.
TEST(CountVoxels, FlatMapFollowsFromItsPixelMap) {
  Random random{23};
  const Image image = random_image(Texture::noise, {9, 1, 8}, {true, false}, 0.2, random);
  const VoxelCounts voxels = count_whole_voxels(image, threshold);
  const PixelCounts pixels = count_whole(image, threshold);
  EXPECT_EQ(voxels.pixels, pixels.pixels);
  EXPECT_EQ(voxels.C[0], pixels.F[0]);
  EXPECT_EQ(voxels.F[0], 2 * pixels.F[0] + pixels.E[0]);
  EXPECT_EQ(voxels.E[0], 2 * pixels.E[0] + pixels.V[0]);
  EXPECT_EQ(voxels.V[0], 2 * pixels.V[0]);
  EXPECT_EQ(voxels.S_int[0], pixels.B_int[0]);
  EXPECT_EQ(voxels.S_void[0], pixels.B_void[0]);
  EXPECT_EQ(voxels.S_frame[0], pixels.B_frame[0] + 2 * pixels.F[0]);
}

TEST(CountVoxels, RefusesShapesThatDoNotFit) {
  const Image image = black_box({2, 3, 1}, {false, false});
  auto stored = cut<VoxelBlock>(image, 0, 1);
  stored.block.width = {2, 4};
  try {
    count_voxels(stored.block, threshold);
    FAIL() << "accepted";
  } catch (const InputError& error) {
    EXPECT_STREQ(error.what(),
                 "a voxel block of 1 layers of 2 x 4 voxels needs 16 values and mask entries, one "
                 "layer more than it owns, and at least one voxel a layer; it has 12 values and 12 "
                 "mask entries.");
  }
}

}  // namespace
