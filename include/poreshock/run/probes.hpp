#pragma once
// Probes: which material they look at, and what they see. Also in probe_records.cpp.

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "poreshock/output/probe_file.hpp"
#include "poreshock/output/row_file.hpp"
#include "poreshock/run/backlog.hpp"
#include "poreshock/solver/simulation.hpp"

namespace poreshock {

/// The particles a probe follows; a point follows none.
struct ProbeTarget {
  std::vector<std::int64_t> ids;  ///< ascending
  int material = -1;              ///< of all of them; -1 when they differ
};

/// One probe of a run: what it follows, its file and the rows that are not yet in it.
struct ProbeRecorder {
  Probe probe;
  ProbeTarget target;
  std::shared_ptr<RowFile> file;  ///< shared with rows that wait
  std::string rows;               ///< ends of line between them
};

/// The particles that a probe follows, from those there are: of a surface, in every column of the
/// lattice within half the width of `at`, the one that started highest (lowest where it faces
/// down); of an interface, of those that started below `at` (above); of a particle, all that
/// started within half the width of `at`. The same on any number of ranks. Collective.
template <int Dim>
ProbeTarget find_target(const Probe& probe, const Simulation<Dim>& sim);

/// What a probe sees now. Particles it follows may have left: then the target is found anew. A
/// point weights what lies within width / sqrt 2 of it by 1 - (r / that)^2. The same bits on any
/// number of ranks. Collective.
template <int Dim>
ProbeRow look(const Probe& probe, const Simulation<Dim>& sim, ProbeTarget& target);

/// Throws InputError when no material starts where a probe looks. Collective.
template <int Dim>
void require_targets(const Simulation<Dim>& sim);

/// Opens the trace files of all probes of the scene. Collective.
template <int Dim>
std::vector<ProbeRecorder> open_probes(const std::string& folder, bool restarted,
                                       const Simulation<Dim>& sim);

/// Adds a row of every probe that is due after a step, or at the start. Collective.
template <int Dim>
void note_probes(const Simulation<Dim>& sim, std::vector<ProbeRecorder>& probes);

/// Hands the rows so far to the disk, or to the backlog. Collective.
void write_probe_rows(std::vector<ProbeRecorder>& probes, Backlog& backlog, MPI_Comm communicator);

/// Reads the traces of the folder, writes probes.h5 and prints a line for each. Rank 0 works.
/// Collective.
template <int Dim>
void finish_probes(const std::string& folder, const Simulation<Dim>& sim,
                   const std::vector<ProbeRecorder>& probes);

}  // namespace poreshock
