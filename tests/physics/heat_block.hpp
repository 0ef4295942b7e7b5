#pragma once
// Solid blocks at rest for tests of heat conduction.

#include <functional>

#include "poreshock/material/derived.hpp"
#include "poreshock/physics/heat.hpp"
#include "support/aluminium.hpp"
#include "transfer/cloud.hpp"

namespace poreshock::test {

/// A block of undisturbed material, its particles on a lattice of `per_cell` per cell and axis.
template <int Dim>
Cloud<Dim> lattice(const std::array<int, 3>& cells, double cell, int per_cell, ShapeFunction shape,
                   bool periodic) {
  Cloud<Dim> block;
  Scene scene;
  scene.dimension = Dim;
  scene.domain.cell = cell;
  scene.domain.cells = cells;
  scene.domain.periodic = {periodic, periodic};
  scene.transfer.shape = shape;
  block.shape = make_grid_shape(scene);
  block.transfer = scene.transfer;
  std::size_t count = 1;
  for (int a = 0; a < Dim; ++a) count *= static_cast<std::size_t>(cells[a] * per_cell);
  Particles<Dim>& p = block.particles;
  p.options.affine = false;
  resize(p, count);
  for (std::size_t i = 0; i < count; ++i) {
    p.id[i] = static_cast<std::int64_t>(i);
    std::size_t rest = i;
    double volume = 1.0;
    for (int a = 0; a < Dim; ++a) {
      const auto places = static_cast<std::size_t>(cells[a] * per_cell);
      p.position[a][i] = (static_cast<double>(rest % places) + 0.5) * cell / per_cell;
      rest /= places;
      volume *= cell / per_cell;
    }
    p.density[i] = reference::aluminium().density;
    p.mass[i] = p.density[i] * volume;
  }
  return block;
}

/// Temperatures of undisturbed particles by their internal energy; T(particle) in K.
template <int Dim>
void set_temperature(const std::vector<MaterialParameters>& materials,
                     const std::function<double(std::size_t)>& T, Particles<Dim>& p) {
  for (std::size_t i = 0; i < p.size(); ++i) {
    const MaterialParameters& m = materials[static_cast<std::size_t>(p.material[i])];
    p.internal_energy[i] = m.cv * (T(i) - m.T0);
  }
}

inline std::vector<Material> made(const std::vector<MaterialParameters>& all) {
  std::vector<Material> materials;
  for (const MaterialParameters& m : all) materials.push_back(make_material(m));
  return materials;
}

/// Conducts for `steps` steps of dt and returns the sum of the gains, J. Collective.
template <int Dim>
double conduct(const std::vector<MaterialParameters>& all, Thermal thermal, ShapeFunction shape,
               double dt, int steps, Slab<Dim>& slab) {
  constexpr double quantum = 0x1p-60;
  const std::vector<Material> materials = made(all);
  HeatFlow<Dim> scratch;
  Int128 gained = 0;
  for (int n = 0; n < steps; ++n) {
    conduct_heat<Dim>(materials, {thermal, shape, dt, 1.0 / quantum}, slab.cells, *slab.grid,
                      scratch, slab.particles, gained);
  }
  std::vector<Int128> sums = {gained};
  sum(sums, slab.grid->communicator());
  return static_cast<double>(sums[0]) * quantum;
}

}  // namespace poreshock::test
