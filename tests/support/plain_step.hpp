#pragma once
// One step of the default scheme in 2-D (cubic B-splines, APIC, averaged dilatation, conserving
// thermodynamics, no walls) the plain way: a particle at a time, a node at a time, structs in
// arrays, particles sorted by cell. It is what the speed of the kernels is measured against, and an
// oracle for the whole step. Not to be tuned.

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "poreshock/core/tensor.hpp"
#include "poreshock/grid/slab_grid.hpp"
#include "poreshock/material/material.hpp"
#include "poreshock/material/strain.hpp"
#include "poreshock/particles/particles.hpp"
#include "poreshock/physics/stress.hpp"

namespace poreshock::reference {

/// One particle, SI units.
struct PlainParticle {
  std::int64_t id;
  double x[2], v[2], C[2][2];
  double mass, density, pressure, viscous_pressure, energy, plastic_strain, plastic_work;
  SymmetricTensor<2> deviator;
  double averaged_pressure, heat, dilatation_end, dilatation_mid;
  double gradient[2][2], middle[2][2];  ///< 1/s, row major
};

struct PlainNode {
  double mass, momentum[2], force[2], kinetic;
  double start[2], end[2], heat, end_energy;
  double volume, pressure, dilatation_end, dilatation_mid;
};

/// All of a body and the grid it moves through.
struct PlainBody {
  std::vector<PlainParticle> particles;
  std::vector<PlainNode> nodes;
  int width = 0, rows = 0;  ///< nodes; node i lies at (i - 1) cells
  double cell = 0.0;        ///< m
  J2MieGruneisen material;
  StressSettings<2> settings;
  double dt_limit = 0.0;  ///< s, of the last step
};

/// Cubic B-spline weights and slopes (per cell) of one particle.
struct PlainWeights {
  int base[2];
  double value[2][4], slope[2][4], offset[2][4];  ///< offset of the node, cells
};

inline PlainWeights plain_weights(const PlainBody& body, const PlainParticle& p) {
  PlainWeights w;
  for (int a = 0; a < 2; ++a) {
    const double s = p.x[a] / body.cell;
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
template <class Visit>
void for_each_plain_node(PlainBody& body, const PlainWeights& w, Visit&& visit) {
  for (int j = 0; j < 4; ++j) {
    PlainNode* const row = body.nodes.data() + (w.base[1] + j) * body.width + w.base[0];
    for (int i = 0; i < 4; ++i) visit(row[i], i, j);
  }
}

inline void plain_average_pressure(PlainBody& body) {
  for (PlainNode& n : body.nodes) n = {};
  for (const PlainParticle& p : body.particles) {
    const PlainWeights w = plain_weights(body, p);
    const double volume = p.mass / p.density;
    for_each_plain_node(body, w, [&](PlainNode& n, int i, int j) {
      const double share = volume * w.value[0][i] * w.value[1][j];
      n.volume += share;
      n.pressure += share * (p.pressure + p.viscous_pressure);
    });
  }
  for (PlainNode& n : body.nodes) {
    if (n.volume > 0.0) n.pressure /= n.volume;
  }
  for (PlainParticle& p : body.particles) {
    const PlainWeights w = plain_weights(body, p);
    p.averaged_pressure = 0.0;
    for_each_plain_node(body, w, [&](const PlainNode& n, int i, int j) {
      p.averaged_pressure += w.value[0][i] * w.value[1][j] * n.pressure;
    });
  }
}

inline void plain_particles_to_grid(PlainBody& body) {
  for (const PlainParticle& p : body.particles) {
    const PlainWeights w = plain_weights(body, p);
    const double volume = p.mass / p.density / body.cell;
    const double xx = p.deviator[0] - p.averaged_pressure;
    const double yy = p.deviator[1] - p.averaged_pressure;
    const double xy = p.deviator[3];
    for_each_plain_node(body, w, [&](PlainNode& n, int i, int j) {
      const double mass = p.mass * w.value[0][i] * w.value[1][j];
      const double dx = w.offset[0][i] * body.cell, dy = w.offset[1][j] * body.cell;
      const double vx = p.v[0] + p.C[0][0] * dx + p.C[0][1] * dy;
      const double vy = p.v[1] + p.C[1][0] * dx + p.C[1][1] * dy;
      const double gx = w.slope[0][i] * w.value[1][j], gy = w.value[0][i] * w.slope[1][j];
      n.mass += mass;
      n.momentum[0] += mass * vx;
      n.momentum[1] += mass * vy;
      n.force[0] -= volume * (xx * gx + xy * gy);
      n.force[1] -= volume * (xy * gx + yy * gy);
      n.kinetic += 0.5 * mass * (vx * vx + vy * vy);
    });
  }
}

inline void plain_update_nodes(double dt, PlainBody& body) {
  for (PlainNode& n : body.nodes) {
    n.volume = 0.0;
    if (n.mass == 0.0) continue;
    double start2 = 0.0, end2 = 0.0;
    for (int a = 0; a < 2; ++a) {
      n.start[a] = n.momentum[a] / n.mass;
      n.end[a] = n.start[a] + dt * n.force[a] / n.mass;
      start2 += n.start[a] * n.start[a];
      end2 += n.end[a] * n.end[a];
    }
    n.heat = n.kinetic / n.mass - 0.5 * start2;
    n.end_energy = 0.5 * end2;
  }
}

inline void plain_average_dilatation(PlainBody& body) {
  for (const PlainParticle& p : body.particles) {
    const PlainWeights w = plain_weights(body, p);
    double end = 0.0, start = 0.0;
    for_each_plain_node(body, w, [&](const PlainNode& n, int i, int j) {
      const double gx = w.slope[0][i] * w.value[1][j], gy = w.value[0][i] * w.slope[1][j];
      end += gx * n.end[0] + gy * n.end[1];
      start += gx * n.start[0] + gy * n.start[1];
    });
    const double volume = p.mass / p.density;
    for_each_plain_node(body, w, [&](PlainNode& n, int i, int j) {
      const double share = volume * w.value[0][i] * w.value[1][j];
      n.volume += share;
      n.dilatation_end += share * end / body.cell;
      n.dilatation_mid += share * 0.5 * (start + end) / body.cell;
    });
  }
  for (PlainNode& n : body.nodes) {
    if (n.volume == 0.0) continue;
    n.dilatation_end /= n.volume;
    n.dilatation_mid /= n.volume;
  }
}

inline void plain_grid_to_particles(double dt, PlainBody& body) {
  for (PlainParticle& p : body.particles) {
    const PlainWeights w = plain_weights(body, p);
    double v[2] = {}, moment[2][2] = {}, end[2][2] = {}, start[2][2] = {};
    double heat = 0.0, energy = 0.0;
    p.dilatation_end = p.dilatation_mid = 0.0;
    for_each_plain_node(body, w, [&](const PlainNode& n, int i, int j) {
      const double N = w.value[0][i] * w.value[1][j];
      const double offset[2] = {w.offset[0][i], w.offset[1][j]};
      const double slope[2] = {w.slope[0][i] * w.value[1][j], w.value[0][i] * w.slope[1][j]};
      for (int a = 0; a < 2; ++a) {
        v[a] += N * n.end[a];
        for (int k = 0; k < 2; ++k) {
          moment[a][k] += N * n.end[a] * offset[k];
          end[a][k] += slope[k] * n.end[a];
          start[a][k] += slope[k] * n.start[a];
        }
      }
      heat += N * n.heat;
      energy += N * n.end_energy;
      p.dilatation_end += N * n.dilatation_end;
      p.dilatation_mid += N * n.dilatation_mid;
    });
    double kept = 0.0;
    for (int a = 0; a < 2; ++a) {
      p.v[a] = v[a];
      p.x[a] += dt * v[a];
      kept += v[a] * v[a];
      for (int k = 0; k < 2; ++k) {
        p.C[a][k] = 3.0 * moment[a][k] / body.cell;
        kept += 3.0 * moment[a][k] * moment[a][k];
        p.gradient[a][k] = end[a][k] / body.cell;
        p.middle[a][k] = 0.5 * (start[a][k] + end[a][k]) / body.cell;
      }
    }
    p.heat = heat + energy - 0.5 * kept;
  }
}

/// The constitutive update of one particle; returns its stable step, s.
inline double plain_stress(const J2MieGruneisen& m, const StressSettings<2>& settings, double dt,
                           PlainParticle& p) {
  const auto& d = p.middle;
  const double shear_rate = 0.5 * (d[0][1] + d[1][0]);
  const double volume = 1.0 / p.density;
  const double power = p.deviator[0] * d[0][0] + p.deviator[1] * d[1][1] +
                       2.0 * p.deviator[3] * shear_rate -
                       (p.pressure + p.viscous_pressure) * p.dilatation_mid;
  p.energy += p.heat + dt * volume * power;
  const double own = p.gradient[0][0] + p.gradient[1][1];
  const auto increment = deformation_increment(
      std::array<double, 4>{1.0 + dt * p.gradient[0][0], dt * p.gradient[0][1],
                            dt * p.gradient[1][0], 1.0 + dt * p.gradient[1][1]});
  p.density /= increment.volume_ratio * (1.0 + dt * p.dilatation_end) / (1.0 + dt * own);
  const auto start = rotate(increment.rotation, p.deviator);
  SymmetricTensor<2> trial;
  for (int k = 0; k < 4; ++k) {
    trial[k] = start[k] + 2.0 * m.strength.shear * increment.strain_deviator[k];
  }
  const auto mapped = radial_return<2, false>(m.strength, start, trial, {}, p.plastic_strain);
  p.deviator = mapped.deviator;
  p.plastic_strain += mapped.plastic_strain_increment;
  p.plastic_work += 0.5 * (volume + 1.0 / p.density) * mapped.plastic_work;
  const double stored = m.deviatoric_energy(contract<2>(p.deviator, p.deviator), p.density);
  const EquationOfState eos = conserving_state(m.eos, p.density, p.energy - stored);
  p.pressure = eos.pressure;
  const double c =
      std::sqrt(std::max(eos.sound_speed2, 0.0) + 4.0 * m.strength.shear / (3.0 * p.density));
  const double closing = std::max(0.0, -settings.cell * p.dilatation_end);
  const double linear = settings.viscosity.linear, quadratic = settings.viscosity.quadratic;
  p.viscous_pressure = p.density * (quadratic * closing * closing + linear * c * closing);
  const double q = closing > 0.0 ? linear * c + quadratic * closing : 0.0;
  double rate = 0.0;
  for (const auto& row : p.gradient) rate = std::max({rate, std::abs(row[0]), std::abs(row[1])});
  const double speed = std::max(std::abs(p.v[0]), std::abs(p.v[1]));
  const double wave = settings.cfl * settings.cell / (speed + q + std::sqrt(q * q + c * c));
  return std::min(wave, 0.2 / rate);
}

/// Sorts by cell, as the sweeps like it.
inline void plain_sort(PlainBody& body) {
  const auto cell = [&](const PlainParticle& p) {
    return static_cast<std::size_t>(p.x[1] / body.cell) * static_cast<std::size_t>(body.width) +
           static_cast<std::size_t>(p.x[0] / body.cell);
  };
  std::vector<std::uint32_t> start(body.nodes.size() + 1, 0);
  for (const PlainParticle& p : body.particles) ++start[cell(p) + 1];
  for (std::size_t c = 1; c < start.size(); ++c) start[c] += start[c - 1];
  std::vector<PlainParticle> sorted(body.particles.size());
  for (const PlainParticle& p : body.particles) sorted[start[cell(p)]++] = p;
  body.particles.swap(sorted);
}

inline void plain_step(double dt, PlainBody& body) {
  plain_average_pressure(body);
  plain_particles_to_grid(body);
  plain_update_nodes(dt, body);
  plain_average_dilatation(body);
  plain_grid_to_particles(dt, body);
  body.dt_limit = 1.0;
  for (PlainParticle& p : body.particles) {
    body.dt_limit = std::min(body.dt_limit, plain_stress(body.material, body.settings, dt, p));
  }
}

/// The body that the particles and the grid of the program make.
inline PlainBody plain_body(const Particles<2>& particles, const GridShape& shape,
                            const Material& material, const StressSettings<2>& settings) {
  PlainBody body;
  body.width = shape.row_size;
  body.rows = shape.rows + 3;
  body.cell = shape.cell;
  body.nodes.resize(static_cast<std::size_t>(body.width) * static_cast<std::size_t>(body.rows));
  body.material = std::get<J2MieGruneisen>(material);
  body.settings = settings;
  for (std::size_t p = 0; p < particles.size(); ++p) {
    PlainParticle& q = body.particles.emplace_back();
    q.id = particles.id[p];
    for (int a = 0; a < 2; ++a) {
      q.x[a] = particles.position[a][p];
      q.v[a] = particles.velocity[a][p];
      for (int k = 0; k < 2; ++k) q.C[a][k] = particles.affine[2 * a + k][p];
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
