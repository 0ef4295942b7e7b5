#include "poreshock/solver/time_step.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "poreshock/core/error.hpp"
#include "poreshock/core/parallel.hpp"

namespace poreshock {

namespace {

constexpr double largest_growth = 1.1;
constexpr double collapse_share = 1.0e-5;

/// Times closer than this share of a beat are the same.
constexpr double same_time = 1.0e-9;

double next_target(const Scene& scene, const Clock& clock) {
  const double next_beat = static_cast<double>(clock.beat + 1) * scene.output.beat;
  const bool before_end = scene.time.end - next_beat > same_time * scene.output.beat;
  return before_end ? next_beat : scene.time.end;
}

}  // namespace

StepAgreement agree_on_step(bool stop_asked, Clock& clock, MPI_Comm communicator) {
  // All as minima: the limit, flags that are -1 when raised, and the ends of the disturbed rows.
  double values[5] = {clock.limit, clock.bad > 0 ? -1.0 : 0.0, stop_asked ? -1.0 : 0.0,
                      static_cast<double>(clock.disturbed.first),
                      -static_cast<double>(clock.disturbed.last)};
  check_mpi(MPI_Allreduce(MPI_IN_PLACE, values, 5, MPI_DOUBLE, MPI_MIN, communicator),
            "MPI_Allreduce of the time step");
  clock.limit = values[0];
  clock.disturbed = {static_cast<int>(values[3]), static_cast<int>(-values[4])};
  return {values[1] < 0.0, values[2] < 0.0};
}

double next_time_step(const Scene& scene, Clock& clock) {
  if (clock.step == 0) {
    // The impact is not yet in the state: the first steps are short and grow.
    clock.first_limit = clock.limit;
    clock.allowed = 0.1 * clock.limit;
  } else {
    clock.allowed = std::min(clock.limit, largest_growth * clock.allowed);
  }
  if (!(clock.allowed > collapse_share * clock.first_limit)) {
    std::ostringstream text;
    text << "the time step collapsed to " << clock.allowed << " s at step " << clock.step
         << ", time " << clock.time << " s (it began with " << clock.first_limit
         << " s): a particle moves or deforms far too fast; look at failed.h5, try a larger "
            "viscosity.linear or a smaller time.cfl";
    throw StateError(text.str());
  }
  const double remaining = next_target(scene, clock) - clock.time;
  const double steps = std::max(1.0, std::ceil(remaining / clock.allowed * (1.0 - 1.0e-12)));
  return remaining / steps;
}

void tick(const Scene& scene, double dt, Clock& clock) {
  const double target = next_target(scene, clock);
  const double remaining = target - clock.time;
  ++clock.step;
  // The last step of a beat takes all that remains; landing is exact.
  clock.on_beat = dt > 0.75 * remaining;
  if (!clock.on_beat) {
    clock.time += dt;
    return;
  }
  clock.time = target;
  const double next_beat = static_cast<double>(clock.beat + 1) * scene.output.beat;
  if (std::abs(target - next_beat) <= same_time * scene.output.beat) ++clock.beat;
}

std::int64_t beats_of(double cadence, double beat) {
  return cadence > 0.0 ? std::max<std::int64_t>(1, std::llround(cadence / beat)) : 0;
}

}  // namespace poreshock
