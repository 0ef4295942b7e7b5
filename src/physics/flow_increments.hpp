#pragma once
// Plastic increments of a block of particles whose flow stress is not linear in the plastic strain.

#include <span>

#include "stress_point.hpp"

namespace poreshock {

/// Plastic increments of the particles at `places`, all of one material, for a step of dt (s);
/// false where it has no flow law. `c` holds their columns side by side, `increments` as many
/// numbers. Temperature, pressure and the molten share, which has no strength, are those of the
/// start of the step. Not collective.
template <int Dim>
bool plastic_increments(const std::vector<Material>& materials, Thermal thermal,
                        const Particles<Dim>& particles, std::span<const std::uint32_t> places,
                        const Columns<Dim>& c, double dt, double* increments);

}  // namespace poreshock
