#pragma once
// Kinematics of one step from the incremental deformation gradient dF = I + dt grad v: volume
// ratio, rotation and logarithmic strain. Rational functions and square roots only, so that the
// bits do not depend on a mathematics library or on how a loop was vectorised.

#include <array>
#include <cmath>

#include "poreshock/core/tensor.hpp"

namespace poreshock {

/// dF = V R: det dF, R (row major) and the deviator of ln V, in the frame at the end of the step.
template <int Dim>
struct DeformationIncrement {
  double volume_ratio;
  std::array<double, Dim * Dim> rotation;
  SymmetricTensor<Dim> strain_deviator;
};

/// artanh(x/y)/x as a function of x^2 and y: Pade approximant, relative error 0.023 (x/y)^6.
inline double artanh_over(double x2, double y) {
  const double y2 = y * y;
  return (15.0 * y2 - 4.0 * x2) / (y * (15.0 * y2 - 9.0 * x2));
}

/// Inverse of a symmetric 3 x 3 matrix (xx yy zz xy yz zx).
inline SymmetricTensor<3> inverse(const SymmetricTensor<3>& a) {
  const double xx = a[1] * a[2] - a[4] * a[4];
  const double xy = a[4] * a[5] - a[3] * a[2];
  const double zx = a[3] * a[4] - a[1] * a[5];
  const double scale = 1.0 / ((a[0] * xx + a[3] * xy) + a[5] * zx);
  return {xx * scale, (a[0] * a[2] - a[5] * a[5]) * scale, (a[0] * a[1] - a[3] * a[3]) * scale,
          xy * scale, (a[3] * a[5] - a[0] * a[4]) * scale, zx * scale};
}

/// Product of two symmetric 3 x 3 matrices that commute (so that it is symmetric).
inline SymmetricTensor<3> commuting_product(const SymmetricTensor<3>& a,
                                            const SymmetricTensor<3>& b) {
  return {(a[0] * b[0] + a[3] * b[3]) + a[5] * b[5], (a[3] * b[3] + a[1] * b[1]) + a[4] * b[4],
          (a[5] * b[5] + a[4] * b[4]) + a[2] * b[2], (a[0] * b[3] + a[3] * b[1]) + a[5] * b[4],
          (a[3] * b[5] + a[1] * b[4]) + a[4] * b[2], (a[5] * b[0] + a[4] * b[3]) + a[2] * b[5]};
}

inline DeformationIncrement<2> deformation_increment(const std::array<double, 4>& F) {
  DeformationIncrement<2> result;
  const double J = F[0] * F[3] - F[1] * F[2];
  const double c = F[0] + F[3];
  const double s = F[2] - F[1];
  const double inverse_length = 1.0 / std::sqrt(c * c + s * s);
  result.rotation = {c * inverse_length, -s * inverse_length, s * inverse_length,
                     c * inverse_length};
  const double bxx = F[0] * F[0] + F[1] * F[1];
  const double byy = F[2] * F[2] + F[3] * F[3];
  const double bxy = F[0] * F[2] + F[1] * F[3];
  const double mean = 0.5 * (bxx + byy);
  const double half_difference = 0.5 * (bxx - byy);
  // ln of mean I + D with D traceless in the plane is (artanh(|D|/mean)/|D|) D plus a volume part.
  const double d2 = half_difference * half_difference + bxy * bxy;
  const double factor = 0.5 * artanh_over(d2, mean);
  const double third =
      2.0 / 3.0 * (J - 1.0) * artanh_over((J - 1.0) * (J - 1.0), J + 1.0);  // ln J/3
  const double plane = factor * half_difference;
  result.volume_ratio = J;
  result.strain_deviator = {0.5 * third + plane, 0.5 * third - plane, -third, factor * bxy};
  return result;
}

/// Rotation R of F = V R and det F: polar factor by Newton's iteration R <- (R + R^-T)/2 (Higham
/// 1986); five steps reach round-off for the stretches one time step may have.
inline std::array<double, 9> polar_rotation(const std::array<double, 9>& F, double& det) {
  std::array<double, 9> R = F;
  // Without a loop here one over particles vectorises.
#pragma GCC unroll 5
  for (int iteration = 0; iteration < 5; ++iteration) {
    const std::array<double, 9> cofactor = {
        R[4] * R[8] - R[5] * R[7], R[5] * R[6] - R[3] * R[8], R[3] * R[7] - R[4] * R[6],
        R[2] * R[7] - R[1] * R[8], R[0] * R[8] - R[2] * R[6], R[1] * R[6] - R[0] * R[7],
        R[1] * R[5] - R[2] * R[4], R[2] * R[3] - R[0] * R[5], R[0] * R[4] - R[1] * R[3]};
    const double d = (R[0] * cofactor[0] + R[1] * cofactor[1]) + R[2] * cofactor[2];
    if (iteration == 0) det = d;
    const double half_inverse = 0.5 / d;
    for (int k = 0; k < 9; ++k) R[k] = 0.5 * R[k] + half_inverse * cofactor[k];
  }
  return R;
}

inline DeformationIncrement<3> deformation_increment(const std::array<double, 9>& F) {
  DeformationIncrement<3> result;
  result.rotation = polar_rotation(F, result.volume_ratio);
  const auto row = [&](int i, int j) {
    return (F[3 * i] * F[3 * j] + F[3 * i + 1] * F[3 * j + 1]) + F[3 * i + 2] * F[3 * j + 2];
  };
  SymmetricTensor<3> b = {row(0, 0), row(1, 1), row(2, 2), row(0, 1), row(1, 2), row(2, 0)};
  const double inverse_mean = 3.0 / ((b[0] + b[1]) + b[2]);
  for (double& x : b) x *= inverse_mean;
  // ln B = 2 artanh(Y), Y = (B - I)(B + I)^-1, half of it is the strain.
  SymmetricTensor<3> minus = b, plus = b;
  for (int k = 0; k < 3; ++k) {
    minus[k] -= 1.0;
    plus[k] += 1.0;
  }
  const SymmetricTensor<3> y = commuting_product(minus, inverse(plus));
  const SymmetricTensor<3> y2 = commuting_product(y, y);
  SymmetricTensor<3> top, bottom;
  for (int k = 0; k < 6; ++k) {
    const double unit = k < 3 ? 15.0 : 0.0;
    top[k] = unit - 4.0 * y2[k];
    bottom[k] = unit - 9.0 * y2[k];
  }
  SymmetricTensor<3> e = commuting_product(y, commuting_product(top, inverse(bottom)));
  const double third = ((e[0] + e[1]) + e[2]) / 3.0;
  for (int k = 0; k < 3; ++k) e[k] -= third;
  result.strain_deviator = e;
  return result;
}

/// R a R^T of a symmetric tensor.
inline SymmetricTensor<2> rotate(const std::array<double, 4>& R, const SymmetricTensor<2>& a) {
  const double ux = R[0] * a[0] + R[1] * a[3];
  const double uy = R[0] * a[3] + R[1] * a[1];
  const double vx = R[2] * a[0] + R[3] * a[3];
  const double vy = R[2] * a[3] + R[3] * a[1];
  return {ux * R[0] + uy * R[1], vx * R[2] + vy * R[3], a[2], ux * R[2] + uy * R[3]};
}

inline SymmetricTensor<3> rotate(const std::array<double, 9>& R, const SymmetricTensor<3>& a) {
  std::array<double, 9> u;
  for (int i = 0; i < 3; ++i) {
    const double* r = R.data() + 3 * i;
    u[3 * i] = (r[0] * a[0] + r[1] * a[3]) + r[2] * a[5];
    u[3 * i + 1] = (r[0] * a[3] + r[1] * a[1]) + r[2] * a[4];
    u[3 * i + 2] = (r[0] * a[5] + r[1] * a[4]) + r[2] * a[2];
  }
  const auto dot = [&](int i, int j) {
    return (u[3 * i] * R[3 * j] + u[3 * i + 1] * R[3 * j + 1]) + u[3 * i + 2] * R[3 * j + 2];
  };
  return {dot(0, 0), dot(1, 1), dot(2, 2), dot(0, 1), dot(1, 2), dot(2, 0)};
}

}  // namespace poreshock
