#pragma once
// What of a run that is about to start can hardly be meant.

#include <string>
#include <vector>

#include "poreshock/solver/simulation.hpp"

namespace poreshock {

/// Plain sentences about material that leaves at once, nothing to hit, and grains that take nearly
/// all velocity fields; each names the keys to change. Collective.
template <int Dim>
std::vector<std::string> motion_warnings(const Simulation<Dim>& sim);

/// All of them: those of the scene's units and thresholds, of its bodies, and of its motion.
/// Collective.
template <int Dim>
std::vector<std::string> start_warnings(const Simulation<Dim>& sim);

}  // namespace poreshock
