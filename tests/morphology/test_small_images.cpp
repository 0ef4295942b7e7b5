// Every small image: the Euler characteristic against domains found by flood fill, and the sums
// over all images against polynomials that are exact.

#include <gtest/gtest.h>

#include <bit>

#include "support/images.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::reference;

constexpr double threshold[] = {0.5};

struct Shape {
  int width, height;
};

constexpr Shape shapes[] = {{1, 1}, {1, 6}, {2, 5}, {3, 4}, {4, 3}, {5, 2}, {6, 1}, {2, 2}, {3, 3}};

/// Window in a black plane: chi = white domains - black domains inside. Cylinder: one less when a
/// white domain winds around it. Both for 8/4 and for 4/8 neighbours (Alexander duality).
TEST(SmallImages, EulerCharacteristicCountsDomains) {
  for (const Shape& shape : shapes) {
    const int pixels = shape.width * shape.height;
    for (const bool periodic : {false, true}) {
      for (std::uint64_t bits = 0; bits < std::uint64_t{1} << pixels; ++bits) {
        const Image image = image_of_bits(bits, {shape.width, 1, shape.height}, {periodic, false});
        const PixelCounts c = count_whole(image, threshold);
        const Domains corners = label_domains(image, 0.5, true);
        const Domains sides = label_domains(image, 0.5, false);
        ASSERT_EQ(c.V[0] - c.E[0] + c.F[0],
                  corners.white - corners.black_inside - (corners.winds ? 1 : 0))
            << shape.width << " x " << shape.height << " image " << bits << " " << periodic;
        ASSERT_EQ(c.E[0] - 3 * c.F[0] + c.V4[0],
                  sides.white - sides.black_inside - (sides.winds ? 1 : 0))
            << shape.width << " x " << shape.height << " image " << bits << " " << periodic;
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

/// Images of n pixels, m of them white, in which a given group of g pixels has a white one.
std::int64_t with_one_of(int n, int m, int g) {
  return choose(n, m) - choose(n - g, m);
}
/// ... in which all pixels of the group are white.
std::int64_t with_all_of(int n, int m, int g) {
  return choose(n - g, m - g);
}

/// Groups of pixels by size: how many cells of a kind are shared by 1, 2 and 4 pixels.
struct Groups {
  int one, two, four;
};

std::int64_t expected_any(const Groups& groups, int n, int m) {
  return groups.one * with_one_of(n, m, 1) + groups.two * with_one_of(n, m, 2) +
         groups.four * with_one_of(n, m, 4);
}

/// Summed over all images with m white pixels, a cell shared by g pixels is white in
/// C(n, m) - C(n - g, m) of them. Equality for every m is the identity of polynomials in the
/// probability p of white: F = p, E = 1 - q^2, V = 1 - q^4, V4 = p^4 per cell.
TEST(SmallImages, SumsOverAllImagesAreTheExactPolynomials) {
  constexpr int width = 4;
  constexpr int height = 3;
  constexpr int n = width * height;
  for (const bool periodic : {false, true}) {
    std::vector<PixelCounts> sums(n + 1);
    for (std::uint64_t bits = 0; bits < std::uint64_t{1} << n; ++bits) {
      const Image image = image_of_bits(bits, {width, 1, height}, {periodic, false});
      add(count_whole(image, threshold), sums[static_cast<std::size_t>(std::popcount(bits))]);
    }
    // On the cylinder: 12 + 8 inner edges and 8 on the frame; 8 inner vertices, 8 on the frame.
    // In the window: 9 + 8 inner edges, 14 on the frame; 6 inner vertices, 10 on the frame, 4
    // corners. A vertex on the frame has two diagonals of one pixel of the map each.
    const Groups edges = periodic ? Groups{8, 20, 0} : Groups{14, 17, 0};
    const Groups vertices = periodic ? Groups{0, 8, 8} : Groups{4, 10, 6};
    const Groups diagonals = periodic ? Groups{16, 16, 0} : Groups{24, 12, 0};
    for (int m = 0; m <= n; ++m) {
      const PixelCounts& c = sums[static_cast<std::size_t>(m)];
      EXPECT_EQ(c.F[0], n * with_one_of(n, m, 1));
      EXPECT_EQ(c.E[0], expected_any(edges, n, m));
      EXPECT_EQ(c.V[0], expected_any(vertices, n, m));
      EXPECT_EQ(c.D[0], expected_any(diagonals, n, m));
      EXPECT_EQ(c.V4[0], vertices.four * with_all_of(n, m, 4));
      EXPECT_EQ(c.B_frame[0], edges.one * with_one_of(n, m, 1));
      EXPECT_EQ(c.B_int[0], edges.two * 2 * choose(n - 2, m - 1));
      EXPECT_EQ(c.B_void[0], 0);
    }
  }
}

/// The same in 3-D for all images of 2 x 2 x 3 voxels in a window.
TEST(SmallImages, SumsOverAllVoxelImagesAreTheExactPolynomials) {
  constexpr int n = 12;
  std::vector<VoxelCounts> sums(n + 1);
  for (std::uint64_t bits = 0; bits < std::uint64_t{1} << n; ++bits) {
    const Image image = image_of_bits(bits, {2, 2, 3}, {false, false});
    add(count_whole_voxels(image, threshold), sums[static_cast<std::size_t>(std::popcount(bits))]);
  }
  for (int m = 0; m <= n; ++m) {
    const VoxelCounts& c = sums[static_cast<std::size_t>(m)];
    const auto one_of = [&](int group) { return with_one_of(n, m, group); };
    // Faces: 6 + 6 + 8 inside, 2 (6 + 6 + 4) on the frame.
    // Lines along z, three edges long: 1 inside, 4 on a side of the frame, 4 at its corners. Lines
    // along x and along y, two edges long: 2 inside, 6 on a side, 4 at corners, for each.
    // The 3 x 3 x 4 vertices: 2 inside, 10 on a side, 16 on an edge, 8 at the corners of the frame.
    EXPECT_EQ(c.C[0], n * one_of(1));
    EXPECT_EQ(c.F[0], 32 * one_of(1) + 20 * one_of(2));
    EXPECT_EQ(c.E[0], (3 * 4 + 4 * 4) * one_of(1) + (3 * 4 + 4 * 6) * one_of(2) +
                          (3 * 1 + 4 * 2) * one_of(4));
    EXPECT_EQ(c.V[0], 8 * one_of(1) + 16 * one_of(2) + 10 * one_of(4) + 2 * one_of(8));
    EXPECT_EQ(c.E4[0], 11 * with_all_of(n, m, 4));
    EXPECT_EQ(c.V8[0], 2 * with_all_of(n, m, 8));
    EXPECT_EQ(c.S_int[0], 20 * 2 * choose(n - 2, m - 1));
    EXPECT_EQ(c.S_frame[0], 32 * one_of(1));
  }
}

}  // namespace
