#pragma once
// What the sweeps of one step hand to each other, per particle; not part of the state.

#include <array>
#include <cstddef>
#include <vector>

namespace poreshock {

/// Stored numbers of a rate of deformation: xx yy xy in plane strain, xx yy zz xy yz zx in 3-D.
template <int Dim>
inline constexpr int rate_size = Dim == 2 ? 3 : 6;

/// Results of the transfer sweeps, in canonical order from the first particle of the rows that
/// grid_to_particles took.
template <int Dim>
struct StepData {
  std::array<std::vector<double>, Dim * Dim> gradient;   ///< 1/s, of the new velocity, row major
  std::array<std::vector<double>, rate_size<Dim>> rate;  ///< 1/s, symmetric gradient at mid-step
  std::vector<double> heat;                              ///< J/kg, filter, wall and contact heat
  /// Shares 0 ... 1 of the artificial viscosity that act; 1 where it is not limited.
  std::vector<double> viscous_linear, viscous_quadratic;
};

/// Makes room for `count` particles in canonical order.
template <int Dim>
void resize_ordered(std::size_t count, StepData<Dim>& step) {
  for (auto& column : step.gradient) column.resize(count);
  for (auto& column : step.rate) column.resize(count);
  step.heat.resize(count);
  step.viscous_linear.resize(count, 1.0);
  step.viscous_quadratic.resize(count, 1.0);
}

/// Symmetric part of a velocity gradient g[axis][direction], in the order of StepData::rate.
template <int Dim, class Number>
inline std::array<Number, rate_size<Dim>> symmetric_part(
    const std::array<std::array<Number, Dim>, Dim>& g) {
  std::array<Number, rate_size<Dim>> rate;
  for (int a = 0; a < Dim; ++a) rate[a] = g[a][a];
  rate[Dim] = 0.5 * (g[0][1] + g[1][0]);
  if constexpr (Dim == 3) {
    rate[4] = 0.5 * (g[1][2] + g[2][1]);
    rate[5] = 0.5 * (g[2][0] + g[0][2]);
  }
  return rate;
}

}  // namespace poreshock
