#include <algorithm>
#include <cmath>

#include "lattice.hpp"
#include "text.hpp"

namespace poreshock {
namespace {

/// "domain.cell to ... or less", the cell times a factor below 1; nothing helps at 0.
std::string finer(const Scene& scene, double factor) {
  return factor > 0.0 ? "domain.cell to " + length_text(scene.domain.cell * factor) + " or less"
                      : "sample.seed anew";
}

void warn_resolution(const Scene& scene, std::vector<std::string>& warnings) {
  constexpr double least_cells = 16.0;
  const double diameter = 2.0 * scene.sample.void_radius;
  const double cells = diameter / scene.domain.cell;
  if (cells >= least_cells) return;
  warnings.push_back("A void is only " + significant<4>(cells) +
                     " cells across; below 16 its collapse is not resolved. Set domain.cell to " +
                     length_text(diameter / least_cells) + " or less.");
}

void warn_radius(const Scene& scene, const SampleReport& report,
                 std::vector<std::string>& warnings) {
  if (scene.sample.void_spread > 0.0) return;
  const double made = report.voids.front().radius;
  if (std::fabs(made / scene.sample.void_radius - 1.0) <= 0.01) return;
  warnings.push_back("The voids have a radius of " + length_text(made) + " instead of " +
                     length_text(scene.sample.void_radius) + ": only so do " +
                     std::to_string(report.voids.size()) +
                     " whole voids make the porosity asked for.");
}

void warn_gaps(const Scene& scene, const SampleReport& report, std::vector<std::string>& warnings) {
  // Overlapping voids have no ligament to keep.
  if (scene.sample.overlap) return;
  const double spacing = make_lattice(scene).spacing;
  const std::string thinnest =
      "The thinnest solid between two voids is " + length_text(report.least_gap);
  if (report.least_gap < 3.0 * spacing) {
    warnings.push_back(thinnest + ", or " + significant<4>(report.least_gap / spacing) +
                       " particles; below 3 it may break numerically. Set sample.ligament to " +
                       length_text(3.0 * spacing) + " or more, or " +
                       finer(scene, report.least_gap / (3.0 * spacing)) + ".");
  }
  const auto [reach, shape] = of_shape(scene.transfer.shape, [](const auto& s) {
    return std::pair(s.closing_cells, std::string(s.name));
  });
  if (report.least_gap < reach * scene.domain.cell) {
    warnings.push_back(thinnest + ", or " + significant<4>(report.least_gap / scene.domain.cell) +
                       " cells; below " + significant<4>(reach) + " cells the " + shape +
                       " shape function joins what lies on its two sides, and gaps close "
                       "numerically before the surfaces meet. Set sample.ligament to " +
                       length_text(reach * scene.domain.cell) + " or more, or " +
                       finer(scene, report.least_gap / (reach * scene.domain.cell)) + ".");
  }
}

void warn_islands(const Scene& scene, const SampleReport& report,
                  std::vector<std::string>& warnings) {
  if (scene.sample.islands == Islands::grains) return;
  const double all = static_cast<double>(report.particles + report.island_particles);
  const double share = static_cast<double>(report.island_particles) / all;
  if (!(share > 0.01)) return;
  warnings.push_back("Floating pieces with " + significant<4>(100.0 * share) +
                     " % of the particles were removed, so that the porosity of the particles is " +
                     significant<4>(report.particle_void_fraction) +
                     ": the voids cut the solid apart. Lower sample.porosity or change "
                     "sample.seed.");
}

/// Edge of the square or cube of a grain's measure, cells.
double cells_across(const Scene& scene, const Grain& grain) {
  return std::pow(grain.measure, 1.0 / scene.dimension) / scene.domain.cell;
}

void warn_grains(const Scene& scene, const SampleReport& report,
                 std::vector<std::string>& warnings) {
  constexpr double least_cells = 8.0;
  std::size_t carriers = 0, coarse = 0;
  double least_carrier = 1.0, least_coarse = least_cells;
  for (const Grain& grain : report.grains) {
    const double cells = cells_across(scene, grain);
    if (cells < 1.0) {
      ++carriers;
      least_carrier = std::min(least_carrier, cells);
    } else if (cells < least_cells) {
      ++coarse;
      least_coarse = std::min(least_coarse, cells);
    }
  }
  const std::string all = " of " + std::to_string(report.grains.size()) + " grains ";
  if (carriers > 0) {
    warnings.push_back(std::to_string(carriers) + all +
                       "are smaller than a cell: they carry momentum, but neither rotation, "
                       "friction nor their gaps are resolved. Set " +
                       finer(scene, least_carrier) + ", or make the grains larger.");
  }
  if (coarse > 0) {
    warnings.push_back(std::to_string(coarse) + all + "are less than " +
                       significant<4>(least_cells) +
                       " cells across; their deformation is not resolved. Set " +
                       finer(scene, least_coarse / least_cells) + ".");
  }
}

/// What tells solid from void and one grain from the other may have been read otherwise than meant.
void warn_image(const Scene& scene, const SampleReport& report,
                std::vector<std::string>& warnings) {
  if (scene.sample.kind != SampleKind::image) return;
  const std::string image = "sample.image: " + scene.sample.image + " came out as ";
  if (report.geometric_void_fraction == 0.0) {
    warnings.push_back(image + "solid all over. " +
                       (scene.sample.threshold
                            ? "Void is what is transparent or below sample.threshold; raise it."
                            : "Void is what is transparent or has the label 0; give "
                              "sample.threshold if grey values tell solid from void."));
  } else if (report.grains.size() == 1) {
    warnings.push_back(image + "one grain, so that there is no contact. " +
                       (scene.sample.threshold
                            ? "Pixels of sample.threshold or more that share a side are one grain; "
                              "raise it, or give labels, to part grains."
                            : "Pixels of one label that share a side are one grain; give every "
                              "grain a label of its own to part them."));
  }
}

}  // namespace

std::vector<std::string> sample_warnings(const Scene& scene, const SampleReport& report) {
  std::vector<std::string> warnings;
  warn_image(scene, report, warnings);
  warn_grains(scene, report, warnings);
  if (report.voids.empty()) return warnings;
  warn_resolution(scene, warnings);
  warn_radius(scene, report, warnings);
  warn_gaps(scene, report, warnings);
  warn_islands(scene, report, warnings);
  return warnings;
}

}  // namespace poreshock
