#pragma once
// What the sweeps of one step hand to each other, per particle; not part of the state.

#include <array>
#include <cstddef>
#include <vector>

namespace poreshock {

/// Stored numbers of a rate of deformation: xx yy xy in plane strain, xx yy zz xy yz zx in 3-D.
template <int Dim>
inline constexpr int rate_size = Dim == 2 ? 3 : 6;

/// Per-particle results of the transfer sweeps, all of the length of the particle columns.
template <int Dim>
struct StepData {
  std::array<std::vector<double>, Dim * Dim> gradient;   ///< 1/s, of the new velocity, row major
  std::array<std::vector<double>, rate_size<Dim>> rate;  ///< 1/s, symmetric gradient at mid-step
  std::vector<double> heat;                              ///< J/kg, filter, wall and contact heat
  std::array<std::vector<double>, Dim> residual;   ///< m/s, part the filter takes; only with FMPM
  std::array<std::vector<double>, Dim> transport;  ///< m/s, velocity of the places; only with MUSL
  std::vector<double> averaged_pressure;           ///< Pa, p + q averaged; only with averaging
  std::vector<double> dilatation_end, dilatation_mid;  ///< 1/s, averaged; only with averaging

  void resize(std::size_t count, bool averaging) {
    for (auto& column : gradient) column.resize(count);
    for (auto& column : rate) column.resize(count);
    heat.resize(count);
    averaged_pressure.resize(averaging ? count : 0);
    dilatation_end.resize(averaging ? count : 0);
    dilatation_mid.resize(averaging ? count : 0);
  }
};

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
