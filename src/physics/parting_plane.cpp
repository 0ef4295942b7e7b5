#include "poreshock/physics/parting_plane.hpp"

#include <array>
#include <cmath>

namespace poreshock {

namespace {

/// A number for each coordinate and one for the constant.
template <int Dim>
using Numbers = std::array<double, Dim + 1>;

template <int Dim>
double dot(const Numbers<Dim>& a, const Numbers<Dim>& b) {
  double sum = 0.0;
  for (int k = 0; k <= Dim; ++k) sum += a[k] * b[k];
  return sum;
}

/// e^-x for x >= 0 to 1e-15: not of the C library, whose last digit depends on the processor.
double decay(double x) {
  constexpr double most = 700.0, log2e = 1.4426950408889634, ln2 = 0.6931471805599453;
  if (x > most) return 0.0;
  const double halvings = std::floor(x * log2e + 0.5);
  const double rest = halvings * ln2 - x;  // |rest| <= ln2 / 2
  double sum = 1.0;
  for (int k = 14; k > 0; --k) sum = 1.0 + sum * rest / k;
  return std::ldexp(sum, -static_cast<int>(halvings));
}

double logistic(double x) {
  const double e = decay(std::abs(x));
  return (x > 0.0 ? 1.0 : e) / (1.0 + e);
}

/// Slope of the logarithm of the likelihood, and minus its curvature where that is asked for.
template <int Dim>
struct Likelihood {
  Numbers<Dim> slope{};
  std::array<Numbers<Dim>, Dim + 1> curvature{};
};

template <int Dim>
Likelihood<Dim> likelihood(std::span<const NodePoint<Dim>> points, int a, int b,
                           const Numbers<Dim>& fit) {
  Likelihood<Dim> result;
  for (int k = 0; k < Dim; ++k) {
    result.slope[k] = -normal_penalty * fit[k];
    result.curvature[k][k] = normal_penalty;
  }
  for (const NodePoint<Dim>& point : points) {
    if (point.field != a && point.field != b) continue;
    Numbers<Dim> x;
    for (int k = 0; k < Dim; ++k) x[k] = point.offset[k];
    x[Dim] = 1.0;
    const double expected = logistic(dot<Dim>(fit, x));
    const double missing = point.volume * ((point.field == b ? 1.0 : 0.0) - expected);
    const double weight = point.volume * (expected * (1.0 - expected));
    for (int k = 0; k <= Dim; ++k) {
      result.slope[k] += missing * x[k];
      for (int l = 0; l <= k; ++l) result.curvature[k][l] += weight * x[k] * x[l];
    }
  }
  return result;
}

/// Solves curvature step = slope by Cholesky's method; false where it is not positive.
template <int Dim>
bool newton_step(const Likelihood<Dim>& at, Numbers<Dim>& step) {
  auto factor = at.curvature;
  step = at.slope;
  for (int k = 0; k <= Dim; ++k) {
    for (int l = 0; l <= k; ++l) {
      double rest = factor[k][l];
      for (int m = 0; m < l; ++m) rest -= factor[k][m] * factor[l][m];
      if (k == l && !(rest > 0.0)) return false;
      factor[k][l] = k == l ? std::sqrt(rest) : rest / factor[l][l];
    }
    for (int m = 0; m < k; ++m) step[k] -= factor[k][m] * step[m];
    step[k] /= factor[k][k];
  }
  for (int k = Dim; k >= 0; --k) {
    for (int m = k + 1; m <= Dim; ++m) step[k] -= factor[m][k] * step[m];
    step[k] /= factor[k][k];
  }
  return true;
}

}  // namespace

template <int Dim>
Vector<Dim> parting_normal(std::span<const NodePoint<Dim>> points, int a, int b) {
  constexpr int most_steps = 40, most_halvings = 30;
  constexpr double converged = 1e-8;  // of a step that converges quadratically
  Vector<Dim> normal = Vector<Dim>::Zero();
  bool has_a = false, has_b = false;
  for (const NodePoint<Dim>& point : points) {
    has_a = has_a || point.field == a;
    has_b = has_b || point.field == b;
  }
  if (!has_a || !has_b) return normal;
  Numbers<Dim> fit{};
  Likelihood<Dim> here = likelihood<Dim>(points, a, b, fit);
  for (int n = 0; n < most_steps; ++n) {
    Numbers<Dim> step;
    if (!newton_step<Dim>(here, step)) return normal;
    // Along a step the likelihood rises, then falls: not far beyond its top.
    const double rise = dot<Dim>(here.slope, step);
    double share = 1.0;
    Numbers<Dim> next;
    for (int halvings = 0; halvings < most_halvings; ++halvings, share *= 0.5) {
      for (int k = 0; k <= Dim; ++k) next[k] = fit[k] + share * step[k];
      here = likelihood<Dim>(points, a, b, next);
      if (dot<Dim>(here.slope, step) >= -0.5 * rise) break;
    }
    fit = next;
    if (!(dot<Dim>(step, step) > converged * converged * dot<Dim>(fit, fit))) break;
  }
  double square = 0.0;
  for (int k = 0; k < Dim; ++k) square += fit[k] * fit[k];
  if (!(square > 0.0)) return normal;
  for (int k = 0; k < Dim; ++k) normal[k] = fit[k] / std::sqrt(square);
  return normal;
}

template Vector<2> parting_normal<2>(std::span<const NodePoint<2>>, int, int);
template Vector<3> parting_normal<3>(std::span<const NodePoint<3>>, int, int);

}  // namespace poreshock
