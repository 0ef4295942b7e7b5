#pragma once
// Private to solver: end surfaces of the sample that have material behind them.

#include "poreshock/solver/simulation.hpp"

namespace poreshock {

/// Forces of the materials behind on the nodes, from the particles that started in the lowest and
/// in the highest layer of the sample: each stands for its share of the end surface and moves into
/// the material behind with its own velocity. Only with sim.ends. Collective (one exchange).
template <int Dim>
void sum_ends(Simulation<Dim>& sim);

}  // namespace poreshock
