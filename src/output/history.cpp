#include "poreshock/output/history.hpp"

#include "poreshock/output/row_file.hpp"

namespace poreshock {

namespace {

/// What an energy of a row is: none of the heat so far, heat, or heat that the numerics made.
enum class Heat { none, physical, numerical };

struct EnergyColumn {
  const char* name;
  double HistoryRow::*value;
  Heat heat = Heat::none;
};

/// Energies in the order of the file.
constexpr std::array<EnergyColumn, 16> energy_columns = {{
    {"kinetic", &HistoryRow::kinetic},
    {"internal", &HistoryRow::internal},
    {"escaped", &HistoryRow::escaped},
    {"wall_work", &HistoryRow::wall_work},
    {"body_work", &HistoryRow::body_work},
    {"total", &HistoryRow::total},
    {"elastic", &HistoryRow::elastic},
    {"compression_work", &HistoryRow::compression_work},
    {"plastic_work", &HistoryRow::plastic_work, Heat::physical},
    {"viscous_heat", &HistoryRow::viscous_heat, Heat::physical},
    {"filter_heat", &HistoryRow::filter_heat, Heat::numerical},
    {"step_heat", &HistoryRow::step_heat, Heat::numerical},
    {"wall_heat", &HistoryRow::wall_heat, Heat::physical},
    {"contact_heat", &HistoryRow::contact_heat, Heat::numerical},
    {"friction_heat", &HistoryRow::friction_heat, Heat::physical},
    {"conduction", &HistoryRow::conduction},
}};

struct MomentumColumn {
  const char* name;
  std::array<double, 3> HistoryRow::*value;
};

constexpr std::array<MomentumColumn, 5> momentum_columns = {{
    {"momentum", &HistoryRow::momentum},
    {"escaped_momentum", &HistoryRow::escaped_momentum},
    {"wall_impulse", &HistoryRow::wall_impulse},
    {"body_impulse", &HistoryRow::body_impulse},
    {"total_momentum", &HistoryRow::total_momentum},
}};

/// The same, only where the domain moves with the front.
constexpr std::array<EnergyColumn, 2> moving_energy_columns = {{
    {"handed_over", &HistoryRow::handed_over},
    {"taken_in", &HistoryRow::taken_in},
}};
constexpr std::array<MomentumColumn, 2> moving_momentum_columns = {{
    {"handed_over_momentum", &HistoryRow::handed_over_momentum},
    {"taken_in_momentum", &HistoryRow::taken_in_momentum},
}};

/// Calls visit(name, unit, value) for all numbers of a row in the order of the file.
template <class Visitor>
void for_each_value(const HistoryRow& row, int dimension, Visitor&& visit) {
  const bool plane = dimension == 2;
  visit("time", "s", row.time);
  visit("step", "-", row.step);
  visit("dt", "s", row.dt);
  visit("particles", "-", row.particles);
  const auto visit_energies = [&](const auto& columns) {
    for (const EnergyColumn& column : columns) {
      visit(column.name, plane ? "J/m" : "J", row.*column.value);
    }
  };
  const auto visit_momenta = [&](const auto& columns) {
    for (const MomentumColumn& column : columns) {
      for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a) {
        visit(std::string(column.name) + "_" + "xyz"[a], plane ? "kg/s" : "kg m/s",
              (row.*column.value)[a]);
      }
    }
  };
  visit_energies(energy_columns);
  visit_momenta(momentum_columns);
  visit("wall_force", plane ? "N/m" : "N", row.wall_force);
  visit("numerical_share", "-", numerical_share(row));
  visit("guards", "-", row.guards);
  if (row.follows) {
    visit_energies(moving_energy_columns);
    visit_momenta(moving_momentum_columns);
  }
  if (!row.contact) return;
  visit("contact_nodes", "-", row.contact->nodes);
  visit("crowded_nodes", "-", row.contact->crowded);
  visit("least_gap", "m", row.contact->least_gap);
  visit("penetration", "m", row.contact->penetration);
  visit("momentum_residual", "-", row.contact->residual);
}

}  // namespace

double all_heat(const HistoryRow& row) {
  double heat = 0.0;
  for (const EnergyColumn& column : energy_columns) {
    if (column.heat != Heat::none) heat += row.*column.value;
  }
  return heat;
}

double numerical_share(const HistoryRow& row) {
  const double heat = all_heat(row);
  double numerical = 0.0;
  for (const EnergyColumn& column : energy_columns) {
    if (column.heat == Heat::numerical) numerical += row.*column.value;
  }
  return heat > 0.0 ? numerical / heat : 0.0;
}

std::string history_header(int dimension, bool grains, bool follows) {
  HistoryRow row;
  row.follows = follows;
  if (grains) row.contact.emplace();
  std::string header;
  for_each_value(row, dimension, [&](const std::string& name, const char* unit, auto) {
    header.append(header.empty() ? "" : ",").append(name + " [" + unit + "]");
  });
  return header;
}

std::string history_line(const HistoryRow& row, int dimension) {
  std::string line;
  for_each_value(row, dimension,
                 [&](const std::string&, const char*, auto value) { add_entry(value, line); });
  return line;
}

}  // namespace poreshock
