#include "poreshock/physics/contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "tied_space.hpp"

namespace poreshock {

namespace {

constexpr int most_sweeps = 64;
constexpr double converged = 1e-3;  // change of the impulses in a sweep, over their sum
constexpr int most_pairs = most_grains_at_node * (most_grains_at_node - 1) / 2;

/// Two grains of a node.
template <int Dim>
struct Pair {
  int a, b;
  Vector<Dim> normal;  ///< from a to b
  double reduced;      ///< kg, m_a m_b / (m_a + m_b)
  bool rubs;           ///< false where the normal is only a guess
  double push;         ///< kg m/s along the normal, on b
  Vector<Dim> rub;     ///< kg m/s across it, on b
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

/// Adds to velocities the least impulses that keep the pairs from closing: Gauss-Seidel over all
/// pairs, back and forth, until they stand. A single pair is solved by its first step.
template <int Dim>
void find_pushes(std::span<const NodeGrain<Dim>> grains, NodeVelocities<Dim>& velocity,
                 std::span<Pair<Dim>> pairs) {
  const std::size_t count = pairs.size();
  for (Pair<Dim>& pair : pairs) pair.push = 0.0;
  std::array<double, most_grains_at_node> inverse_mass;
  for (std::size_t g = 0; g < grains.size(); ++g) inverse_mass[g] = 1.0 / grains[g].mass;
  for (int sweep = 0; sweep < (count == 1 ? 1 : most_sweeps); ++sweep) {
    double change = 0.0, sum = 0.0;
    for (std::size_t k = 0; k < count; ++k) {
      Pair<Dim>& pair = pairs[sweep % 2 == 0 ? k : count - 1 - k];
      const double opening = dot<Dim>(velocity[pair.b] - velocity[pair.a], pair.normal);
      const double push = std::max(pair.push - pair.reduced * opening, 0.0);
      const Vector<Dim> more = pair.normal * (push - pair.push);
      velocity[pair.a] -= more * inverse_mass[pair.a];
      velocity[pair.b] += more * inverse_mass[pair.b];
      change += std::abs(push - pair.push);
      sum += push;
      pair.push = push;
    }
    if (!(change > converged * sum)) return;
  }
}

/// The pairs that push each other with these velocities, moved to the front of all.
template <int Dim>
std::span<Pair<Dim>> pushing(std::span<const NodeGrain<Dim>> grains, std::span<Pair<Dim>> pairs,
                             NodeVelocities<Dim>& velocity) {
  find_pushes<Dim>(grains, velocity, pairs);
  const auto parts = [](const Pair<Dim>& pair) { return !(pair.push > 0.0); };
  const auto last = std::remove_if(pairs.begin(), pairs.end(), parts);
  return pairs.first(static_cast<std::size_t>(last - pairs.begin()));
}

/// Start and end velocities of the grains of a node.
template <int Dim>
struct Motion {
  NodeVelocities<Dim> start, end;
};

template <int Dim>
void project(const ContactSettings& settings, const TiedSpace<Dim>& space, Motion<Dim>& motion) {
  if (!settings.mirrored) space.project(motion.start);
  space.project(motion.end);
}

/// What of the relative velocity of a pair lies across its normal.
template <int Dim>
Vector<Dim> slip_of(const Pair<Dim>& pair, const NodeVelocities<Dim>& velocity) {
  const Vector<Dim> relative = velocity[pair.b] - velocity[pair.a];
  return relative - pair.normal * dot<Dim>(relative, pair.normal);
}

/// Ties pairs that friction keeps from slipping; the others get its impulse, on b.
template <int Dim>
void find_rubs(const ContactSettings& settings, std::span<Pair<Dim>> pairs, Motion<Dim>& motion,
               TiedSpace<Dim>& space) {
  for (Pair<Dim>& pair : pairs) {
    pair.rub.setZero();
    if (!pair.rubs) continue;
    const Vector<Dim> slip = slip_of(pair, motion.end);
    const double speed = std::sqrt(dot<Dim>(slip, slip)), most = settings.friction * pair.push;
    if (pair.reduced * speed > most) {
      pair.rub = slip * (-most / speed);
      continue;
    }
    for (int axis = 0; axis < Dim; ++axis) space.tie(pair.a, pair.b, Vector<Dim>::Unit(axis));
  }
  project<Dim>(settings, space, motion);
}

/// Adds the impulses of friction to the end velocities, those of a crowded node so that no tie
/// breaks, and so far that their heat, a parabola of their common size, is not negative.
template <int Dim>
void rub_pairs(std::span<NodeGrain<Dim>> grains, std::span<Pair<Dim>> pairs,
               const TiedSpace<Dim>& space, Motion<Dim>& motion, ContactReport& report) {
  NodeVelocities<Dim> change, middle;
  for (std::size_t g = 0; g < grains.size(); ++g) {
    change[g].setZero();
    middle[g] = (motion.start[g] + motion.end[g]) * 0.5;
  }
  for (const Pair<Dim>& pair : pairs) {
    change[pair.a] -= pair.rub / grains[pair.a].mass;
    change[pair.b] += pair.rub / grains[pair.b].mass;
  }
  space.project(change);
  const double slope = space.product(change, middle), square = space.product(change, change);
  if (!(slope < 0.0)) return;
  const double share = std::min(1.0, -2.0 * slope / square);
  for (std::size_t g = 0; g < grains.size(); ++g) {
    motion.end[g] += change[g] * share;
    middle[g] += change[g] * (0.5 * share);
  }
  report.friction_heat = -share * (slope + 0.5 * share * square);
  for (const Pair<Dim>& pair : pairs) {
    const double heat = -share * dot<Dim>(pair.rub, middle[pair.b] - middle[pair.a]);
    grains[pair.a].heat += 0.5 * heat;
    grains[pair.b].heat += 0.5 * heat;
  }
}

/// Heat of impulses that act on start velocities which do not keep the ties, with that of friction
/// alike per mass in all grains.
template <int Dim>
void book_impact(std::span<NodeGrain<Dim>> grains, const Motion<Dim>& motion,
                 ContactReport& report) {
  double heat = 0.0, mass = 0.0;
  for (std::size_t g = 0; g < grains.size(); ++g) {
    const Vector<Dim> change = motion.end[g] - grains[g].end;
    const Vector<Dim> middle = (motion.start[g] + motion.end[g]) * 0.5;
    heat -= grains[g].mass * dot<Dim>(change, middle);
    mass += grains[g].mass;
  }
  for (NodeGrain<Dim>& grain : grains) grain.heat = grain.mass / mass * heat;
  report.impact_heat = heat - report.friction_heat;
}

/// All pairs of a node that have a normal and touch. `normal`: of two grains, where known.
template <int Dim>
int find_pairs(std::span<const NodeGrain<Dim>> grains, const ContactSettings& settings,
               const FaceTable& faces, const Vector<Dim>* normal,
               std::array<Pair<Dim>, most_pairs>& pairs, ContactReport& report) {
  const NodeFill<Dim> node = fill_of<Dim>(grains);
  // Over the space of a node inside the domain: beyond a wall only a sliver of it is left.
  double space = 1.0;
  for (int k = 0; k < Dim; ++k) space *= settings.cell;
  const double excess = (node.volume - settings.capacity) / space;
  if (excess > 0.0) report.penetration = excess * settings.cell / faces.density(0.5);
  report.least_gap = std::numeric_limits<double>::infinity();
  int count = 0;
  for (int a = 0; a < static_cast<int>(grains.size()); ++a) {
    for (int b = a + 1; b < static_cast<int>(grains.size()); ++b) {
      Pair<Dim>& pair = pairs[static_cast<std::size_t>(count)];
      pair.a = a, pair.b = b, pair.rubs = true;
      pair.reduced = grains[a].mass * (grains[b].mass / (grains[a].mass + grains[b].mass));
      if (normal != nullptr && grains.size() == 2) {
        pair.normal = *normal;
      } else if (!set_normal<Dim>(grains[a], grains[b], settings.cell, grains.size() > 2, pair)) {
        continue;
      }
      const double gap = pair_gap<Dim>(grains[a], grains[b], pair.normal, node, settings, faces);
      report.least_gap = std::min(report.least_gap, gap);
      if (!settings.gap_test || !(gap > 0.0)) ++count;
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
  Motion<Dim> motion;
  for (std::size_t g = 0; g < grains.size(); ++g) motion.end[g] = grains[g].end;
  const std::span<Pair<Dim>> pairs =
      pushing<Dim>(grains, {storage.data(), static_cast<std::size_t>(count)}, motion.end);
  report.pairs = static_cast<int>(pairs.size());
  if (pairs.empty()) return report;
  const bool rubs = settings.friction > 0.0;
  if (rubs) {
    // What the particles keep is no impulse that they were given.
    for (std::size_t g = 0; g < grains.size(); ++g) {
      motion.end[g] = grains[g].end - grains[g].start * settings.kept;
    }
    find_pushes<Dim>(grains, motion.end, pairs);
  }
  for (std::size_t g = 0; g < grains.size(); ++g) {
    motion.start[g] = grains[g].start;
    motion.end[g] = grains[g].end;
  }
  TiedSpace<Dim> space(grains);
  for (const Pair<Dim>& pair : pairs) space.tie(pair.a, pair.b, pair.normal);
  project<Dim>(settings, space, motion);
  if (rubs) {
    find_rubs<Dim>(settings, pairs, motion, space);
    rub_pairs<Dim>(grains, pairs, space, motion, report);
  }
  if (settings.mirrored) book_impact<Dim>(grains, motion, report);
  for (std::size_t g = 0; g < grains.size(); ++g) {
    grains[g].start = motion.start[g];
    grains[g].end = motion.end[g];
  }
  return report;
}

template ContactReport resolve_contact<2>(std::span<NodeGrain<2>>, const ContactSettings&,
                                          const FaceTable&, const Vector<2>*);
template ContactReport resolve_contact<3>(std::span<NodeGrain<3>>, const ContactSettings&,
                                          const FaceTable&, const Vector<3>*);

}  // namespace poreshock
