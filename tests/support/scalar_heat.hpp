#pragma once
// One explicit step of heat conduction in plain loops over particles and nodes, the oracle of the
// kernel.

#include <algorithm>
#include <vector>

#include "poreshock/material/material.hpp"
#include "support/scalar_transfer.hpp"

namespace poreshock::reference {

/// Heat per mass (J/kg) that every particle gains in a time dt, from its temperature (K).
template <int Dim>
std::vector<double> conducted_heat(const GridShape& shape, const Particles<Dim>& particles,
                                   const std::vector<MaterialParameters>& materials,
                                   const std::vector<double>& temperature, double dt) {
  const std::size_t nodes = static_cast<std::size_t>(shape.row_size) * shape.rows;
  std::vector<double> capacity(nodes, 0.0), energy(nodes, 0.0), given(nodes, 0.0);
  const auto law = [&](std::size_t p) -> const MaterialParameters& {
    return materials[static_cast<std::size_t>(particles.material[p])];
  };
  const auto each_node = [&](std::size_t p, const auto& visit) {
    for_each_node<Dim>(shape, position(particles, p),
                       [&](int i, double n, const auto& gradient, const auto&) {
                         visit(static_cast<std::size_t>(i), n, gradient);
                       });
  };
  for (std::size_t p = 0; p < particles.size(); ++p) {
    each_node(p, [&](std::size_t i, double n, const auto&) {
      capacity[i] += particles.mass[p] * law(p).cv * n;
      energy[i] += particles.mass[p] * law(p).cv * n * temperature[p];
    });
  }
  std::vector<double> lost(particles.size(), 0.0), heat = lost;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    const double density = std::max(particles.density[p], law(p).density);
    const double diffusivity = law(p).conductivity / (density * law(p).cv);
    Vector<Dim> slope = Vector<Dim>::Zero();
    double mean = 0.0;
    each_node(p, [&](std::size_t i, double n, const Vector<Dim>& gradient) {
      if (capacity[i] > 0.0) slope += energy[i] / capacity[i] * gradient;
      if (capacity[i] > 0.0) mean += energy[i] / capacity[i] * n;
    });
    lost[p] = 2.0 * diffusivity * dt / inertia(shape) * law(p).cv * (temperature[p] - mean);
    each_node(p, [&](std::size_t i, double n, const Vector<Dim>& gradient) {
      given[i] += particles.mass[p] * lost[p] * n;
      given[i] -= dt * particles.mass[p] / density * law(p).conductivity * slope.dot(gradient);
    });
  }
  for (std::size_t p = 0; p < particles.size(); ++p) {
    heat[p] = -lost[p];
    each_node(p, [&](std::size_t i, double n, const auto&) {
      if (capacity[i] > 0.0) heat[p] += law(p).cv * n * given[i] / capacity[i];
    });
  }
  return heat;
}

}  // namespace poreshock::reference
