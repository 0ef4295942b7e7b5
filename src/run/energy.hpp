#pragma once
// The balance of energy as a run tells it. Private to the layer.

#include "poreshock/output/history.hpp"
#include "poreshock/run/progress.hpp"
#include "poreshock/solver/simulation.hpp"

namespace poreshock {

/// Energies of the newest row of the history.
EnergyStatus energy_status(const Ledger& ledger, const HistoryRow& row);

/// Throws StateError when the energy is not that of the start any more, on all ranks alike.
/// Round-off reaches 1e-13; what is above it has changed the particles without a name in the
/// ledger.
template <int Dim>
void require_closed_ledger(const Simulation<Dim>& sim, const HistoryRow& row);

/// Where the heat of the run came from, in percent, and how often the transfer shortened modes that
/// would have made it negative; with a warning where the numerics made too much.
void show_heat(const HistoryRow& row, const Scene& scene, long long shortened);

}  // namespace poreshock
