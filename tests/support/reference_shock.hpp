#pragma once
// Exact planar shocks, releases and crush curves of an elastic-plastic Mie-Grueneisen solid: the
// oracles of many tests. Uniaxial strain, logarithmic: the von Mises stress follows from
// L = ln(V0/V) alone as long as loading goes one way. SI units, compression positive.

#include <algorithm>
#include <cmath>

#include "support/reference_eos.hpp"

namespace poreshock::reference {

/// Two jumps of a piston driven at constant speed; without strength, or when the second front
/// overtakes the first, only `shocked` counts.
struct Piston {
  bool two_waves = false;
  bool elastic = false;  ///< slower than the yield point: one elastic wave
  State precursor;
  State shocked;
};

/// Elastic energy per mass of the deviator at von Mises stress q that is no part of the energy in
/// the equation of state, J/kg.
inline double deviator_energy(const Solid& m, double v, double q) {
  return m.shear > 0.0 && !m.elastic_energy_heats ? v * q * q / (6.0 * m.shear) : 0.0;
}

/// State at volume v and von Mises stress q behind a jump from `ahead`: momentum, mass, energy;
/// pressure linear in energy. Without its temperature, which costs an integral.
inline State jump_to(const Solid& m, const State& ahead, double v, double q) {
  State s;
  s.volume = v;
  s.flow_stress = q;
  const double trial = 2.0 * m.shear * std::log(m.volume() / v);
  s.plastic_strain = m.shear > 0.0 ? std::max(trial - q, 0.0) / (3.0 * m.shear) : 0.0;
  const double axial = 2.0 / 3.0 * q;
  const double before = ahead.energy + deviator_energy(m, ahead.volume, ahead.flow_stress);
  const double stored = deviator_energy(m, v, q);
  const double half = 0.5 * (ahead.volume - v);
  const double g = m.gamma / v;
  s.pressure = (curve_pressure(m, v) +
                g * (before + half * (axial + ahead.stress) - stored - curve_energy(m, v))) /
               (1.0 - g * half);
  s.stress = s.pressure + axial;
  s.energy = before + half * (s.stress + ahead.stress) - stored;
  const double jump = std::sqrt((s.stress - ahead.stress) * (ahead.volume - v));
  s.velocity = ahead.velocity + jump;
  s.front = ahead.velocity + ahead.volume * jump / (ahead.volume - v);
  return s;
}

/// The same with linear hardening.
inline State mechanical_jump(const Solid& m, const State& ahead, double v) {
  const double trial = 2.0 * m.shear * std::log(m.volume() / v);
  const double excess = std::max(trial - m.yield, 0.0);
  const double strain = m.shear > 0.0 ? excess / (3.0 * m.shear + m.hardening) : 0.0;
  State s = jump_to(m, ahead, v, trial - 3.0 * m.shear * strain);
  s.plastic_strain = strain;
  return s;
}

/// The same with its temperature.
inline State behind_jump(const Solid& m, const State& ahead, double v) {
  State s = mechanical_jump(m, ahead, v);
  s.temperature = temperature(m, v, s.energy);
  return s;
}

/// Undisturbed material at rest.
inline State at_rest(const Solid& m) {
  State s;
  s.volume = m.volume();
  s.temperature = m.T0;
  return s;
}

/// The state behind the elastic precursor (yield point of the solid).
inline State yield_point(const Solid& m) {
  return behind_jump(m, at_rest(m), m.volume() * std::exp(-m.yield / (2.0 * m.shear)));
}

/// Elastic-plastic shock of a piston at speed up > 0.
inline Piston piston(const Solid& m, double up) {
  const auto reach = [&](const State& ahead) {
    const double v = first_root(
        [&](double x) {
          const double velocity = mechanical_jump(m, ahead, x).velocity;
          return velocity - up;
        },
        ahead.volume * (1.0 - 1e-9), ahead.volume * 0.55);
    return behind_jump(m, ahead, v);
  };
  Piston p;
  if (m.shear > 0.0 && m.yield > 0.0) {
    p.precursor = yield_point(m);
    p.elastic = up <= p.precursor.velocity;
    if (!p.elastic) {
      p.shocked = reach(p.precursor);
      p.two_waves = p.shocked.front < p.precursor.front;
    }
  }
  if (!p.two_waves) p.shocked = reach(at_rest(m));
  return p;
}

/// Piston speed above which one front is left, m/s.
inline double overdriven_above(const Solid& m) {
  const State precursor = yield_point(m);
  const double v =
      first_root([&](double x) { return mechanical_jump(m, precursor, x).front - precursor.front; },
                 precursor.volume * 0.999, precursor.volume * 0.55);
  return behind_jump(m, precursor, v).velocity;
}

/// The state a stress-free surface leaves behind.
struct Released {
  double surface_velocity = 0.0;  ///< m/s, in the frame of the state it came from
  double volume = 0.0;            ///< m^3/kg
  double temperature = 0.0;       ///< K
  double plastic_strain = 0.0;
};

namespace detail {

/// What a release wave integrates over the volume.
struct Fan {
  double energy, velocity;
};

/// The unloading branch at volume v: von Mises stress (signed), plastic strain, d(stress)/dv and
/// the plastic work per dv. `reversed` selects the side of the reverse yield point.
struct Unloading {
  double flow_stress, plastic_strain, slope, work;
};

/// Half of the elastic range of a shocked state, Pa.
inline double yield_radius(const Solid& m, const State& from) {
  return from.flow_stress - m.kinematic_share * m.hardening * from.plastic_strain;
}

inline Unloading unloading(const Solid& m, const State& from, bool reversed, double v) {
  if (m.shear <= 0.0) return {0.0, from.plastic_strain, 0.0, 0.0};
  const double strain = std::log(v / from.volume);
  if (!reversed) {
    return {from.flow_stress - 2.0 * m.shear * strain, from.plastic_strain, -2.0 * m.shear / v,
            0.0};
  }
  const double radius = yield_radius(m, from);
  const double share = 2.0 * m.shear / (3.0 * m.shear + m.hardening);
  const double plastic = share * (strain - radius / m.shear);
  const double q = from.flow_stress - 2.0 * radius - m.hardening * plastic;
  return {q, from.plastic_strain + plastic, -m.hardening * share / v, -q * share};
}

inline double stress(const Solid& m, const State& from, bool reversed, double v, double e) {
  return pressure(m, v, e) + 2.0 / 3.0 * unloading(m, from, reversed, v).flow_stress;
}

/// de/dv and du/dv of a simple wave.
inline Fan fan_slope(const Solid& m, const State& from, bool reversed, double v, double e) {
  const Unloading u = unloading(m, from, reversed, v);
  const double energy_slope = -pressure(m, v, e) + u.work;
  const double stress_slope = pressure_slope(m, v, e, energy_slope) + 2.0 / 3.0 * u.slope;
  return {energy_slope, std::sqrt(-stress_slope)};
}

/// One classical Runge-Kutta step; the velocity follows from the same stages.
inline Fan advance(const Solid& m, const State& from, bool reversed, double v, const Fan& y,
                   double h) {
  const auto at = [&](double x, double e) { return fan_slope(m, from, reversed, v + x, e); };
  const Fan a = at(0.0, y.energy);
  const Fan b = at(0.5 * h, y.energy + 0.5 * h * a.energy);
  const Fan c = at(0.5 * h, y.energy + 0.5 * h * b.energy);
  const Fan d = at(h, y.energy + h * c.energy);
  return {y.energy + h / 6.0 * (a.energy + 2.0 * (b.energy + c.energy) + d.energy),
          y.velocity + h / 6.0 * (a.velocity + 2.0 * (b.velocity + c.velocity) + d.velocity)};
}

}  // namespace detail

/// Release of a shocked state to zero axial stress through a simple wave: elastic, then reverse
/// plastic flow with the solid's mix of hardenings; all plastic work is heat.
inline Released release(const Solid& m, const State& from, int steps = 4000) {
  const double step = 0.5 * m.volume() / steps;
  const double reverse =
      m.shear > 0.0 ? from.volume * std::exp(detail::yield_radius(m, from) / m.shear) : 0.0;
  detail::Fan y{from.energy, from.velocity};
  double v = from.volume;
  bool reversed = false;
  for (;;) {
    if (v == reverse) reversed = true;
    double end = v + step;
    // A step ends where slopes jump: at reverse yield and at V0.
    for (const double edge : {reverse, m.volume()}) {
      if (v < edge && end > edge) end = edge;
    }
    const detail::Fan next = detail::advance(m, from, reversed, v, y, end - v);
    if (detail::stress(m, from, reversed, end, next.energy) > 0.0) {
      v = end;
      y = next;
      continue;
    }
    const auto left = [&](double x) {
      return detail::stress(m, from, reversed, v + x,
                            detail::advance(m, from, reversed, v, y, x).energy);
    };
    const double last = first_root(left, 0.0, end - v, 1);
    y = detail::advance(m, from, reversed, v, y, last);
    v += last;
    return {y.velocity, v, temperature(m, v, y.energy),
            detail::unloading(m, from, reversed, v).plastic_strain};
  }
}

/// Speed of the head of the release in the undeformed material, m/s.
inline double release_head(const Solid& m, const State& s) {
  return longitudinal_speed(m, s.volume, s.energy) * m.volume() / s.volume;
}

/// Static crush pressure (on the porous body) of a perfectly plastic matrix with cylindrical voids
/// in plane strain at distension alpha = V/Vs > 1, Pa.
inline double crush_pressure(double yield, double distension) {
  return yield / std::sqrt(3.0) * std::log(distension / (distension - 1.0));
}

/// The distension a pressure crushes to, at most `initial`.
inline double crushed_distension(double yield, double pressure, double initial) {
  return std::min(initial, -1.0 / std::expm1(-std::sqrt(3.0) * pressure / yield));
}

/// Work of crushing the voids completely, per volume of solid, J/m^3.
inline double crush_work(double yield, double distension) {
  const double rest = distension - 1.0;
  return yield / std::sqrt(3.0) * (distension * std::log(distension) - rest * std::log(rest));
}

/// Shock in a porous solid whose voids close along the crush curve (P = Ps/alpha), one front.
/// `volume` of the result is that of the porous body; the distension is returned beside it.
struct Crushed {
  State state;
  double distension = 1.0;
  double porosity() const { return 1.0 - 1.0 / distension; }
};

inline Crushed crush(const Solid& m, double porosity, double up) {
  const double initial = 1.0 / (1.0 - porosity);
  const double v00 = m.volume() * initial;
  const double e = 0.5 * up * up;
  const auto macroscopic = [&](double alpha, double v) {
    return pressure(m, v / alpha, e) / alpha;
  };
  // Given the distension, momentum fixes the volume; the crush curve then fixes the distension.
  const auto volume_at = [&](double alpha) {
    return first_root([&](double v) { return macroscopic(alpha, v) * (v00 - v) - up * up; }, v00,
                      0.4 * m.volume());
  };
  const auto misfit = [&](double log_rest) {
    const double alpha = 1.0 + std::exp(log_rest);
    return macroscopic(alpha, volume_at(alpha)) - crush_pressure(m.yield, alpha);
  };
  Crushed c;
  // Closed to the last digit of a double where the curve asks for less than e^-36.
  constexpr double closed = -36.0;
  c.distension = misfit(closed) > 0.0
                     ? 1.0
                     : 1.0 + std::exp(first_root(misfit, std::log(initial - 1.0), closed, 200));
  c.state.volume = volume_at(c.distension);
  c.state.velocity = up;
  c.state.pressure = c.state.stress = macroscopic(c.distension, c.state.volume);
  c.state.front = up * v00 / (v00 - c.state.volume);
  c.state.energy = e;
  c.state.temperature = temperature(m, c.state.volume / c.distension, e);
  return c;
}

}  // namespace poreshock::reference
