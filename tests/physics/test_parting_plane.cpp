// Normals of the planes that part particles: what is exact, what bounds them, and against
// gradients.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <vector>

#include "poreshock/physics/parting_plane.hpp"
#include "poreshock/scene/transfer_scheme.hpp"
#include "support/random_numbers.hpp"

namespace {

using namespace poreshock;

constexpr double degree = std::numbers::pi / 180.0;

double angle(const Vector<2>& a, const Vector<2>& b) {
  return std::abs(std::atan2(a[0] * b[1] - a[1] * b[0], a.dot(b)));
}

Vector<2> direction(double phi) {
  return {std::cos(phi), std::sin(phi)};
}

/// Particles of a lattice turned by phi that a node at the origin sees with a cubic spline; the
/// plane through `place` across direction(phi) lies midway between two of its rows and parts 0 from
/// 1.
std::vector<NodePoint<2>> parted_lattice(int per_cell, double phi, const Vector<2>& place) {
  std::vector<NodePoint<2>> points;
  const double spacing = 1.0 / per_cell;
  const Vector<2> normal = direction(phi), along(-normal[1], normal[0]);
  for (int i = -4 * per_cell; i < 4 * per_cell; ++i) {
    for (int j = -4 * per_cell; j < 4 * per_cell; ++j) {
      const Vector<2> x = place + normal * ((i + 0.5) * spacing) + along * ((j + 0.5) * spacing);
      if (std::abs(x[0]) >= 2.0 || std::abs(x[1]) >= 2.0) continue;
      points.push_back({x, spacing * spacing, i < 0 ? 0 : 1});
    }
  }
  return points;
}

// Points of one grain that are the mirror images of those of the other: the normal is that of the
// mirror, to rounding, at any angle.
TEST(PartingNormal, IsExactForMirrorImages) {
  reference::Random random{1};
  for (int n = 0; n < 200; ++n) {
    const Vector<2> normal = direction(2.0 * std::numbers::pi * random.uniform());
    std::vector<NodePoint<2>> points;
    for (int k = 0; k < 3 + n % 20; ++k) {
      const Vector<2> x(4.0 * random.uniform() - 2.0, 4.0 * random.uniform() - 2.0);
      const double beyond = x.dot(normal) - 0.3;
      const Vector<2> image = x - normal * (2.0 * beyond);
      points.push_back({beyond < 0.0 ? x : image, 0.25, 3});
      points.push_back({beyond < 0.0 ? image : x, 0.25, 5});
    }
    EXPECT_LE(angle(parting_normal<2>(points, 3, 5), normal), 1e-11);
    EXPECT_LE(angle(parting_normal<2>(points, 5, 3), -normal), 1e-11);
  }
}

// A straight face at any angle and place. What parts the particles is a plane that may turn until
// it meets the rows next to the face: by the spacing over what a stencil sees of them.
TEST(PartingNormal, OfAStraightFacePartsItsRows) {
  reference::Random random{2};
  for (const int per_cell : {2, 4, 8}) {
    const double spacing = 1.0 / per_cell;
    const double bound = std::atan(spacing / (4.0 - spacing));
    for (int n = 0; n < 180; ++n) {
      const double phi = n * 2.0 * degree;
      const Vector<2> place = direction(phi) * (1.4 * random.uniform() - 0.7) +
                              direction(phi + 90.0 * degree) * (spacing * random.uniform());
      const auto points = parted_lattice(per_cell, phi, place);
      EXPECT_LE(angle(parting_normal<2>(points, 0, 1), direction(phi)), bound)
          << phi / degree << " degrees, " << per_cell << " per cell";
    }
  }
}

TEST(PartingNormal, NeedsPointsOfBoth) {
  std::vector<NodePoint<2>> points = {{{0.5, 0.0}, 0.25, 0}, {{0.2, 0.3}, 0.25, 0}};
  EXPECT_EQ(parting_normal<2>(points, 0, 1), (Vector<2>::Zero()));
  points.push_back({{-0.5, 0.0}, 0.25, 1});
  EXPECT_GT(parting_normal<2>(points, 1, 0)[0], 0.9);
  points = {{{0.5, 0.0}, 0.25, 0}, {{0.5, 0.0}, 0.25, 1}};  // in the same place
  EXPECT_EQ(parting_normal<2>(points, 0, 1), (Vector<2>::Zero()));
}

TEST(PartingNormal, InThreeDimensions) {
  reference::Random random{3};
  Vector<3> normal(1.0, -2.0, 0.5);
  normal /= normal.norm();
  std::vector<NodePoint<3>> points;
  for (int k = 0; k < 40; ++k) {
    const Vector<3> x(4.0 * random.uniform() - 2.0, 4.0 * random.uniform() - 2.0,
                      4.0 * random.uniform() - 2.0);
    const Vector<3> image = x - normal * (2.0 * x.dot(normal));
    points.push_back({x, 0.125, x.dot(normal) < 0.0 ? 0 : 1});
    points.push_back({image, 0.125, x.dot(normal) < 0.0 ? 1 : 0});
  }
  EXPECT_LE((parting_normal<3>(points, 0, 1) - normal).norm(), 1e-11);
}

/// Root of the mean squared error of normals, weighted by the reduced volume, for two touching
/// discs of radius R cells: from gradients as contact has them, and from the plane.
struct Errors {
  double gradients = 0.0, plane = 0.0;
};

Errors disc_errors(double radius, std::uint64_t seed) {
  reference::Random random{seed};
  double sums[3] = {};
  for (int n = 0; n < 20; ++n) {
    const Vector<2> centres = direction(0.5 * std::numbers::pi * random.uniform());
    const Vector<2> touch(random.uniform() - 0.5, random.uniform() - 0.5);
    for (int i = -4; i <= 4; ++i) {
      for (int j = -4; j <= 4; ++j) {
        std::vector<NodePoint<2>> points;
        Vector<2> gradient[2] = {Vector<2>::Zero(), Vector<2>::Zero()};
        double volume[2] = {};
        // Lattice of two particles per cell and direction, as samples have it.
        for (int k = 2 * i - 4; k < 2 * i + 4; ++k) {
          for (int l = 2 * j - 4; l < 2 * j + 4; ++l) {
            const Vector<2> x(0.5 * k + 0.25, 0.5 * l + 0.25);
            int side = -1;
            if ((x - touch + centres * radius).norm() < radius) side = 0;
            if ((x - touch - centres * radius).norm() < radius) side = 1;
            const Vector<2> offset = x - Vector<2>(i, j);
            if (side < 0 || std::abs(offset[0]) >= 2.0 || std::abs(offset[1]) >= 2.0) continue;
            const Transfer cubic{.shape = ShapeFunction::cubic};
            with_shape(cubic, [&]<class Shape>(const Shape& shape) {
              double value[2], slope[2];
              for (int a = 0; a < 2; ++a) {
                const double s = 10.0 + offset[a];  // of the particle; node 11 lies at s = 10
                const auto weights = axis_weights(shape, s, stencil_base(Shape::width, s));
                value[a] = weights.value[11 - stencil_base(Shape::width, s)];
                slope[a] = weights.slope[11 - stencil_base(Shape::width, s)];
              }
              volume[side] += 0.25 * value[0] * value[1];
              gradient[side] += 0.25 * Vector<2>(slope[0] * value[1], value[0] * slope[1]);
            });
            points.push_back({offset, 0.25, side});
          }
        }
        if (!(volume[0] > 0.0) || !(volume[1] > 0.0)) continue;
        const double weight = volume[0] * volume[1] / (volume[0] + volume[1]);
        const Vector<2> steep =
            gradient[0] * gradient[0].squaredNorm() - gradient[1] * gradient[1].squaredNorm();
        const double errors[2] = {angle(steep, centres),
                                  angle(parting_normal<2>(points, 0, 1), centres)};
        sums[0] += weight;
        for (int m = 0; m < 2; ++m) sums[1 + m] += weight * errors[m] * errors[m];
      }
    }
  }
  return {std::sqrt(sums[1] / sums[0]) / degree, std::sqrt(sums[2] / sums[0]) / degree};
}

// Two discs on a lattice: the planes are nearer to the truth at every size.
TEST(PartingNormal, OfDiscsIsBetterThanThatOfGradients) {
  for (const double radius : {4.0, 8.0, 16.0, 32.0}) {
    const Errors errors = disc_errors(radius, 7);
    std::printf("discs of %g cells across: gradients %.2f, planes %.2f degrees\n", 2.0 * radius,
                errors.gradients, errors.plane);
    EXPECT_LT(errors.plane, 0.6 * errors.gradients) << radius;
  }
}

}  // namespace
