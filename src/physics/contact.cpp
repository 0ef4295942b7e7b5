#include "poreshock/physics/contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace poreshock {

namespace {

constexpr int most_sweeps = 64;
constexpr double converged = 1e-6;  // change of the impulses in a sweep, over their sum
constexpr int most_pairs = most_grains_at_node * (most_grains_at_node - 1) / 2;

/// Two grains of a node and what they give each other.
template <int Dim>
struct Pair {
  int a = 0, b = 0;
  Vector<Dim> normal = Vector<Dim>::Zero();  ///< from a to b
  double gap = 0.0;                          ///< m, that may still close
  bool rubs = true;                          ///< false where the normal is only a guess
  double push = 0.0;                         ///< kg m/s along the normal, on b
  Vector<Dim> rub = Vector<Dim>::Zero();     ///< kg m/s across it, on b
};

/// Common normal of two grains: of their volume gradients, else from place to place. `crowded`:
/// there are more grains at the node. False when there is none.
template <int Dim>
bool set_normal(const NodeGrain<Dim>& a, const NodeGrain<Dim>& b, double cell, bool crowded,
                Pair<Dim>& pair) {
  constexpr double flat = 1e-6;
  const double both = a.volume + b.volume;
  const double face = flat * both / cell;
  const double floor = face * (face * face);
  Vector<Dim> n;
  if (crowded) {
    // Where a pressure p is the same in all grains that fill the node, it pulls each with p times
    // its gradient, and these sum to zero. Impulses along V_b g_a - V_a g_b, one per pair, can hold
    // exactly that; along other normals the grains would creep into each other.
    n = (a.gradient * b.volume - b.gradient * a.volume) / both;
    n *= dot<Dim>(n, n);
  } else {
    // The steeper gradient belongs to the flatter face: at a corner it tells where the face is.
    n = a.gradient * dot<Dim>(a.gradient, a.gradient) -
        b.gradient * dot<Dim>(b.gradient, b.gradient);
  }
  double length = std::sqrt(dot<Dim>(n, n));
  pair.rubs = length > floor;
  if (!pair.rubs) {
    n = b.place - a.place;
    length = std::sqrt(dot<Dim>(n, n));
    if (!(length > flat * cell)) return false;
  }
  pair.normal = n / length;
  return true;
}

template <int Dim>
void add_impulse(const Vector<Dim>& impulse, const Pair<Dim>& pair,
                 std::span<NodeGrain<Dim>> grains) {
  grains[pair.a].end -= impulse / grains[pair.a].mass;
  grains[pair.b].end += impulse / grains[pair.b].mass;
}

/// One Gauss-Seidel step: the impulse of this pair given those of all others. Returns by how much
/// it changed, kg m/s.
template <int Dim>
double relax_pair(double friction, double closing_time, Pair<Dim>& pair,
                  std::span<NodeGrain<Dim>> grains) {
  const double ma = grains[pair.a].mass, mb = grains[pair.b].mass;
  const double reduced = ma * (mb / (ma + mb));
  Vector<Dim> relative = grains[pair.b].end - grains[pair.a].end;
  const double missing = -(dot<Dim>(relative, pair.normal) + pair.gap / closing_time);
  const double push = std::max(pair.push + reduced * missing, 0.0);
  add_impulse<Dim>(pair.normal * (push - pair.push), pair, grains);
  const double change = std::abs(push - pair.push);
  pair.push = push;
  if (!(friction > 0.0) || !pair.rubs) return change;
  relative = grains[pair.b].end - grains[pair.a].end;
  const Vector<Dim> slip = relative - pair.normal * dot<Dim>(relative, pair.normal);
  Vector<Dim> rub = pair.rub - slip * reduced;
  const double size = std::sqrt(dot<Dim>(rub, rub));
  const double most = friction * push;
  if (size > most) rub *= most / size;
  const Vector<Dim> more = rub - pair.rub;
  add_impulse<Dim>(more, pair, grains);
  pair.rub = rub;
  return change + std::sqrt(dot<Dim>(more, more));
}

/// Gauss-Seidel over all pairs, back and forth, until the impulses stand. A single pair is solved
/// by its first step.
template <int Dim>
void relax_pairs(const ContactSettings& settings, std::span<Pair<Dim>> pairs,
                 std::span<NodeGrain<Dim>> grains) {
  const std::size_t count = pairs.size();
  for (int sweep = 0; sweep < (count == 1 ? 1 : most_sweeps); ++sweep) {
    double change = 0.0, sum = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      Pair<Dim>& pair = pairs[sweep % 2 == 0 ? k : count - 1 - k];
      change += relax_pair<Dim>(settings.friction, settings.closing_time, pair, grains);
      sum += pair.push;
    }
    if (!(change > converged * sum)) return;
  }
}

/// Kinetic energy that impulses from `before` to the velocities now took: J . (before + now) / 2.
template <int Dim>
double energy_taken(std::span<const Vector<Dim>> before, std::span<const NodeGrain<Dim>> grains) {
  double taken = 0.0;
  for (std::size_t g = 0; g < grains.size(); ++g) {
    const Vector<Dim> change = before[g] - grains[g].end;
    const Vector<Dim> middle = (before[g] + grains[g].end) * 0.5;
    taken += grains[g].mass * dot<Dim>(change, middle);
  }
  return taken;
}

