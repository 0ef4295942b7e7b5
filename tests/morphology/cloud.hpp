#pragma once
// Particles for the tests of the deposit.

#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "poreshock/morphology/pixel_map.hpp"
#include "support/random_numbers.hpp"

namespace poreshock::reference {

inline constexpr double infinity = std::numeric_limits<double>::infinity();
inline constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();

/// Pixels of 1/4 m, so that all numbers are exact.
inline constexpr double pixel = 0.25;
inline constexpr PixelScales exact_scales = {1024.0, 8.0 * pixel};

/// Columns of particles with two values.
template <int Dim>
struct Cloud {
  std::array<std::vector<double>, Dim> position;
  std::vector<double> mass, density, value, other;

  std::size_t size() const { return mass.size(); }

  /// Adds a particle by the side of its square in m.
  void add(const std::array<double, Dim>& centre, double side, double rho, double a, double b) {
    for (std::size_t axis = 0; axis < Dim; ++axis) position[axis].push_back(centre[axis]);
    mass.push_back(rho * std::pow(side, Dim));
    density.push_back(rho);
    value.push_back(a);
    other.push_back(b);
  }
  void add_from(const Cloud& from, std::size_t i) {
    for (std::size_t axis = 0; axis < Dim; ++axis) position[axis].push_back(from.position[axis][i]);
    mass.push_back(from.mass[i]);
    density.push_back(from.density[i]);
    value.push_back(from.value[i]);
    other.push_back(from.other[i]);
  }
};

template <int Dim>
PixelField<Dim> deposit_cloud(const Cloud<Dim>& cloud, const PixelScales& scales,
                              const PixelGrid<Dim>& grid) {
  PixelSources<Dim> sources;
  for (std::size_t axis = 0; axis < Dim; ++axis) sources.position[axis] = cloud.position[axis];
  sources.mass = cloud.mass;
  sources.density = cloud.density;
  return deposit<Dim>(sources, {cloud.value, cloud.other}, scales, grid);
}

/// Irregular particles with sides of 0.3 to 1.6 pixels, some beyond the map.
template <int Dim>
Cloud<Dim> random_cloud(const std::array<int, Dim>& pixels, int count, Random& random) {
  Cloud<Dim> cloud;
  for (int i = 0; i < count; ++i) {
    std::array<double, Dim> centre{};
    for (std::size_t axis = 0; axis < Dim; ++axis) {
      centre[axis] = (random.uniform() * (pixels[axis] + 1.0) - 0.5) * pixel;
    }
    const double side = (0.3 + 1.3 * random.uniform()) * pixel;
    cloud.add(centre, side, 1000.0 + 3000.0 * random.uniform(), 4.0 * random.uniform() - 2.0,
              3000.0 * random.uniform());
  }
  return cloud;
}

}  // namespace poreshock::reference
