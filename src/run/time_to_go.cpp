#include "poreshock/run/time_to_go.hpp"

#include <algorithm>

namespace poreshock {

namespace {

/// What else the machine does makes single rows swing; older ones count less and less.
constexpr double seconds_remembered = 10.0;

}  // namespace

double work_ahead(const WorkGrowth& growth, double span) {
  if (growth.slope <= 0.0) return growth.work * span;
  const double until_all = std::max(growth.most - growth.work, 0.0) / growth.slope;
  const double growing = std::min(until_all, span);
  return growth.work * growing + 0.5 * growth.slope * growing * growing +
         growth.most * (span - growing);
}

double seconds_to_go(const RunSoFar& now, double end, TimeToGo& estimate) {
  const RunSoFar before = estimate.row;
  const RunSoFar& start = estimate.start;
  const double steps = static_cast<double>(now.step - before.step);
  const double advanced = now.time - before.time;
  if (!(advanced > 0.0) || !(steps > 0.0)) return 0.0;
  estimate.row = now;
  const double all = now.particle_steps - before.particle_steps;
  const double asleep = now.sleeping_steps - before.sleeping_steps;
  const double work = (all - asleep + estimate.asleep * asleep) / steps;
  const double middle = before.time + 0.5 * advanced;
  if (estimate.first_time < 0.0) {
    estimate.first_work = work;
    estimate.first_time = middle;
  }
  WorkGrowth growth{work, 0.0, all / steps};
  if (middle > estimate.first_time) {
    growth.slope = (work - estimate.first_work) / (middle - estimate.first_time);
  }
  growth.work += growth.slope * 0.5 * advanced;
  const double wall = (now.wall - now.recorded) - (before.wall - before.recorded);
  const double cost = wall / (work * steps);
  const double weight = wall / (wall + seconds_remembered);
  estimate.cost = estimate.cost > 0.0 ? estimate.cost + (cost - estimate.cost) * weight : cost;
  const double so_far = now.time - start.time, span = end - now.time;
  const double steps_per_time = static_cast<double>(now.step - start.step) / so_far;
  const double records_per_time = (now.recorded - start.recorded) / so_far;
  return estimate.cost * steps_per_time * work_ahead(growth, span) + records_per_time * span;
}

}  // namespace poreshock
