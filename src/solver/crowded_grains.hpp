#pragma once
// What to do about grains that have more neighbours than there are velocity fields.

#include "poreshock/core/error.hpp"
#include "poreshock/solver/simulation.hpp"

namespace poreshock {

/// Throws what colour_grains found again, with what to change: before the first step as InputError,
/// a fault of the scene, later as StateError.
template <int Dim>
[[noreturn]] void throw_crowded(const StateError& crowd, const Simulation<Dim>& sim);

}  // namespace poreshock
