#pragma once
// What an experimenter reads from the velocity trace of a surface.

#include <span>

namespace poreshock {

/// Numbers of a trace; NaN where the trace does not show them.
struct TraceFigures {
  double arrival = 0.0;         ///< s, when 40 % of jump_off are reached, between samples
  double jump_off = 0.0;        ///< m/s, change of the velocity when the wave arrives
  double pull_back = 0.0;       ///< m/s, jump_off less the least that follows before it rises again
  double pull_back_time = 0.0;  ///< s, of that least
  double spall_strength = 0.0;  ///< Pa, impedance x pull_back / 2
};

/// Figures of a velocity (m/s) over time (s), both of one length; samples that are NaN are left
/// out. The change is counted from the first sample, with the sign of the largest one. A pull-back
/// is a fall by a twentieth of the largest change or more of which a tenth comes back; jump_off is
/// the median of the samples within 5 % of the greatest before it: where the wave falls off right
/// behind its front, 2.5 % less than the peak. Arrival is a little before half of it,
/// which is the whole first jump of a gauge that a free surface moves twice. `impedance` is
/// rho c0, kg/(m^2 s). Pure function.
TraceFigures read_figures(std::span<const double> time, std::span<const double> velocity,
                          double impedance);

}  // namespace poreshock
