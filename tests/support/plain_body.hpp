#pragma once
// Particles and nodes of the plain step (support/plain_step.hpp), its weights and its modes.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "poreshock/core/tensor.hpp"
#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/material/material.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/physics/stress.hpp"
#include "poreshock/scene/transfer_scheme.hpp"

namespace poreshock::reference {

/// Modes of a particle: velocity, r_x, r_y and, of PolyFLIP, xx, yy, xy.
template <Modes M>
inline constexpr int plain_mode_count = 1 + higher_modes<2, M>;

/// One particle, SI units.
template <Modes M>
struct PlainParticle {
  std::int64_t id;
  double x[2];
  double mode[2][plain_mode_count<M>];  ///< m/s: velocity and amplitudes of norm 1
  double mass, density, pressure, viscous_pressure, energy, plastic_strain, plastic_work;
  SymmetricTensor<2> deviator;
  double heat, viscous_linear, viscous_quadratic;
  double gradient[2][2], middle[2][2];  ///< 1/s, row major
};

struct PlainNode {
  double mass, momentum[2], force[2];
  double start[2], end[2];
};

/// All of a body and the grid it moves through.
template <Modes M>
struct PlainBody {
  std::vector<PlainParticle<M>> particles;
  std::vector<PlainNode> nodes;
  int width = 0, rows = 0;  ///< nodes; node i lies at (i - 1) cells
  double cell = 0.0;        ///< m
  Material material;
  StressSettings<2> settings;
  double lost = 0.0;      ///< share of the residual of the velocity
  double rounding = 0.0;  ///< J/kg, heat that may be negative and shortens no mode
  double dt_limit = 0.0;  ///< s, of the last step
};

/// Cubic B-spline weights and slopes (per cell) of one particle.
struct PlainWeights {
  int base[2];
  double value[2][4], slope[2][4], offset[2][4];  ///< offset of the node, cells
};

inline PlainWeights plain_weights(const double* position, double cell) {
  PlainWeights w;
  for (int a = 0; a < 2; ++a) {
    const double s = position[a] / cell;
    const double floor = std::floor(s);
    const double f = s - floor, g = 1.0 - f;
    w.base[a] = static_cast<int>(floor);
    const double value[4] = {g * g * g / 6.0, (4.0 - 6.0 * f * f + 3.0 * f * f * f) / 6.0,
                             (4.0 - 6.0 * g * g + 3.0 * g * g * g) / 6.0, f * f * f / 6.0};
    const double slope[4] = {-0.5 * g * g, 1.5 * f * f - 2.0 * f, 2.0 * g - 1.5 * g * g,
                             0.5 * f * f};
    for (int i = 0; i < 4; ++i) {
      w.value[a][i] = value[i];
      w.slope[a][i] = slope[i];
      w.offset[a][i] = i - 1 - f;
    }
  }
  return w;
}

/// Calls visit(node, i, j) for the sixteen nodes a particle sees.
template <Modes M, class Visit>
void for_each_plain_node(PlainBody<M>& body, const PlainWeights& w, Visit&& visit) {
  for (int j = 0; j < 4; ++j) {
    PlainNode* const row = body.nodes.data() + (w.base[1] + j) * body.width + w.base[0];
    for (int i = 0; i < 4; ++i) visit(row[i], i, j);
  }
}

/// Modes of norm 1 at the node i, j: 1, x, y and, of PolyFLIP, xx, yy, xy.
template <Modes M>
struct PlainModes {
  double norm[plain_mode_count<M>];  ///< roots of the norms of the plain products

  explicit PlainModes(const PlainWeights& w) {
    norm[0] = 1.0;
    norm[1] = norm[2] = std::sqrt(1.0 / 3.0);
    if constexpr (M == Modes::quadratic) {
      for (int a = 0; a < 2; ++a) {
        const double f = -1.0 - w.offset[a][0];
        norm[3 + a] = std::sqrt(2.0 / 9.0 - f * f * (1.0 - f) * (1.0 - f));
      }
      norm[5] = 1.0 / 3.0;
    }
  }

  std::array<double, plain_mode_count<M>> at(const PlainWeights& w, int i, int j) const {
    const double x = w.offset[0][i], y = w.offset[1][j];
    if constexpr (M == Modes::quadratic) {
      return {1.0,
              x / norm[1],
              y / norm[2],
              (x * x - 1.0 / 3.0) / norm[3],
              (y * y - 1.0 / 3.0) / norm[4],
              x * y / norm[5]};
    } else {
      return {1.0, x / norm[1], y / norm[2]};
    }
  }
};

/// Sorts by cell, as the sweeps like it.
template <Modes M>
void plain_sort(PlainBody<M>& body) {
  const auto cell = [&](const PlainParticle<M>& p) {
    return static_cast<std::size_t>(p.x[1] / body.cell) * static_cast<std::size_t>(body.width) +
           static_cast<std::size_t>(p.x[0] / body.cell);
  };
  std::vector<std::uint32_t> start(body.nodes.size() + 1, 0);
  for (const PlainParticle<M>& p : body.particles) ++start[cell(p) + 1];
  for (std::size_t c = 1; c < start.size(); ++c) start[c] += start[c - 1];
  std::vector<PlainParticle<M>> sorted(body.particles.size());
  for (const PlainParticle<M>& p : body.particles) sorted[start[cell(p)]++] = p;
  body.particles.swap(sorted);
}

/// The body that the particles and the grid of the program make.
template <Modes M>
PlainBody<M> plain_body(const Particles<2>& particles, const GridShape& shape,
                        const Material& material, const StressSettings<2>& settings, double lost) {
  PlainBody<M> body;
  body.lost = lost;
  body.width = shape.row_size;
  body.rows = shape.rows + 3;
  body.cell = shape.cell;
  body.nodes.resize(static_cast<std::size_t>(body.width) * static_cast<std::size_t>(body.rows));
  body.material = material;
  body.settings = settings;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    PlainParticle<M>& q = body.particles.emplace_back();
    q.id = particles.id[p];
    for (int a = 0; a < 2; ++a) {
      q.x[a] = particles.position[a][p];
      q.mode[a][0] = particles.velocity[a][p];
      for (int k = 0; k < 2; ++k) {
        q.mode[a][1 + k] = std::sqrt(1.0 / 3.0) * body.cell * particles.affine[2 * a + k][p];
      }
      if constexpr (M == Modes::quadratic) {
        for (int k = 0; k < 3; ++k) q.mode[a][3 + k] = particles.quadratic[3 * a + k][p];
      }
    }
    q.mass = particles.mass[p];
    q.density = particles.density[p];
    q.pressure = particles.pressure[p];
    q.viscous_pressure = particles.viscous_pressure[p];
    q.energy = particles.internal_energy[p];
    q.plastic_strain = particles.plastic_strain[p];
    q.plastic_work = particles.plastic_work[p];
    for (int k = 0; k < 4; ++k) q.deviator[k] = particles.deviator[k][p];
  }
  plain_sort(body);
  return body;
}

}  // namespace poreshock::reference
