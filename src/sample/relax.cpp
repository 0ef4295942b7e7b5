#include <algorithm>
#include <cmath>
#include <limits>

#include "packing.hpp"
#include "random.hpp"

namespace poreshock {
namespace {

/// State of the FIRE minimiser (Bitzek et al., PRL 97 (2006) 170201), unit mass and stiffness.
struct Descent {
  std::vector<Triple> force;     ///< m: overlaps along the line of centres, summed
  std::vector<Triple> velocity;  ///< m
  double step = 0.1;
  double mixing = 0.1;
  int downhill = 0;  ///< steps since the energy last went up
};

/// What one sweep over the pairs found.
struct Conflict {
  double gap_shortage = 0.0;  ///< m, worst contact distance - distance; > 0: a distance not kept
  double energy = 0.0;        ///< m^2, sum of squared overlaps of the stretched voids
};

bool outdated(const Packing& packing, const Neighbours& near) {
  const double limit = 0.25 * (near.skin * near.skin);
  for (std::size_t i = 0; i < packing.voids.size(); ++i) {
    const double moved =
        squared_distance(packing.block, packing.voids[i].center, near.reference[i]);
    if (moved > limit) return true;
  }
  return false;
}

/// Adds the push between voids i and j to both.
void push_apart(const Packing& packing, std::size_t i, std::size_t j, double stretch,
                std::vector<Triple>& force, Conflict& conflict) {
  const Void& a = packing.voids[i];
  const Void& b = packing.voids[j];
  const double contact = contact_distance(packing, a, b);
  const double reach = stretch * contact;
  const Triple d = separation(packing.block, a.center, b.center);
  const double square = (d[0] * d[0] + d[1] * d[1]) + d[2] * d[2];
  if (square >= reach * reach) return;
  const double distance = std::sqrt(square);
  // Tested on squares, as sequential addition and shaking do.
  if (square < contact * contact) {
    const double least = std::numeric_limits<double>::min();
    conflict.gap_shortage = std::max({conflict.gap_shortage, contact - distance, least});
  }
  const double overlap = reach - distance;
  conflict.energy += overlap * overlap;
  const double factor = distance > 0.0 ? overlap / distance : 0.0;
  for (int axis = 0; axis < packing.block.dimension; ++axis) {
    force[i][axis] -= factor * d[axis];
    force[j][axis] += factor * d[axis];
  }
}

Conflict find_forces(const Packing& packing, const Neighbours& near, double stretch,
                     std::vector<Triple>& force) {
  Conflict conflict;
  force.assign(packing.voids.size(), Triple{});
  for (std::size_t i = 0; i < packing.voids.size(); ++i) {
    for (std::size_t n = near.start[i]; n < near.start[i + 1]; ++n) {
      const std::size_t j = static_cast<std::size_t>(near.item[n]);
      if (j > i) push_apart(packing, i, j, stretch, force, conflict);
    }
  }
  return conflict;
}

double product(const std::vector<Triple>& a, const std::vector<Triple>& b) {
  double result = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    result += (a[i][0] * b[i][0] + a[i][1] * b[i][1]) + a[i][2] * b[i][2];
  }
  return result;
}

/// FIRE's rule: steer towards the force and speed up downhill, stop and slow down uphill.
void steer(Descent& descent) {
  constexpr double longest_step = 0.4;  // below 2 / highest frequency of a jammed packing
  if (product(descent.force, descent.velocity) < 0.0) {
    descent.velocity.assign(descent.velocity.size(), Triple{});
    descent.step *= 0.5;
    descent.mixing = 0.1;
    descent.downhill = 0;
  } else if (++descent.downhill > 5) {
    descent.step = std::min(1.1 * descent.step, longest_step);
    descent.mixing *= 0.99;
  }
  for (std::size_t i = 0; i < descent.force.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a)
      descent.velocity[i][a] += descent.step * descent.force[i][a];
  }
  const double force = std::sqrt(product(descent.force, descent.force));
  const double speed = std::sqrt(product(descent.velocity, descent.velocity));
  const double pull = force > 0.0 ? descent.mixing * speed / force : 0.0;
  for (std::size_t i = 0; i < descent.force.size(); ++i) {
    for (std::size_t a = 0; a < 3; ++a) {
      descent.velocity[i][a] =
          (1.0 - descent.mixing) * descent.velocity[i][a] + pull * descent.force[i][a];
    }
  }
}

