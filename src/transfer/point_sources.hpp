#pragma once

/// What particles give to their nodes, of eight particles at once.

#include <algorithm>

#include "lane_particles.hpp"
#include "mode_norms.hpp"
#include "poreshock/core/shape.hpp"
#include "poreshock/core/tensor.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/scene/transfer_scheme.hpp"

namespace poreshock {

template <int Dim>
inline int symmetric_index(int a, int b) {
  constexpr int plane[2][2] = {{0, 3}, {3, 1}};
  constexpr int space[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
  if constexpr (Dim == 2) {
    return plane[a][b];
  } else {
    return space[a][b];
  }
}

/// Numbers of particles that their nodes see, divided by scale^Dim where weights multiply them: of
/// one, or of eight, a particle a lane.
template <int Dim, Modes M, class Number>
struct PointSource {
  Number mass;
  std::array<Number, Dim> velocity;
  /// m/s of the higher modes, [component][mode]: r_a, then r_a^2 - D, then r_a r_b
  std::array<std::array<Number, higher_modes<Dim, M>>, Dim> mode;
  std::array<std::array<Number, Dim>, Dim> force;  ///< - V stress per cell: a slope gives N, eq 14
};

/// Amplitudes of the second order become coefficients; their constant parts join the velocity.
/// `local` is the place in the cell, in cells.
template <int Dim, class Spline, class Number, class Where>
inline void add_second_modes(const Particles<Dim>& particles, const Where& where,
                             const std::array<Number, Dim>& local,
                             PointSource<Dim, Modes::quadratic, Number>& s) {
  constexpr double inertia = 1.0 / Spline::inverse_inertia;
  std::array<Number, Dim> inverse;
  for (int a = 0; a < Dim; ++a) {
    inverse[a] = (1.0 - Number{}) / square_root(second_norm(local[a]));
  }
  for (int a = 0; a < Dim; ++a) {
    Number constant{};
    for (int k = 0; k < second_modes<Dim>; ++k) {
      const Number amplitude = load(particles.quadratic[a * second_modes<Dim> + k], where);
      s.mode[a][Dim + k] = k < Dim ? inverse[k] * amplitude : Spline::inverse_inertia * amplitude;
      if (k < Dim) constant += s.mode[a][Dim + k];
    }
    s.velocity[a] = s.velocity[a] - inertia * constant;
  }
}

/// Of the particle or the eight at `where`; `base` is the lowest node of their stencil.
template <int Dim, Modes M, class Spline, class Number, class Where>
inline void load_sources(const Particles<Dim>& particles, const Where& where,
                         const std::array<int, Dim>& base, double cell,
                         PointSource<Dim, M, Number>& s) {
  const Number mass = load(particles.mass, where);
  s.mass = unscaled<Dim, Spline>(mass);
  const Number pressure = load(particles.pressure, where) + load(particles.viscous_pressure, where);
  // Less than nothing: the stress pulls.
  const Number volume_per_cell =
      -1.0 * unscaled<Dim, Spline>(mass / (load(particles.density, where) * cell));
#pragma GCC unroll 3
  for (int a = 0; a < Dim; ++a) {
    s.velocity[a] = load(particles.velocity[a], where);
#pragma GCC unroll 3
    for (int k = 0; k < Dim; ++k) {
      const Number stress = load(particles.deviator[symmetric_index<Dim>(a, k)], where);
      s.force[a][k] = volume_per_cell * (a == k ? stress - pressure : stress);
      if constexpr (M != Modes::constant) {
        s.mode[a][k] = load(particles.affine[a * Dim + k], where) * cell;
      }
    }
  }
  if constexpr (M == Modes::quadratic) {
    std::array<Number, Dim> local;
    for (int a = 0; a < Dim; ++a) {
      const double start = -local_place<Spline>(0.0, base[a]);
      local[a] = load(particles.position[a], where) * (1.0 / cell) - start;
    }
    add_second_modes<Dim, Spline>(particles, where, local, s);
  }
}

/// The numbers of one of eight particles.
template <int Dim, Modes M>
inline PointSource<Dim, M, double> source_of(const PointSource<Dim, M, Lanes>& eight, int n) {
  PointSource<Dim, M, double> s;
  s.mass = eight.mass[n];
  for (int a = 0; a < Dim; ++a) {
    s.velocity[a] = eight.velocity[a][n];
    for (std::size_t k = 0; k < s.mode[a].size(); ++k) s.mode[a][k] = eight.mode[a][k][n];
    for (int k = 0; k < Dim; ++k) s.force[a][k] = eight.force[a][k][n];
  }
  return s;
}

/// The particles of a batch and, where it is shorter, others that nobody asks for.
inline LaneParticles lane_particles(const std::uint32_t* first, std::ptrdiff_t count,
                                    std::size_t all) {
  LaneParticles eight;
  eight.adjacent = first[0] + lane_count <= all;
  for (std::ptrdiff_t n = 0; n < lane_count; ++n) {
    eight.index[n] = first[std::min(n, count - 1)];
    eight.adjacent = eight.adjacent && (n >= count || eight.index[n] == first[0] + n);
  }
  return eight;
}

}  // namespace poreshock
