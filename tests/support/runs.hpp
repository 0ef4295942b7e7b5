#pragma once
// Small scenes and a bare time loop for tests of whole steps.

#include <functional>
#include <string>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"
#include "poreshock/scene/read_scene.hpp"
#include "poreshock/scene/transfer_scheme.hpp"
#include "poreshock/solver/ownership.hpp"
#include "poreshock/solver/start.hpp"

namespace poreshock::test {

inline constexpr const char* aluminium_text = R"(
[[material]]
name = "aluminium"
density = 2700
young = 69e9
poisson = 0.33
yield = 120e6
hardening = 384e6
c0 = 5350
lambda = 1.34
gamma = 2.0
cv = 880
)";

/// Porous block of 20 x 40 cells (void fraction 0.2) that hits a wall at 1100 m/s; `more` is TOML.
inline std::string porous_text(const std::string& more = "") {
  return std::string(R"(
title = "porous block"
[domain]
size = [0.2e-3, 0.44e-3]
cell = 10e-6
periodic = true
[boundary]
low = "wall"
high = "free"
[sample]
kind = "random_voids"
height = 0.4e-3
porosity = 0.2
void_radius = 30e-6
[loading]
velocity = 1100
[time]
end = 1e-6
)")
      .append(aluminium_text)
      .append(more);
}

/// Block of 6 x 6 x 14 cells with spherical voids (void fraction 0.08) that hits a wall at 1100
/// m/s.
inline std::string balls_text() {
  return std::string(R"(
[domain]
size = [60e-6, 60e-6, 160e-6]
cell = 10e-6
periodic = true
[boundary]
low = "wall"
[sample]
kind = "random_voids"
height = 140e-6
porosity = 0.08
void_radius = 18e-6
[loading]
velocity = 1100
[time]
end = 1e-6
)") + aluminium_text;
}

/// Bed of 14 grains of 30 um radius on 20 x 34 cells that hits a wall at 1100 m/s.
inline std::string grains_text(const std::string& more = "") {
  return std::string(R"(
title = "bed of grains"
[domain]
size = [0.2e-3, 0.34e-3]
cell = 10e-6
periodic = true
[boundary]
low = "wall"
high = "free"
[sample]
kind = "packed_grains"
height = 0.3e-3
porosity = 0.3
grain_radius = 30e-6
grain_spread = 0.2
[loading]
velocity = 1100
[contact]
friction = 0.3
[time]
end = 1e-6
)")
      .append(aluminium_text)
      .append(more);
}

inline Scene scene_of(const std::string& text, const std::vector<std::string>& overrides = {}) {
  return parse_scene(text, "test", overrides);
}

/// A scene whose scheme is APIC, with an artificial viscosity that is not limited where the text
/// has none, unless the overrides say otherwise; what keeps a residual is then undamped. The
/// default scheme is measured by plane impacts and porous samples.
inline Scene plain_scene_of(const std::string& text,
                            const std::vector<std::string>& overrides = {}) {
  std::string scheme = "\n[transfer]\nvelocity = \"apic\"\ndamping = 0.0\n";
  if (text.find("[viscosity]") == std::string::npos) {
    scheme += "[viscosity]\nlimited = false\nlinear = 0.6\nquadratic = 2.25\n";
  }
  return scene_of(text + scheme, overrides);
}

/// Runs to `step`, with a forced rebalance every `rebalance_every` steps (0 = never). Collective.
template <int Dim>
void advance_to(std::int64_t step, std::int64_t rebalance_every, Simulation<Dim>& sim) {
  while (sim.clock.step < step && sim.clock.time < sim.scene.time.end) {
    const StepAgreement agreement = agree_on_step(false, sim.clock, sim.communicator);
    if (agreement.bad_state)
      throw StateError("state gone bad at " + std::to_string(sim.clock.step));
    follow_front(sim);
    const double dt = next_time_step(sim.scene, sim.clock);
    advance(sim, dt);
    tick(sim.scene, dt, sim.clock);
    migrate(sim);
    if (rebalance_every > 0 && sim.clock.step % rebalance_every == 0) distribute(sim);
  }
}

/// The overrides of every velocity transfer, on cubic splines, which carry all of them.
inline std::vector<std::vector<std::string>> all_transfers() {
  std::vector<std::vector<std::string>> overrides;
  for (const TransferScheme& one : transfer_schemes) {
    overrides.push_back({"transfer.velocity=" + std::string(one.name)});
  }
  return overrides;
}

/// Calls action(communicator) on a communicator of the first `ranks` ranks; others wait. Collective
/// over all ranks, which must be at least `ranks`.
inline void on_ranks(int ranks, const std::function<void(MPI_Comm)>& action) {
  MPI_Comm part = MPI_COMM_NULL;
  const int me = rank(MPI_COMM_WORLD);
  MPI_Comm_split(MPI_COMM_WORLD, me < ranks ? 0 : MPI_UNDEFINED, me, &part);
  if (part != MPI_COMM_NULL) {
    action(part);
    MPI_Comm_free(&part);
  }
  MPI_Barrier(MPI_COMM_WORLD);
}

/// Value that rank 0 holds, on all ranks. Collective.
template <class T>
T from_rank_zero(T value) {
  MPI_Bcast(&value, sizeof value, MPI_BYTE, 0, MPI_COMM_WORLD);
  return value;
}

/// Particle-steps whose transfer took heat away, on all ranks: a fault of the scheme. Collective.
template <int Dim>
std::int64_t negative_heats(const Simulation<Dim>& sim) {
  return sum(sim.ledger.guards.negative_heat, sim.communicator);
}

/// What of the internal energy between two rows has no name, J: a fault of the account.
inline double unnamed_energy(const HistoryRow& before, const HistoryRow& after) {
  const auto named = [](const HistoryRow& row) {
    return row.elastic + row.compression_work + row.conduction + all_heat(row);
  };
  return (after.internal - before.internal) - (named(after) - named(before));
}

/// Energies and momentum of all ranks.
template <int Dim>
HistoryRow stock(const Simulation<Dim>& sim) {
  return take_stock(sim.scene, sim.materials, sim.particles, sim.ledger, sim.communicator);
}

}  // namespace poreshock::test
