#pragma once
// Small vectors, matrices and symmetric tensors.
// Symmetric tensors are stored xx yy zz xy in plane strain and xx yy zz xy yz zx in 3-D.

#include <Eigen/Core>
#include <array>

namespace poreshock {

/// Column vector of Dim numbers; DontAlign keeps structs of them dense.
template <int Dim>
using Vector = Eigen::Matrix<double, Dim, 1, Eigen::DontAlign>;

/// Dim x Dim matrix, row major and dense.
template <int Dim>
using Matrix = Eigen::Matrix<double, Dim, Dim, Eigen::DontAlign | Eigen::RowMajor>;

/// Stored numbers of a symmetric tensor: 4 in plane strain, 6 in 3-D.
template <int Dim>
inline constexpr int symmetric_size = Dim == 2 ? 4 : 6;

template <int Dim>
using SymmetricTensor = std::array<double, symmetric_size<Dim>>;

/// Products r_a r_b of the components of a vector: xx, yy(, zz), then xy(, yz, zx).
template <int Dim>
inline constexpr int second_modes = Dim*(Dim + 1) / 2;

/// a . b, summed in the order of the components.
template <int Dim>
inline double dot(const Vector<Dim>& a, const Vector<Dim>& b) {
  double sum = a[0] * b[0];
  for (int k = 1; k < Dim; ++k) sum += a[k] * b[k];
  return sum;
}

/// a : b of two symmetric tensors (off-diagonal terms count twice).
template <int Dim>
inline double contract(const SymmetricTensor<Dim>& a, const SymmetricTensor<Dim>& b) {
  double diagonal = (a[0] * b[0] + a[1] * b[1]) + a[2] * b[2];
  if constexpr (Dim == 2) {
    return diagonal + 2.0 * (a[3] * b[3]);
  } else {
    return diagonal + 2.0 * ((a[3] * b[3] + a[4] * b[4]) + a[5] * b[5]);
  }
}

}  // namespace poreshock
