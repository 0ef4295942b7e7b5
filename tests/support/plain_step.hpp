#pragma once
// One step of AFLIP or PolyFLIP in 2-D (cubic B-splines, limited viscosity, conserving
// thermodynamics, no walls) the plain way: a particle at a time, a node at a time, structs in
// arrays, particles sorted by cell. It is what the speed of the kernels is measured against, and an
// oracle for the whole step. Not to be tuned.

#include <algorithm>
#include <cmath>

#include "poreshock/material/strain.hpp"
#include "support/plain_body.hpp"

namespace poreshock::reference {

template <Modes M>
void plain_particles_to_grid(PlainBody<M>& body) {
  for (PlainNode& n : body.nodes) n = {};
  for (const PlainParticle<M>& p : body.particles) {
    const PlainWeights w = plain_weights(p.x, body.cell);
    const PlainModes<M> modes(w);
    const double volume = p.mass / p.density / body.cell;
    const double pressure = p.pressure + p.viscous_pressure;
    const double xx = p.deviator[0] - pressure;
    const double yy = p.deviator[1] - pressure;
    const double xy = p.deviator[3];
    for_each_plain_node(body, w, [&](PlainNode& n, int i, int j) {
      const double mass = p.mass * w.value[0][i] * w.value[1][j];
      const auto phi = modes.at(w, i, j);
      const double gx = w.slope[0][i] * w.value[1][j], gy = w.value[0][i] * w.slope[1][j];
      n.mass += mass;
      for (int a = 0; a < 2; ++a) {
        for (int k = 0; k < plain_mode_count<M>; ++k) n.momentum[a] += mass * p.mode[a][k] * phi[k];
      }
      n.force[0] -= volume * (xx * gx + xy * gy);
      n.force[1] -= volume * (xy * gx + yy * gy);
    });
  }
}

template <Modes M>
void plain_update_nodes(double dt, PlainBody<M>& body) {
  for (PlainNode& n : body.nodes) {
    if (n.mass == 0.0) continue;
    for (int a = 0; a < 2; ++a) {
      n.start[a] = n.momentum[a] / n.mass;
      n.end[a] = n.start[a] + dt * n.force[a] / n.mass;
    }
  }
}

/// What a particle sees of the nodes.
template <Modes M>
struct PlainMoments {
  double start[2][plain_mode_count<M>], end[2][plain_mode_count<M>];  ///< of the modes
  double kinetic;       ///< sum N (|v' - v|^2/2 + lost v.v')
  double across[2][4];  ///< end velocity along each axis at its four nodes
};

template <Modes M>
PlainMoments<M> plain_moments(const PlainWeights& w, PlainBody<M>& body, PlainParticle<M>& p) {
  const PlainModes<M> modes(w);
  PlainMoments<M> m{};
  double end[2][2] = {}, start[2][2] = {};
  for_each_plain_node(body, w, [&](const PlainNode& n, int i, int j) {
    const double N = w.value[0][i] * w.value[1][j];
    const auto phi = modes.at(w, i, j);
    const double slope[2] = {w.slope[0][i] * w.value[1][j], w.value[0][i] * w.slope[1][j]};
    for (int a = 0; a < 2; ++a) {
      for (int k = 0; k < plain_mode_count<M>; ++k) {
        m.start[a][k] += N * phi[k] * n.start[a];
        m.end[a][k] += N * phi[k] * n.end[a];
      }
      for (int k = 0; k < 2; ++k) {
        end[a][k] += slope[k] * n.end[a];
        start[a][k] += slope[k] * n.start[a];
      }
      const double change = n.end[a] - n.start[a];
      m.kinetic += N * (0.5 * change * change + body.lost * n.start[a] * n.end[a]);
    }
    m.across[0][i] += w.value[1][j] * n.end[0];
    m.across[1][j] += w.value[0][i] * n.end[1];
  });
  for (int a = 0; a < 2; ++a) {
    for (int k = 0; k < 2; ++k) {
      p.gradient[a][k] = end[a][k] / body.cell;
      p.middle[a][k] = 0.5 * (start[a][k] + end[a][k]) / body.cell;
    }
  }
  return m;
}

/// New modes and the heat of the transfer; modes are shortened where it would be negative.
template <Modes M>
void plain_modes(const PlainMoments<M>& m, double lost, double rounding, PlainParticle<M>& p) {
  double heat = m.kinetic, energy = 0.0;
  for (int a = 0; a < 2; ++a) {
    for (int k = 0; k < plain_mode_count<M>; ++k) {
      const double residual = p.mode[a][k] - m.start[a][k];
      const double change = m.end[a][k] - m.start[a][k];
      const double decay = k == 0 ? lost * (1.0 - 0.5 * lost) : 0.5;
      heat +=
          decay * residual * residual - 0.5 * change * change - lost * m.start[a][k] * m.end[a][k];
      if (k > 0) heat += (1.0 - lost) * residual * m.end[a][k];
      if (k > 0) energy += m.end[a][k] * m.end[a][k];
      p.mode[a][k] = m.end[a][k] + (k == 0 ? (1.0 - lost) * residual : 0.0);
    }
  }
  const double missing = std::min(heat + rounding, 0.0);
  const double factor =
      std::sqrt(std::max(0.0, 1.0 + 2.0 * missing / (energy > 0.0 ? energy : 1.0)));
  for (int a = 0; a < 2; ++a) {
    for (int k = 1; k < plain_mode_count<M>; ++k) p.mode[a][k] *= factor;
  }
  p.heat = heat - missing;
}

/// Shares of the artificial viscosity that act.
template <Modes M>
void plain_limiter(const PlainMoments<M>& m, PlainParticle<M>& p) {
  double linear = 0.0, quadratic = 0.0, closing = 0.0;
  for (int a = 0; a < 2; ++a) {
    const double rate = std::max(0.0, -p.gradient[a][a]);
    const double* v = m.across[a];
    const double own = v[2] - v[1];
    closing += rate;
    const double floor = 1e-6 * (std::abs(v[1] - v[0]) + std::abs(own) + std::abs(v[3] - v[2]));
    if (floor == 0.0) continue;
    const double inverse = own / (own * own + floor * floor);
    const double r = (v[1] - v[0]) * inverse, s = (v[3] - v[2]) * inverse;
    const double least = std::clamp(std::min(r, s), 0.0, 1.0);
    linear += rate * (1.0 - std::clamp(std::min({0.5 * (r + s), 3.0 * r, 3.0 * s}), 0.0, 1.0));
    quadratic += rate * (1.0 - least * least * least * least);
  }
  p.viscous_linear = closing > 0.0 ? linear / closing : 0.0;
  p.viscous_quadratic = closing > 0.0 ? quadratic / closing : 0.0;
}

template <Modes M>
void plain_grid_to_particles(double dt, PlainBody<M>& body) {
  for (PlainParticle<M>& p : body.particles) {
    const PlainMoments<M> m = plain_moments(plain_weights(p.x, body.cell), body, p);
    for (int a = 0; a < 2; ++a) p.x[a] += dt * m.end[a][0];
    plain_modes(m, body.lost, body.rounding, p);
    plain_limiter(m, p);
  }
}

/// The constitutive update of one particle; returns its stable step, s.
template <Modes M>
double plain_stress(const Material& m, const StressSettings<2>& settings, double dt,
                    PlainParticle<M>& p) {
  const auto& d = p.middle;
  const double shear_rate = 0.5 * (d[0][1] + d[1][0]);
  const double volume = 1.0 / p.density;
  const double power = p.deviator[0] * d[0][0] + p.deviator[1] * d[1][1] +
                       2.0 * p.deviator[3] * shear_rate -
                       (p.pressure + p.viscous_pressure) * (d[0][0] + d[1][1]);
  p.energy += p.heat + dt * volume * power;
  const auto increment = deformation_increment(
      std::array<double, 4>{1.0 + dt * p.gradient[0][0], dt * p.gradient[0][1],
                            dt * p.gradient[1][0], 1.0 + dt * p.gradient[1][1]});
  p.density /= increment.volume_ratio;
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
  const double closing = std::max(0.0, -settings.cell * (p.gradient[0][0] + p.gradient[1][1]));
  const double faded = closing / (closing + 1e-6 * c);
  const double linear = settings.viscosity.linear * p.viscous_linear * faded;
  const double quadratic = settings.viscosity.quadratic * p.viscous_quadratic;
  p.viscous_pressure = p.density * (quadratic * closing * closing + linear * c * closing);
  const double q = closing > 0.0 ? linear * c + quadratic * closing : 0.0;
  double rate = 0.0;
  for (const auto& row : p.gradient) rate = std::max({rate, std::abs(row[0]), std::abs(row[1])});
  const double speed = std::max(std::abs(p.mode[0][0]), std::abs(p.mode[1][0]));
  const double wave = settings.cfl * settings.cell / (speed + q + std::sqrt(q * q + c * c));
  return std::min(wave, 0.2 / rate);
}

template <Modes M>
void plain_step(double dt, PlainBody<M>& body) {
  plain_particles_to_grid(body);
  plain_update_nodes(dt, body);
  plain_grid_to_particles(dt, body);
  body.dt_limit = 1.0;
  for (PlainParticle<M>& p : body.particles) {
    body.dt_limit = std::min(body.dt_limit, plain_stress(body.material, body.settings, dt, p));
  }
}

}  // namespace poreshock::reference
