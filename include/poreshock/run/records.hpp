#pragma once
// What a run writes while it goes on.

#include <memory>
#include <optional>
#include <string>

#include "poreshock/morphology/pixel_map.hpp"
#include "poreshock/output/history.hpp"
#include "poreshock/output/row_file.hpp"
#include "poreshock/run/backlog.hpp"
#include "poreshock/run/probes.hpp"
#include "poreshock/solver/simulation.hpp"

namespace poreshock {

/// Output of one run: folder, open history, and when what is due.
template <int Dim>
struct Recorder {
  std::string folder;
  std::shared_ptr<RowFile> history;  ///< shared with rows that wait
  std::vector<ProbeRecorder> probes;
  std::unique_ptr<PixelGrid<Dim>> pixels;  ///< only with morphology
  HistoryRow last_row;                     ///< latest row of the history
  double last_checkpoint_wall = 0.0;       ///< s
  std::int64_t last_checkpoint_step = -1;
  std::int64_t first_unforced = 0;  ///< earlier records were forced to disk with a checkpoint
  Backlog backlog;                  ///< what the disk did not take
};

/// The pixel grid of the scene's morphology; none without. Throws InputError when the map of the
/// domain, or of a strip of it, has fewer rows than there are ranks. Collective.
template <int Dim>
std::unique_ptr<PixelGrid<Dim>> make_pixels(const Simulation<Dim>& sim);

/// Opens the history, after the folder was prepared. Collective.
template <int Dim>
Recorder<Dim> make_recorder(const std::string& folder, bool restarted,
                            std::unique_ptr<PixelGrid<Dim>> pixels, const Simulation<Dim>& sim);

/// Writes what is due at the beat the clock is on (all of it at the start and the end). What the
/// disk does not take waits in memory or, snapshots, is left out, with a warning; at the end it is
/// a SystemError on all ranks. Collective.
template <int Dim>
void record(bool last, Simulation<Dim>& sim, Recorder<Dim>& recorder);

/// First line of the history of a run.
template <int Dim>
std::string history_header(const Simulation<Dim>& sim) {
  return history_header(Dim, has_contact(sim), follows_front(sim.scene));
}

/// Writes a checkpoint when one is due by steps, simulated time or wall time; one that the disk
/// does not take costs a warning. Collective.
template <int Dim>
void checkpoint_when_due(double wall_seconds, Simulation<Dim>& sim, Recorder<Dim>& recorder);

/// Writes a checkpoint now, after the records that wait, and returns its path. SystemError on all
/// ranks when it cannot be written. Collective.
template <int Dim>
std::string checkpoint_now(Simulation<Dim>& sim, Recorder<Dim>& recorder);

/// Writes failed.h5, the state that went bad; costs a warning when the disk does not take it.
/// Collective.
template <int Dim>
void write_failed_state(Simulation<Dim>& sim, Recorder<Dim>& recorder);

}  // namespace poreshock
