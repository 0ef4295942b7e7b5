// Areas of interpolated surfaces, on any number of ranks.

#include "poreshock/morphology/isosurface.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "support/domain_reference.hpp"
#include "support/images.hpp"
#include "support/plain_isosurface.hpp"

namespace {

using namespace poreshock;
using namespace poreshock::reference;

const MPI_Comm world = MPI_COMM_WORLD;

/// An image of a function of the voxel centres, all material.
template <class Function>
Image image_of(std::array<int, 3> size, std::array<bool, 2> periodic, Function f) {
  Image image = blank_image(size, periodic);
  for (int z = 0; z < size[2]; ++z) {
    for (int y = 0; y < size[1]; ++y) {
      for (int x = 0; x < size[0]; ++x) image.values.push_back(f(x, y, z));
    }
  }
  image.solid.assign(image.size(), 1);
  return image;
}

std::vector<double> areas(const Image& image, std::span<const double> thresholds) {
  return isosurface_areas(deal_out<3>(image, rank(world), size(world)), 0, thresholds, world);
}

/// Each cube is rounded to 2^-30; most cubes hold nothing.
double rounding(const Image& image) {
  return std::ldexp(static_cast<double>(image.size()), -31);
}

TEST(Isosurface, PlaneFrontsAreExactInAnyDirection) {
  const int n = 14;
  // Normals with a largest component along z, so that a plane through the middle of the cube of
  // centres leaves it through its sides only: its area is that of the base over the cosine.
  for (const std::array<double, 3>& normal : {std::array<double, 3>{0.0, 0.0, 1.0},
                                              {0.3, 0.0, 1.0},
                                              {0.0, -0.7, 1.0},
                                              {0.4, 0.5, 1.0},
                                              {-0.45, 0.5, 1.0},
                                              {0.45, -0.5, 1.0},
                                              {-0.1, -0.8, 1.0}}) {
    for (const double sign : {1.0, -1.0}) {
      for (const int along : {0, 1, 2}) {
        const auto f = [&](int x, int y, int z) {
          const std::array<int, 3> at = {x, y, z};
          double value = 0.0;
          for (int axis = 0; axis < 3; ++axis) value += normal[(axis + along) % 3] * at[axis];
          return sign * value;
        };
        const Image image = image_of({n, n, n}, {false, false}, f);
        const double middle = 0.5 * (n - 1) * (normal[0] + normal[1] + normal[2]);
        const double threshold[] = {sign * (middle + 0.0625)};
        const double length = std::hypot(normal[0], normal[1], normal[2]);
        EXPECT_NEAR(areas(image, threshold)[0], (n - 1) * (n - 1) * length, rounding(image));
      }
    }
  }
}

TEST(Isosurface, TriangleAcrossACornerAndPeriodicSides) {
  // x + y + z = t cuts a triangle of side sqrt(2) t off the corner, and a hexagon in the middle.
  const Image corner =
      image_of({9, 9, 9}, {false, false}, [](int x, int y, int z) { return x + y + z; });
  const double thresholds[] = {2.5, 12.0};
  const auto found = areas(corner, thresholds);
  EXPECT_NEAR(found[0], std::sqrt(3.0) / 2.0 * 2.5 * 2.5, rounding(corner));
  EXPECT_NEAR(found[1], std::sqrt(3.0) / 2.0 * (12.0 * 12.0 - 3.0 * 4.0 * 4.0), rounding(corner));
  for (const std::array<bool, 2>& periodic :
       {std::array<bool, 2>{false, false}, {true, false}, {false, true}, {true, true}}) {
    const Image band = image_of({6, 4, 7}, periodic, [](int, int, int z) { return z; });
    const double levels[] = {2.5, 5.0, 20.0};
    const double face = (periodic[0] ? 6.0 : 5.0) * (periodic[1] ? 4.0 : 3.0);
    EXPECT_EQ(areas(band, levels), (std::vector<double>{face, face, 0.0}));
  }
}

TEST(Isosurface, SpheresConvergeWithTheSquareOfTheVoxel) {
  const auto error = [](int n) {
    // The same ball of 0.37 of the side, its centre off the voxels.
    const double radius = 0.37 * n;
    const auto f = [&](int x, int y, int z) {
      return -std::hypot(x + 0.5 - 0.503 * n, y + 0.5 - 0.489 * n, z + 0.5 - 0.497 * n);
    };
    const double threshold[] = {-radius};
    const double found = areas(image_of({n, n, n}, {false, false}, f), threshold)[0];
    return found / (4.0 * std::numbers::pi * radius * radius) - 1.0;
  };
  const double coarse = error(16), fine = error(32);
  EXPECT_LT(std::abs(coarse), 8e-3);
  EXPECT_NEAR(coarse / fine, 4.0, 0.25);
}

TEST(Isosurface, IsThePlainOneAndTheSameOnAnyRanks) {
  Random random{5};
  const std::vector<double> thresholds = {0.1, 0.35, 0.5, 0.5, 0.8};
  for (int n = 0; n < 6; ++n) {
    const Texture texture = n % 3 == 0   ? Texture::noise
                            : n % 3 == 1 ? Texture::smooth
                                         : Texture::ties;
    const Image image = random_image(texture, {7, 6, 9}, {n < 3, n % 2 == 0}, 0.05, random);
    const auto found = areas(image, thresholds);
    EXPECT_EQ(found, isosurface_areas(deal_out<3>(image, 0, 1), 0, thresholds, MPI_COMM_SELF));
    for (std::size_t k = 0; k < thresholds.size(); ++k) {
      // Heron's formula loses half of the digits of a thin triangle.
      EXPECT_NEAR(found[k], plain_isosurface(image, thresholds[k]), 1e-6) << k;
    }
  }
}

TEST(Isosurface, VoidsCutHolesAndValuesWithoutAPlaceCountHalfWay) {
  Image band = image_of({5, 5, 6}, {false, false}, [](int, int, int z) { return z; });
  band.solid[static_cast<std::size_t>(index_of(band, 2, 2, 3))] = 0;
  const double threshold[] = {2.5};
  EXPECT_EQ(areas(band, threshold), (std::vector<double>{12.0}));
  const double infinity = std::numeric_limits<double>::infinity();
  const Image front = image_of({5, 5, 6}, {false, false},
                               [&](int, int, int z) { return z < 3 ? -infinity : infinity; });
  EXPECT_EQ(areas(front, threshold), (std::vector<double>{16.0}));
  const double falling[] = {2.0, 1.0};
  EXPECT_THROW(areas(band, falling), InputError);
}

}  // namespace
