#pragma once
// Where every joule is: exact cumulative sums of what nodes, transfers and sides take and give, and
// totals over the particles.

#include "poreshock/output/history.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/physics/node_ledger.hpp"
#include "poreshock/scene/scene.hpp"

namespace poreshock {

/// Counters of clamps and floors, cumulative on this rank.
struct Guards {
  std::int64_t compression = 0;    ///< reference curve continued by its tangent
  std::int64_t sound_speed = 0;    ///< sound speed floored
  std::int64_t wall_crossing = 0;  ///< particle put back onto a wall
  std::int64_t temperature = 0;    ///< temperature floored in output
  std::int64_t pixel = 0;          ///< particle cut, held or left out in a pixel map
  std::int64_t negative_heat = 0;  ///< heat of the transfer below zero beyond rounding
};

/// One of the guards, as the end of a run names it.
struct GuardCounter {
  const char* name;
  std::int64_t Guards::*count;
};

/// All guards, in the order of the checkpoint format.
inline constexpr std::array<GuardCounter, 6> guard_counters = {{
    {"compression", &Guards::compression},
    {"sound speed", &Guards::sound_speed},
    {"wall", &Guards::wall_crossing},
    {"temperature", &Guards::temperature},
    {"pixel", &Guards::pixel},
    {"negative heat", &Guards::negative_heat},
}};

/// What particles take along when they leave, or bring when they come.
struct Passage {
  Int128 energy = 0;
  Int128 mass = 0;  ///< quanta of mass, see mass_quantum
  std::array<Int128, 3> momentum{};
  std::int64_t particles = 0;
};

/// Cumulative sums of this rank since the start; only the sum over all ranks has a meaning.
struct Ledger {
  double energy_quantum = 1.0;    ///< J
  double momentum_quantum = 1.0;  ///< kg m/s
  NodeLedger nodes;
  Int128 viscous_heat = 0, compression_work = 0;
  Int128 step_heat = 0;        ///< work that is neither stored nor dissipated by the material
  Int128 failure_heat = 0;     ///< of deviators of particles that failed
  Int128 transfer_heat = 0;    ///< filter heat
  std::int64_t shortened = 0;  ///< particle-steps whose modes lost a tenth to it
  Int128 conduction = 0;       ///< heat gained by conduction: round-off
  Passage escaped;
  bool follows = false;            ///< the following are counted
  Passage handed_over, taken_in;   ///< at the low and at the high side of a domain that moves
  Int128 handed_plastic_work = 0;  ///< of what was handed over
  Int128 row_wall_impulse = 0;     ///< along the shock axis, when the last history row was written
  double row_time = 0.0;           ///< s, of the last history row
  std::optional<double> first_total;  ///< J, total energy of the first history row of the run
  Guards guards;
};

/// Quantum of mass, kg: a power of two like the other two, and made of them.
inline double mass_quantum(const Ledger& ledger) {
  return ledger.momentum_quantum * ledger.momentum_quantum / ledger.energy_quantum;
}

/// Sets the quanta of energy (J) and momentum (kg m/s), powers of two, everywhere they stand.
void set_quanta(double energy, double momentum, Ledger& ledger);

/// Quanta from the heaviest particle and the velocities of the scene: fine enough that rounding
/// stays below 1e-13 of the total, coarse enough that no sum overflows. Collective.
template <int Dim>
Ledger make_ledger(const Scene& scene, const std::vector<Material>& materials,
                   const Particles<Dim>& particles, MPI_Comm communicator);

/// Totals of the run for one row of the history; time, step and dt are left alone. Collective.
template <int Dim>
HistoryRow take_stock(const Scene& scene, const std::vector<Material>& materials,
                      const Particles<Dim>& particles, const Ledger& ledger, MPI_Comm communicator);

/// Mean force of walls and symmetry planes on the material along the shock axis from the last
/// mark_row to `time` (s), N (N/m in plane strain); 0 when no time has passed. Collective.
double mean_wall_force(const Ledger& ledger, int dimension, double time, MPI_Comm communicator);

/// Remembers the wall impulse at `time` for the next mean_wall_force. Not collective.
void mark_row(int dimension, double time, Ledger& ledger);

/// Books a particle that leaves or comes, with the quanta of the ledger. Not collective.
template <int Dim>
void book(const Particles<Dim>& particles, std::size_t p, double inertia, const Ledger& ledger,
          Passage& passage);

/// All sums of the ledger over all ranks as integers, for a checkpoint. Collective.
std::vector<std::int64_t> save(const Ledger& ledger, MPI_Comm communicator);

/// Restores what save() gave; rank 0 takes the sums, the others start from zero. Not collective.
void restore(const std::vector<std::int64_t>& words, bool root, Ledger& ledger);

}  // namespace poreshock
