#include "poreshock/physics/gap.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "poreshock/scene/transfer_scheme.hpp"

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
      const int base = stencil_base(Shape::width, s);
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

double touching_gap(double strain, double wedge) {
  // Beds of discs with 10 cells across at 1100 m/s overlap by 2.2 % of the space without the last
  // term, by 0.1 to 0.3 % with it; dense grains, whose faces are parallel, fill the space to 0.8 %
  // either way. Blocks and discs that slide undeformed plough with more than 0.05.
  constexpr double fresh = 0.05, strained = 0.15, nearer = 0.5;  // cells
  constexpr double full_strain = 0.1;
  return fresh + (strained - fresh + nearer * wedge) * std::min(strain / full_strain, 1.0);
}

namespace {

/// Slope against each other of two faces with this normal, at most 1: how much more of the node is
/// empty to one side, over their area.
template <int Dim>
double wedge_of(const NodeFill<Dim>& node, const Vector<Dim>& normal, double area,
                const ContactSettings& settings) {
  if (settings.mirrored || !(area > 0.0)) return 0.0;
  const Vector<Dim> across = node.gradient - normal * dot<Dim>(node.gradient, normal);
  return std::min(std::sqrt(dot<Dim>(across, across)) / area, 1.0);
}

}  // namespace

template <int Dim>
NodeFill<Dim> fill_of(std::span<const NodeGrain<Dim>> grains) {
  NodeFill<Dim> node;
  for (const NodeGrain<Dim>& g : grains) {
    node.volume += g.volume;
    node.gradient += g.gradient;
  }
  return node;
}

template <int Dim>
double pair_gap(const NodeGrain<Dim>& a, const NodeGrain<Dim>& b, const Vector<Dim>& normal,
                const NodeFill<Dim>& node, const ContactSettings& settings,
                const FaceTable& faces) {
  const double both = a.volume + b.volume;
  if (!(both > 0.0)) return std::numeric_limits<double>::infinity();
  const Vector<Dim> difference = (a.gradient - b.gradient) * 0.5;
  const double area = std::sqrt(dot<Dim>(difference, difference));
  const double strain = (a.strain * a.volume + b.strain * b.volume) / both;
  const double touching =
      touching_gap(strain, wedge_of<Dim>(node, normal, area, settings)) * settings.cell;
  // Touching flat faces that fill only part of the node, at an edge or beside other grains, still
  // have the area that belongs to the ratio of their volumes.
  const double density = faces.density(a.volume / both);
  const double missing_in_node = settings.capacity - node.volume;
  const double missing_in_pair = area * settings.cell - both * density;
  const double missing = std::min(missing_in_node * density, missing_in_pair);
  if (!(missing > touching * area * density)) return 0.0;
  return area > 0.0 && density > 0.0 ? missing / (area * density) - touching
                                     : std::numeric_limits<double>::infinity();
}

template NodeFill<2> fill_of<2>(std::span<const NodeGrain<2>>);
template NodeFill<3> fill_of<3>(std::span<const NodeGrain<3>>);
template double pair_gap<2>(const NodeGrain<2>&, const NodeGrain<2>&, const Vector<2>&,
                            const NodeFill<2>&, const ContactSettings&, const FaceTable&);
template double pair_gap<3>(const NodeGrain<3>&, const NodeGrain<3>&, const Vector<3>&,
                            const NodeFill<3>&, const ContactSettings&, const FaceTable&);

}  // namespace poreshock
