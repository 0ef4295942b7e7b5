#pragma once
// Particles and step data for tests of the constitutive update, made by hand.

#include <gtest/gtest.h>
#include <numeric>

#include <algorithm>
#include <cstring>
#include <vector>

#include "poreshock/physics/stress.hpp"
#include "support/aluminium.hpp"
#include "support/random_numbers.hpp"

namespace poreshock::test {

/// Particles and what the sweeps of one step found for them.
template <int Dim>
struct Points {
  Particles<Dim> particles;
  StepData<Dim> step;

  Points(std::size_t count, bool kinematic) {
    particles.options.affine = false;
    particles.options.back_stress = kinematic;
    resize(particles, count);
    resize_ordered(count, step);
    for (std::size_t p = 0; p < count; ++p) {
      particles.id[p] = static_cast<std::int64_t>(p);
      particles.mass[p] = 1.0;
    }
  }
};

/// Points at rest in the initial state of one material.
template <int Dim>
Points<Dim> at_rest(const MaterialParameters& material, std::size_t count = 1) {
  Points<Dim> points(count, material.kinematic_share > 0.0);
  for (double& x : points.particles.density) x = material.density;
  return points;
}

/// Settings with some viscosity, a cell of 10 um and a Courant number of 0.35.
template <int Dim>
StressSettings<Dim> settings_of(Thermal thermal) {
  StressSettings<Dim> settings;
  settings.thermal = thermal;
  settings.viscosity = {0.6, 2.25, false};
  settings.cell = 1.0e-5;
  settings.cfl = 0.35;
  settings.inverse_energy_quantum = 0x1p40;
  return settings;
}

/// Sets a gradient at the end of the step, row major, and the rate at its middle from `middle`.
template <int Dim>
void set_motion(const std::array<double, Dim * Dim>& end,
                const std::array<double, Dim * Dim>& middle, std::size_t p, StepData<Dim>& step) {
  for (int k = 0; k < Dim * Dim; ++k) step.gradient[k][p] = end[k];
  const auto rate = [&](int a, int b) { return 0.5 * (middle[a * Dim + b] + middle[b * Dim + a]); };
  for (int a = 0; a < Dim; ++a) step.rate[a][p] = rate(a, a);
  step.rate[Dim][p] = rate(0, 1);
  if constexpr (Dim == 3) {
    step.rate[4][p] = rate(1, 2);
    step.rate[5][p] = rate(2, 0);
  }
}

/// Random states: compressed or stretched, hot, stressed beyond yield or below (a fluid not at
/// all), deforming by up to `strain` in a step of length dt; the viscosities act in part, fully or
/// not at all.
template <int Dim>
Points<Dim> random_points(std::size_t count, const std::vector<Material>& materials, bool kinematic,
                          double strain, double dt, reference::Random& random) {
  Points<Dim> points(count, kinematic);
  Particles<Dim>& p = points.particles;
  const auto centred = [&] { return 2.0 * random.uniform() - 1.0; };
  for (std::size_t i = 0; i < count; ++i) {
    p.material[i] = random.below(static_cast<int>(materials.size()));
    const auto& law = materials[static_cast<std::size_t>(p.material[i])];
    const double solid = law.strength.shear > 0.0 ? 1.0 : 0.0;
    p.mass[i] = 1.0e-7 * (0.5 + random.uniform());
    p.density[i] = 2700.0 * (0.9 + 0.3 * random.uniform());
    p.pressure[i] = 2.0e10 * random.uniform() - 1.0e9;
    p.viscous_pressure[i] = random.below(3) == 0 ? 0.0 : 3.0e9 * random.uniform();
    p.internal_energy[i] = 6.0e5 * random.uniform();
    p.plastic_strain[i] = 0.2 * random.uniform();
    p.plastic_work[i] = 1.0e4 * random.uniform();
    for (auto& column : p.velocity) column[i] = 1500.0 * centred();
    for (auto& column : p.deviator) column[i] = solid * 7.0e7 * centred();
    p.deviator[2][i] = -(p.deviator[0][i] + p.deviator[1][i]);
    if (kinematic) {
      for (auto& column : p.back_stress) column[i] = solid * 2.0e7 * centred();
      p.back_stress[2][i] = -(p.back_stress[0][i] + p.back_stress[1][i]);
    }
    std::array<double, Dim * Dim> end, middle;
    for (int k = 0; k < Dim * Dim; ++k) {
      end[k] = strain / dt * centred();
      middle[k] = end[k] + 0.1 * strain / dt * centred();
    }
    set_motion<Dim>(end, middle, i, points.step);
    points.step.heat[i] = 500.0 * random.uniform();
    points.step.viscous_linear[i] = std::clamp(1.6 * random.uniform() - 0.3, 0.0, 1.0);
    points.step.viscous_quadratic[i] = std::clamp(1.6 * random.uniform() - 0.3, 0.0, 1.0);
  }
  return points;
}

/// The particles as they are stored.
inline std::vector<std::uint32_t> all_places(std::size_t count) {
  std::vector<std::uint32_t> places(count);
  std::iota(places.begin(), places.end(), 0U);
  return places;
}

/// Updates the points and returns the report.
template <int Dim>
StressReport update(const std::vector<Material>& materials, const StressSettings<Dim>& settings,
                    double dt, Points<Dim>& points) {
  StressReport report;
  const std::vector<std::uint32_t> places = all_places(points.particles.size());
  update_stress<Dim>(materials, settings, points.step, dt, places, points.particles, report);
  return report;
}

/// All numbers of one particle in one row, for comparisons bit for bit.
template <int Dim>
std::vector<std::uint64_t> bits_of(const Particles<Dim>& particles, std::size_t i) {
  std::vector<std::uint64_t> bits;
  for_each_column(particles, [&](std::string_view, int, const auto& column) {
    std::uint64_t word = 0;
    std::memcpy(&word, &column[i], sizeof(column[i]));
    bits.push_back(word);
  });
  return bits;
}

/// Deviator or back stress of one particle.
template <int Dim>
SymmetricTensor<Dim> tensor_of(const std::array<std::vector<double>, symmetric_size<Dim>>& columns,
                               std::size_t i = 0) {
  SymmetricTensor<Dim> result;
  for (int k = 0; k < symmetric_size<Dim>; ++k) result[k] = columns[k][i];
  return result;
}

template <int Dim>
double von_mises(const Particles<Dim>& particles, std::size_t i = 0) {
  const SymmetricTensor<Dim> s = tensor_of<Dim>(particles.deviator, i);
  return std::sqrt(1.5 * contract<Dim>(s, s));
}

}  // namespace poreshock::test
