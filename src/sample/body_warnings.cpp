#include <algorithm>
#include <cmath>
#include <map>
#include <optional>

#include "lattice.hpp"
#include "poreshock/sample/bodies.hpp"
#include "text.hpp"

namespace poreshock {
namespace {

constexpr const char* axis_names = "xyz";

/// Bodies or voids that have something in common, named by the first few of them.
class Found {
 public:
  explicit Found(const char* list) : list_(list) {}
  void add(std::size_t index) { indices_.push_back(index); }
  bool none() const { return indices_.empty(); }
  bool one() const { return indices_.size() == 1; }
  std::size_t first() const { return indices_.front(); }
  std::string names() const {
    constexpr std::size_t most = 3;
    std::string text;
    for (std::size_t i = 0; i < std::min(most, indices_.size()); ++i) {
      text += (i == 0 ? "" : ", ") + std::string(list_) + "." + std::to_string(indices_[i]);
    }
    if (indices_.size() <= most) return text;
    return text + " and " + std::to_string(indices_.size() - most) + " more";
  }

 private:
  const char* list_;
  std::vector<std::size_t> indices_;
};

std::string domain_text(const Scene& scene) {
  std::string text;
  for (int axis = 0; axis < scene.dimension; ++axis) {
    text += (axis == 0 ? "0 to " : ", 0 to ") + length_text(scene.domain.size[axis]) + " along " +
            axis_names[axis];
  }
  return text;
}

bool is_outside(const Scene& scene, const Region& region) {
  const Box box = bounding_box(region);
  for (int axis = 0; axis < scene.dimension; ++axis) {
    if (box.high[axis] <= 0.0 || box.low[axis] >= scene.domain.size[axis]) return true;
  }
  return false;
}

/// True when a layer of particles or more of the region lies outside of the domain.
bool is_cut(const Scene& scene, const Region& region) {
  const Box box = bounding_box(region);
  const double slack = 0.5 * make_lattice(scene).spacing * (1.0 + 1e-9);
  for (int axis = 0; axis < scene.dimension; ++axis) {
    if (box.low[axis] < -slack || box.high[axis] > scene.domain.size[axis] + slack) return true;
  }
  return false;
}

void warn_empty(const Scene& scene, const char* list, const std::vector<const Region*>& regions,
                const std::vector<RegionSites>& sites, std::vector<std::string>& warnings) {
  Found outside(list), small(list);
  for (std::size_t i = 0; i < sites.size(); ++i) {
    if (sites[i].inside > 0) continue;
    (is_outside(scene, *regions[i]) ? outside : small).add(i);
  }
  if (!outside.none()) {
    warnings.push_back(outside.names() + (outside.one() ? " lies" : " lie") +
                       " outside of the domain (" + domain_text(scene) +
                       ") and counts for nothing. Move it inside, or raise domain.size.");
  }
  if (small.none()) return;
  warnings.push_back(small.names() + (small.one() ? " is" : " are") +
                     " smaller than a particle: no lattice site lies in it. Make it at least " +
                     length_text(make_lattice(scene).spacing) +
                     " wide, or set domain.cell finer or sample.particles_per_cell higher.");
}

void warn_cut(const Scene& scene, const SampleReport& report, std::vector<std::string>& warnings) {
  Found cut("body");
  for (std::size_t b = 0; b < report.bodies.size(); ++b) {
    if (report.bodies[b].inside > 0 && is_cut(scene, scene.bodies[b].region)) cut.add(b);
  }
  if (cut.none()) return;
  const bool periodic = scene.domain.periodic[0] || scene.domain.periodic[1];
  warnings.push_back(cut.names() + (cut.one() ? " reaches" : " reach") + " out of the domain (" +
                     domain_text(scene) + "): what lies outside is left out" +
                     (periodic ? ", also at periodic sides: give the rest as a [[body]] of its "
                                 "own, moved by domain.size"
                               : "") +
                     ". Move it, or raise domain.size.");
}

void warn_taken(const SampleReport& report, std::vector<std::string>& warnings) {
  Found over("body"), under("body"), idle("void");
  std::int64_t taken = 0;
  for (std::size_t b = 0; b < report.bodies.size(); ++b) {
    const RegionSites& sites = report.bodies[b];
    if (sites.taken > 0) over.add(b), taken += sites.taken;
    if (sites.inside > 0 && sites.left == 0) under.add(b);
  }
  for (std::size_t v = 0; v < report.hollows.size(); ++v) {
    if (report.hollows[v].inside > 0 && report.hollows[v].taken == 0) idle.add(v);
  }
  if (!over.none()) {
    warnings.push_back(over.names() + (over.one() ? " replaces " : " replace ") +
                       std::to_string(taken) +
                       " particles that lie under it, of the sample or of a [[body]] before it. If "
                       "that is not meant, move it, or cut a [[void]] after it.");
  }
  if (!under.none()) {
    warnings.push_back(under.names() +
                       " has no particle left: bodies or voids after it take its whole place. "
                       "Change their order, move it, or leave it out.");
  }
  if (idle.none()) return;
  warnings.push_back(idle.names() + (idle.one() ? " takes" : " take") +
                     " nothing away: there is no material in it. Move it, or leave it out.");
}

/// Twice the signed area of a triangle.
double turn(const Triple& a, const Triple& b, const Triple& p) {
  return (b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]);
}

bool cross(const Triple& a, const Triple& b, const Triple& c, const Triple& d) {
  const auto apart = [](double s, double t) {
    return (s > 0.0 && t < 0.0) || (s < 0.0 && t > 0.0);
  };
  return apart(turn(a, b, c), turn(a, b, d)) && apart(turn(c, d, a), turn(c, d, b));
}

/// The first two edges of a polygon that cross, by the number of the corner they begin at.
std::optional<std::pair<std::size_t, std::size_t>> crossing(const std::vector<Triple>& points) {
  const std::size_t n = points.size();
  for (std::size_t i = 0; i < n; ++i) {
    for (std::size_t j = i + 2; j < n; ++j) {
      if (cross(points[i], points[(i + 1) % n], points[j], points[(j + 1) % n])) {
        return std::pair(i, j);
      }
    }
  }
  return std::nullopt;
}

void warn_crossing(const char* list, const std::vector<const Region*>& regions,
                   std::vector<std::string>& warnings) {
  Found found(list);
  std::string edges;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    if (regions[i]->shape != BodyShape::polygon) continue;
    const auto pair = crossing(regions[i]->points);
    if (!pair) continue;
    if (found.none()) {
      edges = "the edges from points " + std::to_string(pair->first) + " and " +
              std::to_string(pair->second);
    }
    found.add(i);
  }
  if (found.none()) return;
  warnings.push_back(found.names() + (found.one() ? " crosses itself" : " cross themselves") +
                     ": " + edges + (found.one() ? "" : " of the first one") +
                     " meet, so that parts of it are holes. Give the points in their order around "
                     "it.");
}

