#pragma once
// The clock of a run and the choice of the next step.

#include <mpi.h>

#include <cstdint>

#include "poreshock/particles/cell_order.hpp"
#include "poreshock/scene/scene.hpp"

namespace poreshock {

/// Time of a run. Steps land exactly on multiples of the beat, and on the end.
struct Clock {
  std::int64_t step = 0;
  double time = 0.0;         ///< s
  std::int64_t beat = 0;     ///< last beat landed on
  double allowed = 0.0;      ///< s, step last allowed, before it was fitted to the beat
  double limit = 0.0;        ///< s, stable step; this rank's until agree_on_step, then the smallest
  double first_limit = 0.0;  ///< s, stable step of the initial state
  std::int64_t bad = 0;      ///< particles of this rank with a state gone bad
  bool on_beat = true;       ///< the last step landed on a beat or the end
  RowRange disturbed;        ///< rows a wave has reached: this rank's until agree_on_step, then all
};

/// What all ranks know after the one reduction of a step.
struct StepAgreement {
  bool bad_state = false;
  bool stop_asked = false;
};

/// Reduces stable step, disturbed rows, health and stop request over all ranks in one message.
/// Collective.
StepAgreement agree_on_step(bool stop_asked, Clock& clock, MPI_Comm communicator);

/// The next step, s: at most the stable one, at most 1.1 times the last, fitted so that whole steps
/// reach the next beat or the end. Throws StateError when the step has collapsed below 1e-5 of the
/// initial one. Not collective: the same on every rank.
double next_time_step(const Scene& scene, Clock& clock);

/// Moves the clock over dt. Not collective.
void tick(const Scene& scene, double dt, Clock& clock);

/// Number of beats of a cadence; 0 when it is off.
std::int64_t beats_of(double cadence, double beat);

}  // namespace poreshock
