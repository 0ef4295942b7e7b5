#pragma once
// Conduction of heat: Fourier's law between particles through the nodes, explicit in time.
// Surfaces, walls and symmetry planes are insulated, periodic sides are not.

#include <array>
#include <vector>

#include "poreshock/core/fixed_point.hpp"
#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/particles/cell_order.hpp"
#include "poreshock/particles/particles.hpp"

namespace poreshock {

/// Meaning of the numbers of a node of the grid that conduct_heat works on.
struct HeatLane {
  static constexpr int capacity = 0;     ///< J/K, sum of m c_v N
  static constexpr int energy = 1;       ///< J, sum of m c_v T N, or of what particles hand over
  static constexpr int temperature = 1;  ///< K, energy over capacity
};

/// What conduct_heat needs besides particles and nodes.
struct HeatSettings {
  Thermal thermal = Thermal::conserving;
  ShapeFunction shape = ShapeFunction::cubic;
  double dt = 0.0;  ///< s
  double inverse_energy_quantum = 1.0;
};

/// Per-particle scratch of conduct_heat, not part of the state.
template <int Dim>
struct HeatFlow {
  std::array<std::vector<double>, Dim> gradient;  ///< K/m, of the nodal temperature
  std::vector<double> excess;                     ///< K, over the nodal temperature
};

/// Moves heat between particles for a time dt. With T_i = sum m c_v T N / sum m c_v N, particles
/// hand -dt V k grad T . grad N (Fourier's law) and the share 2 a dt/D of their excess over the
/// nodal temperature (D = sum N (x_i - x)^2, a = k/(rho c_v)) to the nodes, which spread both by
/// m c_v N. The second part lets decay what nodes cannot see, such as a jump between two particles;
/// where T is smooth it takes away the leading error of the first, -2 D a grad^4 T. Nothing is
/// gained in all. V is the volume, but not more than the undisturbed one: what opened beyond it is
/// no material. Adds to internal_energy, to conducted_heat where that is in use, and the gains in
/// quanta to `gained`. Positions must be those that `cells` was sorted by. Collective (two
/// exchanges of `grid`, whose nodes are scratch).
template <int Dim>
void conduct_heat(const std::vector<Material>& materials, const HeatSettings& settings,
                  const CellOrder& cells, SlabGrid& grid, HeatFlow<Dim>& scratch,
                  Particles<Dim>& particles, Int128& gained);

/// Largest stable step of conduct_heat, s; infinite when nothing conducts. lambda = max a sum |grad
/// N|^2/N bounds the rates of the first part for any arrangement of particles (Cauchy and Schwarz),
/// 2 a/D <= lambda those of the second, and 1/lambda makes their sum at most 2 per step: cell^2 /
/// (6 Dim a) for quadratic splines, cell^2/(3.14 Dim a) for cubic ones. Not collective.
double conduction_limit(const std::vector<Material>& materials, ShapeFunction shape, int dimension,
                        double cell);

}  // namespace poreshock
