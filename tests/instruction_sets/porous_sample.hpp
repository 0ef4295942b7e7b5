#pragma once
// Small porous samples, made by hand from random numbers.

#include "poreshock/material/library.hpp"
#include "poreshock/physics/heat.hpp"
#include "poreshock/physics/node_ledger.hpp"
#include "poreshock/physics/stress.hpp"
#include "poreshock/scene/transfer_scheme.hpp"
#include "poreshock/transfer/grid_to_particles.hpp"
#include "support/aluminium.hpp"
#include "support/random_numbers.hpp"

namespace poreshock::test {

inline constexpr double cell = 1.0e-5;  // m

/// What the samples differ in.
struct Case {
  const char* name;
  Transfer transfer;
  Thermal thermal;
  SideKind lateral;
  bool conduction_and_spall = false;
};

/// Everything one sample needs.
template <int Dim>
struct PorousSample {
  Scene scene;
  std::vector<Material> materials;
  StressSettings<Dim> settings;
  Particles<Dim> particles;
  StepData<Dim> step;
  std::vector<std::uint32_t> cell_of;
  CellOrder cells;
  NodeLedger ledger;
  TransferReport transfer;
  Int128 conduction = 0;
  bool conducts = false;
  HeatFlow<Dim> heat_flow;
  StressReport report;
};

template <int Dim>
PorousSample<Dim> prepare(const Case& c, const std::array<int, Dim>& cells) {
  PorousSample<Dim> s;
  s.scene.dimension = Dim;
  s.scene.transfer = c.transfer;
  s.scene.thermal = c.thermal;
  s.scene.domain.cell = cell;
  for (int a = 0; a < Dim; ++a) {
    s.scene.domain.cells[a] = cells[a];
    s.scene.domain.size[a] = cells[a] * cell;
  }
  s.scene.domain.periodic.fill(c.lateral == SideKind::periodic);
  s.scene.boundary.low.kind = SideKind::wall;
  s.scene.boundary.lateral.fill(c.lateral);
  MaterialParameters solid = reference::aluminium(), fluid = solid;
  solid.kinematic_share = 0.3;
  fluid.young = fluid.yield = fluid.hardening = 0.0;
  if (c.conduction_and_spall) solid.spall = 3.0e8;
  s.conducts = c.conduction_and_spall;
  MaterialParameters flowing = library_material("copper")->parameters;
  flowing.density = 2700.0;
  flowing.strength = StrengthModel::johnson_cook;
  s.materials = {make_material(solid), make_material(fluid), make_material(flowing)};
  s.settings.thermal = c.thermal;
  s.settings.viscosity = {0.6, 2.25};
  s.settings.cfl = 0.35;
  s.settings.cell = cell;
  s.settings.inverse_energy_quantum = 0x1p60;
  s.ledger.inverse_energy_quantum = s.settings.inverse_energy_quantum;
  s.ledger.inverse_momentum_quantum = 0x1p70;
  const Modes modes = scheme_of(c.transfer.velocity).modes;
  s.particles.options.affine = modes != Modes::constant;
  s.particles.options.quadratic = modes == Modes::quadratic;
  s.particles.options.back_stress = true;
  s.particles.options.conducted_heat = s.conducts && c.thermal == Thermal::paper;
  s.particles.options.failed = c.conduction_and_spall;
  return s;
}

/// Whether the point (in cells) lies in one of two round voids.
template <int Dim>
bool in_void(const std::array<double, Dim>& x) {
  const auto inside = [&](double lateral, double height, double radius) {
    double distance2 = (x[Dim - 1] - height) * (x[Dim - 1] - height);
    for (int a = 0; a + 1 < Dim; ++a) distance2 += (x[a] - lateral) * (x[a] - lateral);
    return distance2 < radius * radius;
  };
  return inside(2.1, 2.6, 1.4) || inside(4.6, 4.9, 1.1);
}

/// Random places on a lattice of two particles per cell and direction, random states, falling.
template <int Dim>
void fill(reference::Random& random, PorousSample<Dim>& s) {
  Particles<Dim>& p = s.particles;
  std::array<int, Dim> count;
  int points = 1;
  for (int a = 0; a < Dim; ++a) {
    count[a] = 2 * s.scene.domain.cells[a] - (a == Dim - 1 ? 6 : 0);
    points *= count[a];
  }
  const auto centred = [&] { return 2.0 * random.uniform() - 1.0; };
  for (int k = 0; k < points; ++k) {
    std::array<double, Dim> x;
    for (int a = 0, rest = k; a < Dim; rest /= count[a], ++a) {
      x[a] = 0.5 * (rest % count[a] + 0.5 + 0.3 * centred());
    }
    if (in_void<Dim>(x)) continue;
    const std::size_t i = p.size();
    resize(p, i + 1);
    // Ids in no order, as after migration.
    p.id[i] = (k * 7919LL) % 1000003;
    p.grain[i] = random.below(2);
    const int kind = random.below(8);
    p.material[i] = kind < 3 ? kind : 0;
    const bool solid = p.material[i] != 1;
    const bool hardens = p.material[i] == 0;
    p.density[i] = 2700.0 * (1.0 + 0.01 * centred());
    p.mass[i] = p.density[i] * (Dim == 2 ? 0.25 * cell * cell : 0.125 * cell * cell * cell);
    for (int a = 0; a < Dim; ++a) {
      p.position[a][i] = x[a] * cell;
      p.velocity[a][i] = 200.0 * centred() - (a == Dim - 1 ? 1500.0 : 0.0);
    }
    if (p.options.affine) {
      for (auto& column : p.affine) column[i] = 1.0e7 * centred();
    }
    if (p.options.quadratic) {
      for (auto& column : p.quadratic) column[i] = 30.0 * centred();
    }
    p.internal_energy[i] = 2.0e4 * random.uniform();
    for (int c = 0; c < symmetric_size<Dim>; ++c) {
      p.deviator[c][i] = solid ? 4.0e7 * centred() : 0.0;
      p.back_stress[c][i] = hardens ? 4.0e6 * centred() : 0.0;
    }
    p.deviator[2][i] = -(p.deviator[0][i] + p.deviator[1][i]);
    p.back_stress[2][i] = -(p.back_stress[0][i] + p.back_stress[1][i]);
  }
  initialise_stress<Dim>(s.materials, s.settings, p, s.report);
}

}  // namespace poreshock::test
