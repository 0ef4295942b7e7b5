#pragma once
// The rows of history.csv: totals of a run, one row per record.

#include <array>
#include <cstdint>
#include <optional>
#include <string>

namespace poreshock {

/// Contact between grains in the last step, over all ranks.
struct ContactRow {
  std::int64_t nodes = 0;    ///< at which grains pushed each other
  std::int64_t crowded = 0;  ///< at which more than two grains met
  double least_gap = 0.0;    ///< m, of all nodes that two grains share; infinite without one
  double penetration = 0.0;  ///< m, largest by which grains overfill a node
  double residual = 0.0;     ///< largest share of a node's impulses that did not cancel
};

/// Totals of a run at one time; energies in J (J per metre of depth in plane strain).
struct HistoryRow {
  double time = 0.0;  ///< s
  std::int64_t step = 0;
  double dt = 0.0;  ///< s
  std::int64_t particles = 0;
  double kinetic = 0.0;
  double internal = 0.0;
  double escaped = 0.0;
  double wall_work = 0.0;
  double body_work = 0.0;
  double total = 0.0;
  double elastic = 0.0;
  double compression_work = 0.0;
  double plastic_work = 0.0;
  double viscous_heat = 0.0;
  double filter_heat = 0.0;
  double step_heat = 0.0;
  double wall_heat = 0.0;
  double contact_heat = 0.0;
  double friction_heat = 0.0;
  double conduction = 0.0;
  std::array<double, 3> momentum{};  ///< kg m/s (kg/s in plane strain, where z is not written)
  std::array<double, 3> escaped_momentum{};  ///< of particles that left
  std::array<double, 3> wall_impulse{};      ///< given to the material by walls and symmetry planes
  std::array<double, 3> body_impulse{};      ///< given by the body force
  /// momentum + escaped + handed over - taken in - wall and body impulse: constant
  std::array<double, 3> total_momentum{};
  double wall_force = 0.0;  ///< N (N/m), shock axis, of walls and symmetry planes on the material,
                            ///< mean since the row before; 0 in the first row
  std::int64_t guards = 0;  ///< clamps and floors so far
  bool follows = false;     ///< with the following, of a domain that moves with the front
  double handed_over = 0.0, taken_in = 0.0;
  std::array<double, 3> handed_over_momentum{}, taken_in_momentum{};
  std::optional<ContactRow> contact;  ///< only in runs of several grains
};

/// All heat so far, J (J/m in plane strain): plastic, viscous, filter, step, wall, contact and
/// friction. With the changes of `elastic`, `compression_work` and `conduction` it makes that of
/// `internal`, unless particles leave or come.
double all_heat(const HistoryRow& row);

/// Share of all heat that the numerics made, of the filter of the transfer, of steps and of
/// inelastic contact; 0 without heat.
double numerical_share(const HistoryRow& row);

/// First line of the file, without its end of line. `grains`: with the columns of contact;
/// `follows`: with those of a domain that moves with the front.
std::string history_header(int dimension, bool grains, bool follows = false);

/// One line of the file, without its end of line; 17 significant digits.
std::string history_line(const HistoryRow& row, int dimension);

}  // namespace poreshock
