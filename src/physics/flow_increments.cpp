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
    const bool failed = can_fail && c.particle.failed[k] != 0;
    const auto t = trial_stress<Dim>(deformation_increment(F), s, failed ? 0.0 : shear);
    equivalent[k] = std::sqrt(1.5) * std::sqrt(contract<Dim>(t.trial, t.trial));
  }
}

[[gnu::flatten]] void solve(const FlowStress& constants, double shear, double dt,
                            const double* equivalent, const double* factors, const double* strain,
                            std::size_t count, double* increments) {
  const FlowStress law = constants;
#pragma GCC ivdep
  for (std::size_t k = 0; k < count; ++k) {
    increments[k] = plastic_increment(law, {equivalent[k], 3.0 * shear, factors[k], strain[k], dt});
  }
}

}  // namespace

template <int Dim>
void plastic_increments(const std::vector<Material>& materials, Thermal thermal,
                        const Particles<Dim>& particles, std::span<const std::uint32_t> places,
                        const Columns<Dim>& c, double dt, double* increments) {
  const auto material = static_cast<std::size_t>(particles.material[places[0]]);
  const auto& m = materials[material];
  double equivalent[block_size], factors[block_size];
  for (std::size_t k = 0; k < places.size(); ++k) {
    const std::size_t i = places[k];
    const MaterialPhase phase = particle_phase<Dim>(particles, materials, thermal, i);
    factors[k] = (1.0 - phase.molten) * thermal_factor(*m.flow, particles.pressure[i],
                                                       particles.density[i] / m.eos.density,
                                                       phase.temperature);
  }
  trial_norms<Dim>(c, m.strength.shear, dt, places.size(), equivalent);
  solve(*m.flow, m.strength.shear, dt, equivalent, factors, c.particle.plastic_strain,
        places.size(), increments);
}

template void plastic_increments<2>(const std::vector<Material>&, Thermal, const Particles<2>&,
                                    std::span<const std::uint32_t>, const Columns<2>&, double,
                                    double*);
template void plastic_increments<3>(const std::vector<Material>&, Thermal, const Particles<3>&,
                                    std::span<const std::uint32_t>, const Columns<3>&, double,
                                    double*);

}  // namespace poreshock
