#pragma once
// Fields that follow from the particle state: what snapshots write and morphology measures.

#include <cstdint>
#include <string_view>
#include <vector>

#include "poreshock/material/material.hpp"
#include "poreshock/particles/particles.hpp"

namespace poreshock {

/// Lowest temperature given out, K.
inline constexpr double temperature_floor = 1.0;

/// Unit of a field that derive_field knows; InputError for other names.
std::string_view derived_unit(std::string_view name);

/// Temperature of particle i, not clamped, and its molten share. Its density must be positive.
template <int Dim>
MaterialPhase particle_phase(const Particles<Dim>& particles,
                             const std::vector<Material>& materials, Thermal thermal,
                             std::size_t i);

/// Temperature of particle i, K; not clamped. Its density must be positive.
template <int Dim>
double particle_temperature(const Particles<Dim>& particles, const std::vector<Material>& materials,
                            Thermal thermal, std::size_t i) {
  return particle_phase(particles, materials, thermal, i).temperature;
}

/// One value per particle of the field `name`: temperature (K), pressure (Pa, equation of state,
/// compression positive), density (kg/m^3), speed (m/s), von_mises (Pa), plastic_strain or molten
/// (share of the mass that is liquid). Returns
/// how many temperatures lay below 1 K and were set to it, 0 for other fields. A particle without a
/// positive density has temperature NaN. InputError for other names. Not collective.
template <int Dim>
std::int64_t derive_field(std::string_view name, const Particles<Dim>& particles,
                          const std::vector<Material>& materials, Thermal thermal,
                          std::vector<double>& out);

}  // namespace poreshock
