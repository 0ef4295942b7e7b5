#include "energy.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

#include "poreshock/core/error.hpp"

namespace poreshock {

EnergyStatus energy_status(const Ledger& ledger, const HistoryRow& row) {
  const double first = ledger.first_total.value_or(row.total);
  return {row.kinetic, row.internal, first != 0.0 ? row.total / first - 1.0 : 0.0};
}

template <int Dim>
void require_closed_ledger(const Simulation<Dim>& sim, const HistoryRow& row) {
  constexpr double most = 1e-6;
  const double first = sim.ledger.first_total.value_or(row.total);
  const double scale = std::max(std::abs(first), row.kinetic + std::abs(row.internal));
  if (std::abs(row.total - first) <= most * scale) return;
  const char* unit = Dim == 2 ? "J/m" : "J";
  char text[200];
  std::snprintf(
      text, sizeof text,
      "at step %lld, time %.6g ns, the energy is %.6g %s, it was %.6g %s at the start: the "
      "results since the record before are wrong",
      static_cast<long long>(sim.clock.step), sim.clock.time * 1e9, row.total, unit, first, unit);
  throw StateError(std::string(text) +
                   ". Something changed the particles behind the program's back, a fault of the "
                   "memory or of poreshock; restart from the newest checkpoint");
}

void show_heat(const HistoryRow& row, const Scene& scene, long long shortened) {
  constexpr double most = 0.15;
  const double heat = all_heat(row);
  if (!(heat > 0.0)) return;
  const auto percent = [&](double part) { return 100.0 * part / heat; };
  std::printf(
      "heat: plastic %.1f %%, viscous %.1f %%, wall and friction %.1f %%; numerical dissipation "
      "%.1f %% (filter %.1f, steps %.1f, contact %.1f); modes shortened %lld times\n",
      percent(row.plastic_work), percent(row.viscous_heat),
      percent(row.wall_heat + row.friction_heat), 100.0 * numerical_share(row),
      percent(row.filter_heat), percent(row.step_heat), percent(row.contact_heat), shortened);
  if (numerical_share(row) <= most) return;
  std::printf(
      "warning: numerical dissipation is %.0f %% of all heat; above 15 %% the cells are too coarse "
      "for the heat of this sample. Set domain.cell to %.3g m or less.\n",
      100.0 * numerical_share(row), 0.5 * scene.domain.cell);
}

template void require_closed_ledger<2>(const Simulation<2>&, const HistoryRow&);
template void require_closed_ledger<3>(const Simulation<3>&, const HistoryRow&);

}  // namespace poreshock
