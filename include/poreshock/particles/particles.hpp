#pragma once
// Particle state as a structure of arrays, and the one list of its columns from which resizing,
// reordering, migration, checkpoints and NaN checks are derived.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>
#include <vector>

#include "poreshock/core/tensor.hpp"
#include "poreshock/scene/transfer_scheme.hpp"

namespace poreshock {

/// Which optional columns a scene needs; columns it does not need stay empty.
struct ParticleOptions {
  bool affine = true;           ///< transfers with affine modes
  bool quadratic = false;       ///< transfers with modes of second order
  bool back_stress = false;     ///< kinematic hardening
  bool conducted_heat = false;  ///< heat conduction in paper mode
  bool failed = false;          ///< some material has a spall strength
  bool facing = false;          ///< self-contact
};

/// State of the particles of one rank. All columns have the same length, but those not in use: 0.
template <int Dim>
struct Particles {
  ParticleOptions options;
  std::vector<std::int64_t> id;  ///< from the sample, unique, never changes
  std::vector<std::int32_t> grain;
  std::vector<std::int32_t> material;             ///< index into the scene's materials
  std::array<std::vector<double>, Dim> position;  ///< m, relative to the grid origin
  std::array<std::vector<double>, Dim> velocity;  ///< m/s
  std::array<std::vector<double>, Dim * Dim>
      affine;  ///< 1/s, row major, velocity gradient of its own
  /// m/s, amplitudes of r_a r_b for each component, of norm 1 under N; see second_modes
  std::array<std::vector<double>, Dim * second_modes<Dim>> quadratic;
  std::vector<double> mass;              ///< kg (per metre of depth in plane strain)
  std::vector<double> density;           ///< kg/m^3
  std::vector<double> pressure;          ///< Pa, equation of state, compression positive
  std::vector<double> viscous_pressure;  ///< Pa, artificial viscosity q >= 0
  std::vector<double> internal_energy;   ///< J/kg
  std::vector<double> plastic_strain;
  std::vector<double> plastic_work;                               ///< J/kg, the part that is heat
  std::array<std::vector<double>, symmetric_size<Dim>> deviator;  ///< Pa, tension positive
  std::array<std::vector<double>, symmetric_size<Dim>> back_stress;  ///< Pa
  std::vector<double> conducted_heat;  ///< J/kg, received by conduction; part of internal_energy
  std::vector<std::int32_t> failed;    ///< 1 once the tension has exceeded the spall strength
  /// Unit vector out of the material towards the surface it is nearest to; 0 far from all.
  std::array<std::vector<double>, Dim> facing;

  std::size_t size() const { return id.size(); }
};

/// Calls visit(name, component, column) for every column in use, always in the same order.
/// `component` is -1 for scalars. The name and order are the checkpoint format.
template <class ParticlesType, class Visitor>
void for_each_column(ParticlesType& particles, Visitor&& visit) {
  const auto each = [&](std::string_view name, auto& columns) {
    for (std::size_t c = 0; c < columns.size(); ++c) visit(name, static_cast<int>(c), columns[c]);
  };
  visit("id", -1, particles.id);
  visit("grain", -1, particles.grain);
  visit("material", -1, particles.material);
  each("position", particles.position);
  each("velocity", particles.velocity);
  if (particles.options.affine) each("affine", particles.affine);
  if (particles.options.quadratic) each("quadratic", particles.quadratic);
  visit("mass", -1, particles.mass);
  visit("density", -1, particles.density);
  visit("pressure", -1, particles.pressure);
  visit("viscous_pressure", -1, particles.viscous_pressure);
  visit("internal_energy", -1, particles.internal_energy);
  visit("plastic_strain", -1, particles.plastic_strain);
  visit("plastic_work", -1, particles.plastic_work);
  each("deviator", particles.deviator);
  if (particles.options.back_stress) each("back_stress", particles.back_stress);
  if (particles.options.conducted_heat) visit("conducted_heat", -1, particles.conducted_heat);
  if (particles.options.failed) visit("failed", -1, particles.failed);
  if (particles.options.facing) each("facing", particles.facing);
}

/// Sets the number of particles; new ones are zero. Not collective.
template <int Dim>
void resize(Particles<Dim>& particles, std::size_t count);

/// Gives back memory that the columns hold beyond their length.
template <int Dim>
void release_spare(Particles<Dim>& particles);

/// Reorders all columns: new particle k is the old particle order[k]. A shorter order drops the
/// rest.
template <int Dim>
void reorder(const std::vector<std::uint32_t>& order, Particles<Dim>& particles);

/// Bytes one particle takes in all columns in use.
template <int Dim>
std::size_t bytes_per_particle(const Particles<Dim>& particles);

/// Appends particles of `source` at `indices` to a byte buffer, column after column. Not
/// collective.
template <int Dim>
void pack(const Particles<Dim>& source, const std::vector<std::uint32_t>& indices,
          std::vector<std::byte>& buffer);

/// Appends the `count` particles packed by pack() to `particles`. Not collective.
template <int Dim>
void unpack(const std::byte* buffer, std::size_t count, Particles<Dim>& particles);

}  // namespace poreshock
