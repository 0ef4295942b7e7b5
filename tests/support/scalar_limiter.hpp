#pragma once
// The limiter of the artificial viscosity, node by node. Its oracle.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "support/scalar_transfer.hpp"

namespace poreshock::reference {

/// Velocity along `axis` at the four nodes of that axis around x, each a mean over the nodes
/// across.
template <int Dim>
std::array<double, 4> velocity_along(const GridShape& shape,
                                     const std::vector<NodeMotion<Dim>>& nodes,
                                     const Vector<Dim>& x, int axis) {
  std::array<double, 4> result{};
  for (int n = 0; n < (Dim == 2 ? 16 : 64); ++n) {
    double weight = 1.0;
    int node = 0, stride = 1, own = 0;
    for (int a = 0, rest = n; a < Dim; rest /= 4, ++a) {
      const double s = x[a] * (1.0 / shape.cell);
      int index = static_cast<int>(std::floor(s)) + rest % 4;
      if (a == axis) own = rest % 4;
      if (a != axis) weight *= spline(shape, s - (index - 1));
      const int cells = shape.nodes[a] - 3;
      if (a + 1 < Dim && shape.periodic[a]) index = (index + cells - 1) % cells + 1;
      node += stride * index;
      stride *= shape.nodes[a];
    }
    result[static_cast<std::size_t>(own)] +=
        weight * nodes[static_cast<std::size_t>(node)].end[axis];
  }
  return result;
}

/// Shares of the linear and the quadratic viscosity that act on a particle.
struct ViscousShares {
  double linear = 0.0, quadratic = 0.0;
};

/// One less the limiter of each axis, weighted with how fast it closes. r are the ratios of the
/// jumps beside to the own one: linear min(mean r, 3 r), quadratic the least r^4, all in 0 ... 1.
template <int Dim>
ViscousShares viscous_shares(const GridShape& shape, const std::vector<NodeMotion<Dim>>& nodes,
                             const Vector<Dim>& x, const Matrix<Dim>& gradient) {
  ViscousShares sum;
  double closing = 0.0;
  for (int a = 0; a < Dim; ++a) {
    const double rate = std::max(0.0, -gradient(a, a));
    const auto v = velocity_along<Dim>(shape, nodes, x, a);
    const double own = v[2] - v[1];
    closing += rate;
    const double floor = 1e-6 * (std::abs(v[1] - v[0]) + std::abs(own) + std::abs(v[3] - v[2]));
    if (floor == 0.0) continue;
    const double inverse = own / (own * own + floor * floor);
    const double below = (v[1] - v[0]) * inverse, above = (v[3] - v[2]) * inverse;
    const double least = std::clamp(std::min(below, above), 0.0, 1.0);
    const double linear = std::min({0.5 * (below + above), 3.0 * below, 3.0 * above});
    sum.linear += rate * (1.0 - std::clamp(linear, 0.0, 1.0));
    sum.quadratic += rate * (1.0 - std::pow(least, 4));
  }
  if (closing == 0.0) return {};
  return {sum.linear / closing, sum.quadratic / closing};
}

}  // namespace poreshock::reference