/// Pieces of one grain share one velocity field, which lets them neither rebound nor slide, unless
/// the grain has contact with itself.
void warn_welds(const Scene& scene, std::vector<std::string>& warnings) {
  if (scene.contact.self) return;
  const Body sample;
  std::map<int, std::pair<std::string, const Body*>> first;
  const SampleKind kind = scene.sample.kind;
  if (kind == SampleKind::solid || kind == SampleKind::random_voids) {
    first[0] = {"the sample", &sample};
  }
  std::map<int, std::string> welded;
  for (std::size_t b = 0; b < scene.bodies.size(); ++b) {
    const Body& body = scene.bodies[b];
    const std::string name = "body." + std::to_string(b);
    const auto [at, is_new] = first.emplace(body.grain, std::pair(name, &body));
    const auto& [other_name, other] = at->second;
    if (is_new || move_alike(*other, body, scene.dimension)) continue;
    welded.emplace(body.grain, other_name + " and " + name);
  }
  if (welded.empty()) return;
  const auto& [grain, names] = *welded.begin();
  const std::string more =
      welded.size() > 1 ? " (and so in " + std::to_string(welded.size() - 1) + " more grains)" : "";
  warnings.push_back(names + " have different velocities, but are one grain, number " +
                     std::to_string(grain) + more +
                     ": where they come near each other they weld, and neither rebound nor slide. "
                     "Give each [[body]] that moves by itself a grain of its own, 1 or more.");
}

}  // namespace

std::vector<std::string> body_warnings(const Scene& scene, const SampleReport& report) {
  std::vector<const Region*> bodies, voids;
  for (const Body& body : scene.bodies) bodies.push_back(&body.region);
  for (const Region& region : scene.voids) voids.push_back(&region);
  std::vector<std::string> warnings;
  warn_empty(scene, "body", bodies, report.bodies, warnings);
  warn_empty(scene, "void", voids, report.hollows, warnings);
  warn_cut(scene, report, warnings);
  warn_taken(report, warnings);
  warn_crossing("body", bodies, warnings);
  warn_crossing("void", voids, warnings);
  warn_welds(scene, warnings);
  return warnings;
}

}  // namespace poreshock
