#include "flow_increments.hpp"

#include "poreshock/material/derived.hpp"

namespace poreshock {

namespace {

// Flattened: the loops below vectorise only when all they call is inlined.
template <int Dim>
[[gnu::flatten]] void trial_norms(const Columns<Dim>& columns, double shear, double dt,
                                  std::size_t count, double* equivalent) {
  const Columns<Dim> c = columns;
  const bool can_fail = c.particle.failed != nullptr;
#pragma GCC ivdep
  for (std::size_t k = 0; k < count; ++k) {
    std::array<double, Dim * Dim> F;
    for (int j = 0; j < Dim * Dim; ++j) {
      F[j] = (j % (Dim + 1) == 0 ? 1.0 : 0.0) + dt * c.gradient[j][k];
    }
    SymmetricTensor<Dim> s;
    for (int j = 0; j < symmetric_size<Dim>; ++j) s[j] = c.particle.deviator[j][k];
    const bool failed = can_fail && c.particle.failed[k] > 0;
    const auto t = trial_stress<Dim>(deformation_increment(F), s, failed ? 0.0 : shear);
    equivalent[k] = std::sqrt(1.5) * std::sqrt(contract<Dim>(t.trial, t.trial));
  }
}

}  // namespace

template <int Dim>
bool plastic_increments(const std::vector<Material>& materials, Thermal thermal,
                        const Particles<Dim>& particles, std::span<const std::uint32_t> places,
                        const Columns<Dim>& c, double dt, double* increments) {
  const Material& m = materials[static_cast<std::size_t>(particles.material[places[0]])];
  if (std::holds_alternative<std::monostate>(m.flow)) return false;
  double equivalent[block_size], temperatures[block_size], molten[block_size];
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto phase = particle_phase<Dim>(particles, materials, thermal, places[k]);
    temperatures[k] = phase.temperature;
    molten[k] = phase.molten;
  }
  trial_norms<Dim>(c, m.strength.shear, dt, places.size(), equivalent);
  const FlowBlock<Dim> block{c.particle, places.size(),    equivalent,    temperatures,
                             molten,     m.strength.shear, m.eos.density, dt};
  std::visit(
      [&](const auto& law) {
        if constexpr (requires { find_increments(law, block, increments); }) {
          find_increments(law, block, increments);
        }
      },
      m.flow);
  return true;
}

template bool plastic_increments<2>(const std::vector<Material>&, Thermal, const Particles<2>&,
                                    std::span<const std::uint32_t>, const Columns<2>&, double,
                                    double*);
template bool plastic_increments<3>(const std::vector<Material>&, Thermal, const Particles<3>&,
                                    std::span<const std::uint32_t>, const Columns<3>&, double,
                                    double*);

}  // namespace poreshock
