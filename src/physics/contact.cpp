#include "poreshock/physics/contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "pair_pushes.hpp"

namespace poreshock {

namespace {

template <std::size_t Count>
constexpr std::size_t most_pairs = most_of<Count>*(most_of<Count> - 1) / 2;

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

/// The pairs that push each other, moved to the front of all.
template <int Dim>
std::span<Pair<Dim>> pushing(std::span<Pair<Dim>> pairs) {
  const auto parts = [](const Pair<Dim>& pair) { return !(pair.push > 0.0); };
  const auto last = std::remove_if(pairs.begin(), pairs.end(), parts);
  return pairs.first(static_cast<std::size_t>(last - pairs.begin()));
}

/// Start and end velocities of the grains of a node.
template <int Dim, std::size_t Count>
struct Motion {
  NodeVelocities<Dim, Count> start, end;
};

template <int Dim, std::size_t Count>
void project(const ContactSettings& settings, const TiedSpace<Dim, Count>& space,
             Motion<Dim, Count>& motion) {
  if (!settings.mirrored) space.project(motion.start);
  space.project(motion.end);
}

/// What of the relative velocity of a pair lies across its normal.
template <int Dim, std::size_t Count>
Vector<Dim> slip_of(const Pair<Dim>& pair, const NodeVelocities<Dim, Count>& velocity) {
  const Vector<Dim> relative = velocity[pair.b] - velocity[pair.a];
  return relative - pair.normal * dot<Dim>(relative, pair.normal);
}

/// Ties pairs that friction keeps from slipping; the others get its impulse, on b.
template <int Dim, std::size_t Count>
void find_rubs(const ContactSettings& settings, std::span<Pair<Dim>> pairs,
               Motion<Dim, Count>& motion, TiedSpace<Dim, Count>& space) {
  for (Pair<Dim>& pair : pairs) {
    pair.rub.setZero();
    if (!pair.rubs) continue;
    const Vector<Dim> slip = slip_of<Dim, Count>(pair, motion.end);
    const double speed = std::sqrt(dot<Dim>(slip, slip)), most = settings.friction * pair.push;
    if (pair.reduced * speed > most) {
      pair.rub = slip * (-most / speed);
      continue;
    }
    for (int axis = 0; axis < Dim; ++axis) space.tie(pair.a, pair.b, Vector<Dim>::Unit(axis));
  }
  project<Dim, Count>(settings, space, motion);
}

/// Adds the impulses of friction to the end velocities, those of a crowded node so that no tie
/// breaks, and so far that their heat, a parabola of their common size, is not negative.
template <int Dim, std::size_t Count>
void rub_pairs(std::span<NodeGrain<Dim>, Count> grains, std::span<Pair<Dim>> pairs,
               const TiedSpace<Dim, Count>& space, Motion<Dim, Count>& motion,
               ContactReport& report) {
  NodeVelocities<Dim, Count> change, middle;
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
template <int Dim, std::size_t Count>
void book_impact(std::span<NodeGrain<Dim>, Count> grains, const Motion<Dim, Count>& motion,
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
template <int Dim, std::size_t Count>
int find_pairs(NodeGrains<Dim, Count> grains, const ContactSettings& settings,
               const FaceTable& faces, const Vector<Dim>* normal,
               std::array<Pair<Dim>, most_pairs<Count>>& pairs, ContactReport& report) {
  const NodeFill<Dim> node = fill_of<Dim>(grains);
  // Over the space of a node inside the domain: beyond a wall only a sliver of it is left.
  double space = 1.0;
  for (int k = 0; k < Dim; ++k) space *= settings.cell;
  report.excess = std::max(0.0, (node.volume - settings.capacity) / space);
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

/// A node while its grains collide.
template <int Dim, std::size_t Count>
struct Collision {
  std::array<Pair<Dim>, most_pairs<Count>> storage;
  std::span<Pair<Dim>> pairs;
  Motion<Dim, Count> motion;
};

/// Ties the pairs of a node that push each other, and lets them rub.
template <int Dim, std::size_t Count>
void tie_pairs(std::span<NodeGrain<Dim>, Count> grains, const ContactSettings& settings,
               Collision<Dim, Count>& collision, ContactReport& report) {
  Motion<Dim, Count>& motion = collision.motion;
  for (std::size_t g = 0; g < grains.size(); ++g) {
    motion.start[g] = grains[g].start;
    motion.end[g] = grains[g].end;
  }
  TiedSpace<Dim, Count> space(grains);
  for (const Pair<Dim>& pair : collision.pairs) space.tie(pair.a, pair.b, pair.normal);
  project<Dim, Count>(settings, space, motion);
  if (settings.friction > 0.0) {
    find_rubs<Dim, Count>(settings, collision.pairs, motion, space);
    rub_pairs<Dim, Count>(grains, collision.pairs, space, motion, report);
  }
  if (settings.mirrored) book_impact<Dim, Count>(grains, motion, report);
  for (std::size_t g = 0; g < grains.size(); ++g) {
    grains[g].start = motion.start[g];
    grains[g].end = motion.end[g];
  }
}

/// Several nodes of one known number of grains.
template <int Dim, std::size_t Count>
void resolve(std::span<ContactNode<Dim>> nodes, const FaceTable& faces) {
  std::array<Collision<Dim, Count>, most_contact_nodes> collisions;
  std::array<PushedNode<Dim, Count>, most_contact_nodes> pushed;
  const auto grains_of = [&](std::size_t n) {
    return std::span<NodeGrain<Dim>, Count>(nodes[n].grains);
  };
  const auto push = [&] {
    for (std::size_t n = 0; n < nodes.size(); ++n) {
      pushed[n] = {grains_of(n), collisions[n].pairs, &collisions[n].motion.end};
    }
    find_pushes<Dim, Count>({pushed.data(), nodes.size()});
  };
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    Collision<Dim, Count>& c = collisions[n];
    const int count = find_pairs<Dim, Count>(grains_of(n), nodes[n].settings, faces,
                                             nodes[n].normal, c.storage, nodes[n].report);
    c.pairs = {c.storage.data(), static_cast<std::size_t>(count)};
    for (std::size_t g = 0; g < nodes[n].grains.size(); ++g) c.motion.end[g] = grains_of(n)[g].end;
  }
  push();
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    collisions[n].pairs = pushing(collisions[n].pairs);
    // What the particles keep is no impulse that they were given.
    for (std::size_t g = 0; g < nodes[n].grains.size(); ++g) {
      const NodeGrain<Dim>& grain = grains_of(n)[g];
      collisions[n].motion.end[g] = grain.end - grain.start * nodes[n].settings.kept;
    }
  }
  const bool alone = nodes.front().grains.size() == 2;
  if (alone || nodes.front().settings.friction > 0.0) push();
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    // Two grains part where the tie would pull their particles and there is room for what closes.
    const bool has_room = alone && !(nodes[n].report.excess > 0.0);
    if (has_room) collisions[n].pairs = pushing(collisions[n].pairs);
    nodes[n].report.pairs = static_cast<int>(collisions[n].pairs.size());
    if (collisions[n].pairs.empty()) continue;
    tie_pairs<Dim, Count>(grains_of(n), nodes[n].settings, collisions[n], nodes[n].report);
  }
}

}  // namespace

template <int Dim>
void resolve_contacts(std::span<ContactNode<Dim>> nodes, const FaceTable& faces) {
  switch (nodes.front().grains.size()) {
    case 2:
      return resolve<Dim, 2>(nodes, faces);
    case 3:
      return resolve<Dim, 3>(nodes, faces);
    case 4:
      return resolve<Dim, 4>(nodes, faces);
    case 5:
      return resolve<Dim, 5>(nodes, faces);
    default:
      return resolve<Dim, std::dynamic_extent>(nodes, faces);
  }
}

template <int Dim>
ContactReport resolve_contact(std::span<NodeGrain<Dim>> grains, const ContactSettings& settings,
                              const FaceTable& faces, const Vector<Dim>* normal) {
  ContactNode<Dim> node{grains, settings, normal, {}};
  resolve_contacts<Dim>({&node, 1}, faces);
  return node.report;
}

template void resolve_contacts<2>(std::span<ContactNode<2>>, const FaceTable&);
template void resolve_contacts<3>(std::span<ContactNode<3>>, const FaceTable&);
template ContactReport resolve_contact<2>(std::span<NodeGrain<2>>, const ContactSettings&,
                                          const FaceTable&, const Vector<2>*);
template ContactReport resolve_contact<3>(std::span<NodeGrain<3>>, const ContactSettings&,
                                          const FaceTable&, const Vector<3>*);

}  // namespace poreshock
