#pragma once
// Private to solver: quanta of sums over particles that must not depend on the number of ranks.

#include <algorithm>
#include <vector>

#include "poreshock/material/derived.hpp"
#include "poreshock/solver/ledger.hpp"

namespace poreshock {

/// Inverse quanta of the sums: powers of two, so that rounding stays below 2^-50 of what one
/// particle usually brings.
struct Quanta {
  double mass, volume, energy, heat, momentum;
};

inline Quanta make_quanta(const Ledger& ledger, const std::vector<Material>& materials,
                          const Scene& scene) {
  double density = 0.0, temperature = temperature_floor;
  for (const Material& m : materials) density = std::max(density, m.eos.density);
  for (const auto& m : scene.materials) temperature = std::max(temperature, m.T0);
  const double per_mass = 1.0 / mass_quantum(ledger);
  return {per_mass, per_mass * power_of_two_below(density), ledger.nodes.inverse_energy_quantum,
          per_mass / power_of_two_below(temperature), ledger.nodes.inverse_momentum_quantum};
}

}  // namespace poreshock