/// Friction bounds that shrank during the sweeps may leave impulses that add energy. Along the ray
/// of all impulses together energy is a parabola: its lowest point keeps every bound.
template <int Dim>
void keep_energy_down(std::span<const Vector<Dim>> before, std::span<Pair<Dim>> pairs,
                      std::span<NodeGrain<Dim>> grains) {
  double slope = 0.0, curvature = 0.0;
  for (std::size_t g = 0; g < grains.size(); ++g) {
    const Vector<Dim> change = grains[g].end - before[g];
    slope += grains[g].mass * dot<Dim>(before[g], change);
    curvature += grains[g].mass * dot<Dim>(change, change);
  }
  if (slope + 0.5 * curvature <= 0.0 || !(curvature > 0.0)) return;
  const double share = std::clamp(-slope / curvature, 0.0, 1.0);
  for (std::size_t g = 0; g < grains.size(); ++g) {
    grains[g].end = before[g] + (grains[g].end - before[g]) * share;
  }
  for (Pair<Dim>& pair : pairs) {
    pair.push *= share;
    pair.rub *= share;
  }
}

template <int Dim>
void share_heat(std::span<const Pair<Dim>> pairs, std::span<NodeGrain<Dim>> grains,
                ContactReport& report) {
  for (const Pair<Dim>& pair : pairs) {
    NodeGrain<Dim>& a = grains[pair.a];
    NodeGrain<Dim>& b = grains[pair.b];
    const Vector<Dim> middle = ((b.start - a.start) + (b.end - a.end)) * 0.5;
    const double impact = -pair.push * dot<Dim>(pair.normal, middle);
    const double rubbing = -dot<Dim>(pair.rub, middle);
    a.heat += 0.5 * (impact + rubbing);
    b.heat += 0.5 * (impact + rubbing);
    report.impact_heat += impact;
    report.friction_heat += rubbing;
    if (pair.push > 0.0) ++report.pairs;
  }
}

/// All pairs of a node that have a normal, with their gaps. `normal`: of two grains, where known.
template <int Dim>
int find_pairs(std::span<const NodeGrain<Dim>> grains, const ContactSettings& settings,
               const FaceTable& faces, const Vector<Dim>* normal,
               std::array<Pair<Dim>, most_pairs>& pairs, ContactReport& report) {
  double filled = 0.0;
  for (const NodeGrain<Dim>& g : grains) filled += g.volume;
  // Over the space of a node inside the domain: beyond a wall only a sliver of it is left.
  double space = 1.0;
  for (int k = 0; k < Dim; ++k) space *= settings.cell;
  const double excess = (filled - settings.capacity) / space;
  if (excess > 0.0) report.penetration = excess * settings.cell / faces.density(0.5);
  report.least_gap = std::numeric_limits<double>::infinity();
  int count = 0;
  for (int a = 0; a < static_cast<int>(grains.size()); ++a) {
    for (int b = a + 1; b < static_cast<int>(grains.size()); ++b) {
      Pair<Dim>& pair = pairs[static_cast<std::size_t>(count)];
      pair = {.a = a, .b = b};
      if (normal != nullptr && grains.size() == 2) {
        pair.normal = *normal;
      } else if (!set_normal<Dim>(grains[a], grains[b], settings.cell, grains.size() > 2, pair)) {
        continue;
      }
      const double gap = pair_gap<Dim>(grains[a], grains[b], filled, settings, faces);
      report.least_gap = std::min(report.least_gap, gap);
      if (settings.gap_test) pair.gap = gap;
      ++count;
    }
  }
  return count;
}

}  // namespace

template <int Dim>
ContactReport resolve_contact(std::span<NodeGrain<Dim>> grains, const ContactSettings& settings,
                              const FaceTable& faces, const Vector<Dim>* normal) {
  ContactReport report;
  std::array<Pair<Dim>, most_pairs> storage;
  const int count = find_pairs<Dim>(grains, settings, faces, normal, storage, report);
  const std::span<Pair<Dim>> pairs(storage.data(), static_cast<std::size_t>(count));
  std::array<Vector<Dim>, most_grains_at_node> before;
  for (std::size_t g = 0; g < grains.size(); ++g) before[g] = grains[g].end;
  const std::span<const Vector<Dim>> start(before.data(), grains.size());
  relax_pairs<Dim>(settings, pairs, grains);
  if (count > 1) keep_energy_down<Dim>(start, pairs, grains);
  report.loss = energy_taken<Dim>(start, grains);
  share_heat<Dim>(pairs, grains, report);
  return report;
}

template ContactReport resolve_contact<2>(std::span<NodeGrain<2>>, const ContactSettings&,
                                          const FaceTable&, const Vector<2>*);
template ContactReport resolve_contact<3>(std::span<NodeGrain<3>>, const ContactSettings&,
                                          const FaceTable&, const Vector<3>*);

}  // namespace poreshock
