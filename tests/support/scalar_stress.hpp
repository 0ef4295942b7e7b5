#pragma once
// The constitutive update of one particle, written apart from the program: full 3 x 3 matrices,
// logarithms by eigenvalues, the equation of state as a function of the volume. Plane strain is the
// case without out-of-plane gradient. SI; pressure positive in compression, stress in tension.

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "poreshock/material/material.hpp"
#include "support/reference_eos.hpp"

namespace poreshock::reference {

/// The solid and how its plastic work becomes heat.
struct StressLaw {
  Solid solid;
  bool conserving = true;        ///< else the thermodynamics of the paper
  bool heat_is_all_work = true;  ///< else only the dissipation is heat
  double linear = 0.6;           ///< artificial viscosity
  double quadratic = 2.25;
  double cell = 0.0;  ///< m
  double cfl = 0.35;
  double spall = std::numeric_limits<double>::infinity();   ///< Pa, tension
  double opened = std::numeric_limits<double>::infinity();  ///< Pa, of the solid when it fails
  /// In place of linear hardening, Pa of plastic strain and rate (1/s).
  std::function<double(double, double)> flow{};
};

/// State of one particle.
struct PointState {
  double density = 0.0;
  double pressure = 0.0;
  double viscous_pressure = 0.0;
  double energy = 0.0;  ///< J/kg, elastic part included
  double plastic_strain = 0.0;
  double plastic_work = 0.0;  ///< J/kg, the part that is heat
  Eigen::Matrix3d deviator = Eigen::Matrix3d::Zero();
  Eigen::Matrix3d back_stress = Eigen::Matrix3d::Zero();
  bool failed = false;
};

/// What the grid tells the particle.
struct PointMotion {
  Eigen::Matrix3d gradient = Eigen::Matrix3d::Zero();  ///< 1/s, at the end of the step
  Eigen::Matrix3d rate = Eigen::Matrix3d::Zero();      ///< 1/s, symmetric, at its middle
  double heat = 0.0;                                   ///< J/kg
  double speed = 0.0;                    ///< m/s, largest component relative to the grid
  double linear = 1.0, quadratic = 1.0;  ///< shares of the artificial viscosity that act
};

struct PointReport {
  double dt_limit = 0.0;
  double viscous_heat = 0.0;  ///< J/kg
  double sound_speed = 0.0;   ///< m/s, longitudinal
};

/// Rotation and logarithm of the left stretch of I + H.
struct Stretch {
  Eigen::Matrix3d rotation, logarithm;
};

inline Stretch left_stretch(const Eigen::Matrix3d& H) {
  // B - I without the cancellation of forming B first.
  const Eigen::Matrix3d excess = H + H.transpose() + H * H.transpose();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(excess);
  const Eigen::Vector3d logs = 0.5 * solver.eigenvalues().array().log1p().matrix();
  const Eigen::Matrix3d Q = solver.eigenvectors();
  const Eigen::Vector3d inverses = (-logs).array().exp().matrix();
  return {Q * inverses.asDiagonal() * Q.transpose() * (Eigen::Matrix3d::Identity() + H),
          Q * logs.asDiagonal() * Q.transpose()};
}

/// Flow stress of Johnson & Cook at a temperature (K).
inline std::function<double(double, double)> johnson_cook(const JohnsonCookParameters& p,
                                                          double temperature) {
  const double cold =
      (temperature - p.reference_temperature) / (p.melting - p.reference_temperature);
  const double soft = 1.0 - std::pow(std::clamp(cold, 0.0, 1.0), p.softening);
  return [=](double strain, double rate) {
    const double hardened = p.yield + p.hardening * std::pow(strain, p.exponent);
    return hardened * (1.0 + p.rate * std::log(std::max(1.0, rate / p.reference_rate))) * soft;
  };
}

/// Flow stress of Steinberg, Cochran & Guinan at pressure (Pa), compression and temperature (K).
inline std::function<double(double, double)> steinberg_guinan(const SteinbergGuinanParameters& p,
                                                              double pressure, double compression,
                                                              double temperature) {
  const double modulus = 1.0 + p.pressure_rise * pressure / std::cbrt(compression) -
                         p.temperature_fall * (temperature - p.reference_temperature);
  return [=](double strain, double) {
    const double hardened =
        p.yield * std::pow(1.0 + p.hardening * (strain + p.initial_strain), p.exponent);
    return std::min(hardened, p.limit) * std::max(modulus, 0.0);
  };
}

/// Return by a flow stress over dt, found by bisection; returns the heat per volume.
inline double return_to_flow(const StressLaw& law, const Eigen::Matrix3d& start, double dt,
                             PointState& p) {
  const double equivalent = std::sqrt(1.5) * p.deviator.norm();
  const double triple_shear = 3.0 * law.solid.shear;
  if (equivalent <= law.flow(p.plastic_strain, 0.0)) return 0.0;
  double low = 0.0, high = equivalent / triple_shear;
  for (int k = 0; k < 200; ++k) {
    const double d = 0.5 * (low + high);
    (equivalent - triple_shear * d > law.flow(p.plastic_strain + d, d / dt) ? low : high) = d;
  }
  const Eigen::Matrix3d normal = p.deviator / p.deviator.norm();
  p.deviator -= std::sqrt(6.0) * law.solid.shear * low * normal;
  p.plastic_strain += low;
  return std::sqrt(1.5) * low * (0.5 * (start + p.deviator)).cwiseProduct(normal).sum();
}

/// Return to the yield surface in place; `start` is the rotated deviator of the start of the step.
/// Returns the heat per volume.
inline double return_to_yield(const StressLaw& law, const Eigen::Matrix3d& start, PointState& p) {
  const Solid& m = law.solid;
  const double isotropic = (1.0 - m.kinematic_share) * m.hardening;
  const double kinematic = m.kinematic_share * m.hardening;
  const Eigen::Matrix3d xi = p.deviator - p.back_stress;
  const double excess = std::sqrt(1.5) * xi.norm() - (m.yield + isotropic * p.plastic_strain);
  if (excess <= 0.0) return 0.0;
  const double step = excess / (3.0 * m.shear + m.hardening);
  const Eigen::Matrix3d normal = xi / xi.norm();
  p.deviator -= std::sqrt(6.0) * m.shear * step * normal;
  p.back_stress += std::sqrt(2.0 / 3.0) * kinematic * step * normal;
  const double before = p.plastic_strain;
  p.plastic_strain += step;
  if (!law.heat_is_all_work) {
    return m.yield * step +
           0.5 * isotropic * (p.plastic_strain * p.plastic_strain - before * before);
  }
  const Eigen::Matrix3d middle = 0.5 * (start + p.deviator);
  return std::sqrt(1.5) * step * middle.cwiseProduct(normal).sum();
}

/// Energy per mass that is stored in the deviator and, where it is not heat, in the back stress.
inline double stored_energy(const StressLaw& law, const PointState& p) {
  const Solid& m = law.solid;
  const double kinematic = m.kinematic_share * m.hardening;
  double stored = m.shear > 0.0 ? p.deviator.squaredNorm() / (4.0 * m.shear) / p.density : 0.0;
  if (!law.heat_is_all_work && kinematic > 0.0) {
    stored += 3.0 * p.back_stress.squaredNorm() / (4.0 * kinematic) / p.density;
  }
  return stored;
}

/// Takes the strength away: elastic energy stays in the energy, tension and shear vanish.
inline void fail(const StressLaw& law, double v, PointReport& report, PointState& p) {
  p.failed = true;
  p.deviator.setZero();
  p.back_stress.setZero();
  if (law.conserving) p.pressure = pressure(law.solid, v, p.energy);
  if (p.pressure >= 0.0) return;
  p.pressure = 0.0;
  report.sound_speed = std::sqrt(law.solid.c0 * law.solid.c0 + 4.0 / 3.0 * law.solid.shear * v);
}

/// Advances one particle by dt.
inline PointReport advance_point(const StressLaw& law, const PointMotion& motion, double dt,
                                 PointState& p) {
  const Solid& m = law.solid;
  const double mid = motion.rate.trace();
  const double v0 = 1.0 / p.density;
  PointReport report;
  report.viscous_heat = -dt * v0 * p.viscous_pressure * mid;
  p.energy += motion.heat + report.viscous_heat +
              dt * v0 * (p.deviator.cwiseProduct(motion.rate).sum() - p.pressure * mid);

  const Eigen::Matrix3d H = dt * motion.gradient;
  const Stretch stretch = left_stretch(H);
  p.density /= (Eigen::Matrix3d::Identity() + H).determinant();
  const Eigen::Matrix3d& R = stretch.rotation;
  const Eigen::Matrix3d start = R * p.deviator * R.transpose();
  p.back_stress = (R * p.back_stress * R.transpose()).eval();
  p.deviator = start + 2.0 * (p.failed ? 0.0 : m.shear) *
                           (stretch.logarithm -
                            stretch.logarithm.trace() / 3.0 * Eigen::Matrix3d::Identity());
  const double heat_per_volume =
      law.flow ? return_to_flow(law, start, dt, p) : return_to_yield(law, start, p);
  const double v = 1.0 / p.density;
  p.plastic_work += 0.5 * (v0 + v) * heat_per_volume;

  if (law.conserving) {
    const double thermal = p.energy - stored_energy(law, p);
    p.pressure = pressure(m, v, thermal);
    report.sound_speed = longitudinal_speed(m, v, thermal);
  } else {
    p.pressure = curve_pressure(m, v) + m.gamma / v * p.plastic_work;
    const double bulk2 = -v * v * curve_slope(m, v) + m.gamma * p.plastic_work;
    report.sound_speed = std::sqrt(bulk2 + 4.0 / 3.0 * m.shear * v);
  }
  if (p.failed || p.pressure < -law.opened) {
    fail(law, v, report, p);
  } else if (p.pressure < -law.spall) {
    p.pressure = -law.spall;
    report.sound_speed = std::sqrt(m.c0 * m.c0 + 4.0 / 3.0 * m.shear * v);
  }
  const double closing = std::max(0.0, -motion.gradient.trace()) * law.cell;
  const double c = report.sound_speed;
  const double faded = closing / (closing + 1e-6 * c);
  const double linear = law.linear * motion.linear * faded;
  const double quadratic = law.quadratic * motion.quadratic;
  p.viscous_pressure = p.density * (quadratic * closing * closing + linear * c * closing);
  const double Q = closing > 0.0 ? linear * c + quadratic * closing : 0.0;
  const double wave = law.cfl * law.cell / (motion.speed + Q + std::hypot(Q, c));
  const double largest = motion.gradient.cwiseAbs().maxCoeff();
  report.dt_limit = largest > 0.0 ? std::min(wave, 0.2 / largest) : wave;
  return report;
}

}  // namespace poreshock::reference
