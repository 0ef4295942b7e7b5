// The strain of one step: rotations are exact, stretches logarithmic, the frame that of the end.

#include "poreshock/material/strain.hpp"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <Eigen/Geometry>
#include <cmath>

namespace {

using namespace poreshock;
using Matrix3 = Eigen::Matrix3d;

std::array<double, 9> numbers(const Matrix3& m) {
  std::array<double, 9> a;
  for (int k = 0; k < 9; ++k) a[k] = m(k / 3, k % 3);
  return a;
}

/// The plane part, for a matrix that leaves z alone.
std::array<double, 4> plane_numbers(const Matrix3& m) {
  return {m(0, 0), m(0, 1), m(1, 0), m(1, 1)};
}

Matrix3 symmetric(const SymmetricTensor<3>& a) {
  Matrix3 m;
  m << a[0], a[3], a[5], a[3], a[1], a[4], a[5], a[4], a[2];
  return m;
}

Matrix3 symmetric(const SymmetricTensor<2>& a) {
  return symmetric(SymmetricTensor<3>{a[0], a[1], a[2], a[3], 0.0, 0.0});
}

Matrix3 full(const std::array<double, 9>& a) {
  return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(a.data());
}

Matrix3 full(const std::array<double, 4>& a) {
  return full(std::array<double, 9>{a[0], a[1], 0.0, a[2], a[3], 0.0, 0.0, 0.0, 1.0});
}

double distance(const Matrix3& a, const Matrix3& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

/// Deviator of ln of a positive symmetric matrix.
Matrix3 logarithm_deviator(const Matrix3& stretch) {
  const Eigen::SelfAdjointEigenSolver<Matrix3> solver(stretch);
  const Eigen::Vector3d log = solver.eigenvalues().array().log();
  const Matrix3 all = solver.eigenvectors() * log.asDiagonal() * solver.eigenvectors().transpose();
  return all - all.trace() / 3.0 * Matrix3::Identity();
}

Matrix3 turn(double angle, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

const Eigen::Vector3d z_axis(0, 0, 1);

/// Symmetric stretch with the principal stretches ratio, 1 and ratio^third, turned in space.
Matrix3 stretch(double ratio, double third, const Matrix3& frame) {
  const Eigen::Vector3d principal(ratio, 1.0, std::pow(ratio, third));
  return frame * principal.asDiagonal() * frame.transpose();
}

TEST(DeformationIncrement, NothingHappens) {
  const auto a = deformation_increment(std::array<double, 4>{1, 0, 0, 1});
  EXPECT_EQ(a.volume_ratio, 1.0);
  EXPECT_EQ(a.rotation, (std::array<double, 4>{1, 0, 0, 1}));
  for (const double x : a.strain_deviator) EXPECT_EQ(x, 0.0);
  const auto b = deformation_increment(std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1});
  EXPECT_EQ(b.volume_ratio, 1.0);
  EXPECT_EQ(b.rotation, (std::array<double, 9>{1, 0, 0, 0, 1, 0, 0, 0, 1}));
  for (const double x : b.strain_deviator) EXPECT_EQ(x, 0.0);
}

TEST(DeformationIncrement, RotationOfAnyAngleStrainsNothing) {
  for (double degrees = -89.0; degrees < 90.0; degrees += 7.3) {
    const double angle = degrees * std::acos(-1.0) / 180.0;
    const auto a = deformation_increment(plane_numbers(turn(angle, z_axis)));
    EXPECT_NEAR(a.volume_ratio, 1.0, 1e-15);
    for (const double x : a.strain_deviator) EXPECT_NEAR(x, 0.0, 1e-15);
    EXPECT_LT(distance(full(a.rotation), turn(angle, z_axis)), 1e-15) << degrees;
    for (const Eigen::Vector3d& axis :
         {z_axis, Eigen::Vector3d(1, 2, -0.5), Eigen::Vector3d(-3, 0.1, 1)}) {
      const Matrix3 R = turn(angle, axis);
      const auto b = deformation_increment(numbers(R));
      EXPECT_NEAR(b.volume_ratio, 1.0, 2e-15);
      for (const double x : b.strain_deviator) EXPECT_NEAR(x, 0.0, 1e-15) << degrees;
      EXPECT_LT(distance(full(b.rotation), R), 1e-15) << degrees;
    }
  }
}

template <class Increment>
void check_stretch(const Increment& a, const Matrix3& V, const Matrix3& R, double relative) {
  const Matrix3 expected = logarithm_deviator(V);
  const double size = expected.cwiseAbs().maxCoeff();
  EXPECT_LT(distance(symmetric(a.strain_deviator), expected), relative * size);
  EXPECT_LT(distance(full(a.rotation), R), 1e-14);
  EXPECT_NEAR(a.volume_ratio, (V * R).determinant(), 1e-14);
  EXPECT_NEAR((a.strain_deviator[0] + a.strain_deviator[1]) + a.strain_deviator[2], 0.0, 1e-16);
}

// dF = V R: the strain is ln V, the left one, in the frame at the end of the step.
TEST(DeformationIncrement, StretchGivesTheLogarithm) {
  for (const auto& [size, relative] : {std::pair{0.2, 1e-6}, std::pair{0.01, 1e-12}}) {
    for (const double ratio : {1.0 + size, 1.0 / (1.0 + size)}) {
      for (const double angle : {0.0, 0.3, -1.2}) {
        for (const double direction : {0.0, 0.7, 2.0}) {
          const Matrix3 V = stretch(ratio, 0.0, turn(direction, z_axis));
          const Matrix3 R = turn(angle, z_axis);
          check_stretch(deformation_increment(plane_numbers(V * R)), V, R, relative);
          const Eigen::Vector3d axis(0.4, -1.0, direction);
          const Matrix3 W = stretch(ratio, 0.3, turn(direction + 0.5, axis));
          const Matrix3 Q = turn(angle, axis + z_axis);
          check_stretch(deformation_increment(numbers(W * Q)), W, Q, relative);
        }
      }
    }
  }
}

// Pure compression has no deviator in 3-D; in plane strain a third of it lies out of the plane.
TEST(DeformationIncrement, EqualStretches) {
  const double f = std::exp(-0.01);
  const auto b = deformation_increment(std::array<double, 9>{f, 0, 0, 0, f, 0, 0, 0, f});
  EXPECT_NEAR(b.volume_ratio, std::exp(-0.03), 1e-15);
  for (const double x : b.strain_deviator) EXPECT_NEAR(x, 0.0, 1e-16);
  const auto a = deformation_increment(std::array<double, 4>{f, 0, 0, f});
  EXPECT_NEAR(a.strain_deviator[2], 0.02 / 3.0, 1e-14);
  EXPECT_NEAR(a.strain_deviator[0], -0.01 / 3.0, 1e-14);
  EXPECT_EQ(a.strain_deviator[0], a.strain_deviator[1]);
  EXPECT_EQ(a.strain_deviator[3], 0.0);
}

// Uniaxial compression in steps adds up to the logarithm of the whole.
TEST(DeformationIncrement, UniaxialStepsAddUp) {
  double sum = 0.0, ratio = 1.0;
  double length = 1.0;
  for (int i = 0; i < 100; ++i) {
    const double next = length - 0.002;
    const auto a = deformation_increment(std::array<double, 4>{1, 0, 0, next / length});
    sum += a.strain_deviator[1];
    ratio *= a.volume_ratio;
    length = next;
  }
  EXPECT_NEAR(ratio, 0.8, 1e-14);
  EXPECT_NEAR(sum, 2.0 / 3.0 * std::log(0.8), 1e-14);
}

TEST(DeformationIncrement, PlaneStrainIsThreeDimensionsWithUnitThirdStretch) {
  for (const auto& [size, tolerance] : {std::pair{0.2, 1e-6}, std::pair{0.01, 1e-12}}) {
    const std::array<double, 4> F = {1 + size, 0.3 * size, -0.2 * size, 1.0};
    const auto a = deformation_increment(F);
    const auto b = deformation_increment(
        std::array<double, 9>{F[0], F[1], 0.0, F[2], F[3], 0.0, 0.0, 0.0, 1.0});
    EXPECT_NEAR(a.volume_ratio, b.volume_ratio, 1e-15);
    for (int c = 0; c < 4; ++c) {
      EXPECT_NEAR(a.strain_deviator[c], b.strain_deviator[c], tolerance * size);
    }
    EXPECT_NEAR(b.strain_deviator[4], 0.0, 1e-17);
    EXPECT_NEAR(b.strain_deviator[5], 0.0, 1e-17);
    EXPECT_LT(distance(full(a.rotation), full(b.rotation)), 1e-15);
  }
}

// To first order the strain is the symmetric part of the velocity gradient times dt.
TEST(DeformationIncrement, SmallGradient) {
  const double h = 1e-7;
  Matrix3 L;
  L << 0.3, -1.0, 0.4, 0.8, -0.5, 0.2, -0.1, 0.9, 0.6;
  const auto a = deformation_increment(numbers(Matrix3::Identity() + h * L));
  const Matrix3 D = 0.5 * (L + L.transpose());
  const Matrix3 expected = h * (D - D.trace() / 3.0 * Matrix3::Identity());
  EXPECT_LT(distance(symmetric(a.strain_deviator), expected), 3 * h * h);
  EXPECT_LT(distance(full(a.rotation), Matrix3::Identity() + 0.5 * h * (L - L.transpose())),
            3 * h * h);
}

TEST(Rotate, IsRaRT) {
  const Matrix3 R = turn(0.8, {1, -2, 0.5});
  const SymmetricTensor<3> a = {1.0, -2.5, 0.7, 0.3, -1.1, 2.2};
  EXPECT_LT(distance(symmetric(rotate(numbers(R), a)), R * symmetric(a) * R.transpose()), 2e-15);
  const Matrix3 Q = turn(-1.3, z_axis);
  const SymmetricTensor<2> b = {1.0, -2.5, 0.7, 0.3};
  EXPECT_LT(distance(symmetric(rotate(plane_numbers(Q), b)), Q * symmetric(b) * Q.transpose()),
            2e-15);
  EXPECT_EQ(rotate(plane_numbers(Q), b)[2], b[2]);
}

}  // namespace
