#include "crowded_grains.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

namespace poreshock {

namespace {

/// Cells across a grain from which on its deformation is resolved.
constexpr double resolved_cells = 8.0;

/// Edge of the square or cube of a generated grain's mean measure, m; 0 without such grains.
double mean_edge(const SampleReport& report, int dimension) {
  double sum = 0.0;
  for (const Grain& grain : report.grains) sum += grain.measure;
  const auto count = static_cast<double>(std::max<std::size_t>(1, report.grains.size()));
  return std::pow(sum / count, 1.0 / dimension);
}

}  // namespace

template <int Dim>
void throw_crowded(const StateError& crowd, const Simulation<Dim>& sim) {
  const double cell = sim.scene.domain.cell, edge = mean_edge(sim.sample, Dim);
  std::ostringstream text;
  text.precision(3);
  text << crowd.what() << "; grains are near each other where less than "
       << sim.grid->shape().stencil << " cells lie between their particles";
  if (edge > 0.0) text << ", and these are " << edge / cell << " cells across. ";
  text << (edge > 0.0 ? "Set domain.cell to " : ". Set domain.cell finer");
  if (edge > 0.0) text << std::min(edge / resolved_cells, 0.5 * cell) << " m or less";
  text << ", raise sample.porosity or sample.grain_gap, make the grains larger, or take a "
          "transfer.shape of a narrower stencil.";
  if (sim.clock.step == 0) throw InputError("at the start " + text.str());
  throw StateError("at step " + std::to_string(sim.clock.step) + " " + text.str());
}

template void throw_crowded<2>(const StateError&, const Simulation<2>&);
template void throw_crowded<3>(const StateError&, const Simulation<3>&);

}  // namespace poreshock
