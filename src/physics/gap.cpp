#include "poreshock/physics/gap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "poreshock/transfer/shape.hpp"

namespace poreshock {

FaceTable::FaceTable(const Transfer& transfer) {
  // The shape function on a fine grid, and its integral by Simpson's rule.
  constexpr int steps = 2048;
  std::array<double, steps + 1> weight{}, filled{};
  double half = 0.0;
  with_shape(transfer, [&]<class Shape>(const Shape& shape) {
    half = 0.5 * Shape::width;
    const auto value = [&](double x) {
      const double s = 10.0 + x;  // of the particle; node 11 lies at s = 10
      const int base = Shape::base(s);
      const int k = 11 - base;
      return k >= 0 && k < Shape::width ? axis_weights(shape, s, base).value[k] : 0.0;
    };
    const double h = 2.0 * half / steps;
    for (int i = 0; i <= steps; ++i) {
      weight[i] = value(-half + h * i);
      if (i == 0) continue;
      const double middle = value(-half + h * (i - 0.5));
      filled[i] = filled[i - 1] + h / 6.0 * (weight[i - 1] + 4.0 * middle + weight[i]);
    }
  });
  // In the fourth root of the share the tails of all shape functions are smooth.
  int i = 1;
  for (int k = 0; k <= intervals; ++k) {
    const double root = greatest_root * k / intervals;
    const double share = std::min((root * root) * (root * root), 0.5) * filled[steps];
    while (i < steps && filled[i] < share) ++i;
    const double width = filled[i] - filled[i - 1];
    const double t = width > 0.0 ? std::clamp((share - filled[i - 1]) / width, 0.0, 1.0) : 0.0;
    density_[k] = weight[i - 1] + t * (weight[i] - weight[i - 1]);
  }
}

double FaceTable::density(double share) const {
  const double smaller = std::clamp(std::min(share, 1.0 - share), 0.0, 0.5);
  const double x = std::sqrt(std::sqrt(smaller)) * (intervals / greatest_root);
  const int k = std::min(static_cast<int>(x), intervals - 1);
  return density_[k] + (x - k) * (density_[k + 1] - density_[k]);
}

double touching_gap(double strain) {
  // Beds of discs with 10 cells across, at 500 to 2000 m/s: with 0.05 throughout the grains overlap
  // by 1.5 to 2 % of the volume, whatever the friction, with this by less than 0.4 %. Blocks and
  // discs that slide undeformed plough with more than 0.05.
  constexpr double fresh = 0.05, strained = 0.15;  // cells
  constexpr double full_strain = 0.1;
  return fresh + (strained - fresh) * std::min(strain / full_strain, 1.0);
}

template <int Dim>
double pair_gap(const NodeGrain<Dim>& a, const NodeGrain<Dim>& b, double filled,
                const ContactSettings& settings, const FaceTable& faces) {
  const double both = a.volume + b.volume;
  if (!(both > 0.0)) return std::numeric_limits<double>::infinity();
  const Vector<Dim> difference = (a.gradient - b.gradient) * 0.5;
  const double area = std::sqrt(dot<Dim>(difference, difference));
  const double touching =
      touching_gap((a.strain * a.volume + b.strain * b.volume) / both) * settings.cell;
  // Touching flat faces that fill only part of the node, at an edge or beside other grains, still
  // have the area that belongs to the ratio of their volumes.
  const double density = faces.density(a.volume / both);
  const double missing_in_node = settings.capacity - filled;
  const double missing_in_pair = area * settings.cell - both * density;
  const double missing = std::min(missing_in_node * density, missing_in_pair);
  if (!(missing > touching * area * density)) return 0.0;
  return area > 0.0 && density > 0.0 ? missing / (area * density) - touching
                                     : std::numeric_limits<double>::infinity();
}

template double pair_gap<2>(const NodeGrain<2>&, const NodeGrain<2>&, double,
                            const ContactSettings&, const FaceTable&);
template double pair_gap<3>(const NodeGrain<3>&, const NodeGrain<3>&, double,
                            const ContactSettings&, const FaceTable&);

}  // namespace poreshock