/// Moves all voids by one step; those that meet the keep-out layer stop there.
void move(Descent& descent, Packing& packing) {
  // A void that would cross the block in one step is a start far too crowded: hold it back.
  const double furthest = 0.2 * largest_contact(packing);
  for (std::size_t i = 0; i < packing.voids.size(); ++i) {
    Void& v = packing.voids[i];
    for (int axis = 0; axis < packing.block.dimension; ++axis) {
      const double way = descent.step * descent.velocity[i][axis];
      v.center[axis] += std::clamp(way, -furthest, furthest);
      if (packing.block.periodic[axis]) continue;
      const AxisRange range = centre_range(packing.block, packing.keep_out, v.radius, axis);
      const double inside = std::clamp(v.center[axis], range.low, range.high);
      if (inside != v.center[axis]) descent.velocity[i][axis] = 0.0;
      v.center[axis] = inside;
    }
    v.center = wrap(packing.block, v.center);
  }
}

/// Minimises the energy of voids with contact distances stretched by this factor. True as soon as
/// all real distances are kept.
bool descend(double stretch, int most_steps, Packing& packing) {
  const double contact = largest_contact(packing);
  const double skin = 0.2 * contact;
  Neighbours near = find_neighbours(packing, stretch, skin);
  Descent descent;
  descent.velocity.assign(packing.voids.size(), Triple{});
  for (int n = 0; n < most_steps; ++n) {
    if (outdated(packing, near)) near = find_neighbours(packing, stretch, skin);
    const Conflict conflict = find_forces(packing, near, stretch, descent.force);
    if (conflict.gap_shortage <= 0.0) return true;
    // Balanced forces with overlaps left: jammed, more steps change nothing.
    if (product(descent.force, descent.force) < 1e-16 * conflict.energy) return false;
    steer(descent);
    move(descent, packing);
  }
  return false;
}

/// Whether void i at `centre` keeps its distance to all voids in its list.
bool is_free(const Packing& packing, const Neighbours& near, std::size_t i, const Triple& centre) {
  for (std::size_t n = near.start[i]; n < near.start[i + 1]; ++n) {
    const Void& other = packing.voids[static_cast<std::size_t>(near.item[n])];
    const double contact = contact_distance(packing, packing.voids[i], other);
    if (squared_distance(packing.block, centre, other.center) < contact * contact) return false;
  }
  return true;
}

/// Tries one random move of void i by at most `reach` along each axis.
void try_move(const Neighbours& near, double reach, std::size_t i, std::uint32_t sweep,
              Packing& packing) {
  const std::array<double, 4> u = uniforms(packing.seed, RandomStream::shake, i, sweep);
  Triple centre = packing.voids[i].center;
  for (int axis = 0; axis < packing.block.dimension; ++axis) {
    centre[axis] += reach * (2.0 * u[axis] - 1.0);
    if (packing.block.periodic[axis]) continue;
    const AxisRange range =
        centre_range(packing.block, packing.keep_out, packing.voids[i].radius, axis);
    if (centre[axis] < range.low || centre[axis] > range.high) return;
  }
  centre = wrap(packing.block, centre);
  // The neighbour lists know nothing of voids farther away than this.
  if (squared_distance(packing.block, centre, near.reference[i]) > 0.25 * (near.skin * near.skin)) {
    return;
  }
  if (is_free(packing, near, i, centre)) packing.voids[i].center = centre;
}

}  // namespace

bool relax(Packing& packing) {
  const double random_limit = packing.block.dimension == 2 ? 0.86 : 0.66;
  const double crowded = crowding(packing);
  const double count = static_cast<double>(packing.voids.size());
  const int most_steps = static_cast<int>(std::clamp(3e8 / count, 1000.0, 20000.0));
  for (const double spare : {0.05, 0.02, 0.01, 0.005, 0.002, 0.0005}) {
    const double stretch = 1.0 + spare;
    const double stretched = crowded * std::pow(stretch, packing.block.dimension);
    const bool last = spare == 0.0005;
    // Stretched voids that cannot fit only cost time.
    if (stretched > random_limit && !last) continue;
    if (descend(stretch, most_steps, packing)) return true;
  }
  return false;
}

void shake(Packing& packing) {
  const double contact = largest_contact(packing);
  const double open = 0.9 / crowding(packing);
  const double reach =
      contact * std::clamp(std::pow(open, 1.0 / packing.block.dimension) - 1.0, 0.01, 0.3);
  std::uint32_t sweep = 0;
  for (int round = 0; round < 30; ++round) {
    const Neighbours near = find_neighbours(packing, 1.0, 4.0 * reach);
    for (int n = 0; n < 4; ++n, ++sweep) {
      for (std::size_t i = 0; i < packing.voids.size(); ++i) {
        try_move(near, reach, i, sweep, packing);
      }
    }
  }
}

}  // namespace poreshock
