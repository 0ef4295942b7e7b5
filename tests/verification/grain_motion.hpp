#pragma once
// How a grain moves as a whole.

#include <cstddef>

#include "poreshock/particles/particles.hpp"

namespace poreshock::test {

/// Mean place, velocity and spin of a grain.
struct GrainMotion {
  Vector<2> place = Vector<2>::Zero(), velocity = Vector<2>::Zero();
  double spin = 0.0;
};

inline GrainMotion motion_of(const Particles<2>& particles, int grain) {
  GrainMotion motion;
  double mass = 0.0, moment = 0.0, inertia = 0.0;
  const auto place = [&](std::size_t p) {
    return Vector<2>(particles.position[0][p], particles.position[1][p]);
  };
  const auto velocity = [&](std::size_t p) {
    return Vector<2>(particles.velocity[0][p], particles.velocity[1][p]);
  };
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (particles.grain[p] != grain) continue;
    mass += particles.mass[p];
    motion.place += particles.mass[p] * place(p);
    motion.velocity += particles.mass[p] * velocity(p);
  }
  motion.place /= mass;
  motion.velocity /= mass;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    if (particles.grain[p] != grain) continue;
    const Vector<2> r = place(p) - motion.place, v = velocity(p) - motion.velocity;
    moment += particles.mass[p] * (r[0] * v[1] - r[1] * v[0]);
    inertia += particles.mass[p] * r.squaredNorm();
  }
  motion.spin = moment / inertia;
  return motion;
}

}  // namespace poreshock::test
