#pragma once
// Fields that follow from the particle state: what snapshots write and morphology measures.

#include <cstdint>
#include <string_view>
#include <vector>

#include "poreshock/material/material.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/scene/scene.hpp"

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

/// Square of the radius of gyration of the shape function, m^2: kinetic energy per mass of an
/// affine particle is (|v|^2 + inertia |C|^2) / 2. Zero for transfers without affine modes.
double affine_inertia(const Transfer& transfer, double cell);

/// Squares of what the modes of particle p beyond its velocity add to its kinetic energy, for each
/// component, m^2/s^2; `inertia` of affine_inertia.
template <int Dim>
std::array<double, Dim> mode_squares(const Particles<Dim>& particles, double inertia,
                                     std::size_t p);

/// Kinetic energy of particle p with all its modes, J/kg.
template <int Dim>
double kinetic_energy(const Particles<Dim>& particles, double inertia, std::size_t p);

}  // namespace poreshock
