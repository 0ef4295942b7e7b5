#include "poreshock/transfer/grid_to_particles.hpp"

#include "poreshock/transfer/node_lanes.hpp"
#include "poreshock/transfer/sweep.hpp"

namespace poreshock {

namespace {

/// Moments of the nodal lanes over a stencil: values, gradients (per cell), first moments (cells).
template <int Dim>
struct Moments {
  Lanes value;
  std::array<Lanes, Dim> gradient;
  std::array<Lanes, Dim> moment;
};

template <class Spline, bool Affine>
inline Moments<2> moments(const Stencil<2, Spline>& s, const Lanes* nodes) {
  constexpr int w = Spline::width;
  const AxisWeights<w>& x = s.axis[0];
  const AxisWeights<w>& y = s.axis[1];
  Moments<2> m{};
#pragma GCC unroll 4
  for (int j = 0; j < w; ++j) {
    Lanes value{}, slope{}, moment{};
#pragma GCC unroll 4
    for (int i = 0; i < w; ++i) {
      value += x.value[i] * nodes[j * w + i];
      slope += x.slope[i] * nodes[j * w + i];
      if constexpr (Affine) moment += (x.value[i] * x.offset[i]) * nodes[j * w + i];
    }
    m.value += y.value[j] * value;
    m.gradient[0] += y.value[j] * slope;
    m.gradient[1] += y.slope[j] * value;
    if constexpr (Affine) {
      m.moment[0] += y.value[j] * moment;
      m.moment[1] += (y.value[j] * y.offset[j]) * value;
    }
  }
  return m;
}

template <class Spline, bool Affine>
inline Moments<3> moments(const Stencil<3, Spline>& s, const Lanes* nodes) {
  constexpr int w = Spline::width;
  Moments<3> m{};
  for (int k = 0; k < w; ++k) {
    const Stencil<2, Spline> plane = {{s.axis[0], s.axis[1]}};
    const Moments<2> p = moments<Spline, Affine>(plane, nodes + k * w * w);
    m.value += s.axis[2].value[k] * p.value;
    m.gradient[0] += s.axis[2].value[k] * p.gradient[0];
    m.gradient[1] += s.axis[2].value[k] * p.gradient[1];
    m.gradient[2] += s.axis[2].slope[k] * p.value;
    if constexpr (Affine) {
      m.moment[0] += s.axis[2].value[k] * p.moment[0];
      m.moment[1] += s.axis[2].value[k] * p.moment[1];
      m.moment[2] += (s.axis[2].value[k] * s.axis[2].offset[k]) * p.value;
    }
  }
  return m;
}

/// Velocity by APIC; returns the kinetic energy per mass the projection onto (v, C) loses.
template <int Dim, class Spline>
inline double apply_apic(const Moments<Dim>& m, double cell, std::uint32_t p,
                         Particles<Dim>& particles) {
  using Lane = MotionLane<Dim>;
  double kept = 0.0, spin = 0.0;
  const double scale = Spline::inverse_inertia / cell;  // moments are in cells
  for (int a = 0; a < Dim; ++a) {
    const double v = m.value[Lane::end_velocity + a];
    particles.velocity[a][p] = v;
    kept += v * v;
    for (int k = 0; k < Dim; ++k) {
      const double moment = m.moment[k][Lane::end_velocity + a];
      particles.affine[a * Dim + k][p] = scale * moment;
      spin += moment * moment;
    }
  }
  return m.value[Lane::kinetic] - 0.5 * (kept + Spline::inverse_inertia * spin);
}

/// Velocity by PIC; returns the kinetic energy per mass the interpolation loses.
template <int Dim>
inline double apply_pic(const Moments<Dim>& m, std::uint32_t p, Particles<Dim>& particles) {
  double kept = 0.0;
  for (int a = 0; a < Dim; ++a) {
    const double v = m.value[MotionLane<Dim>::end_velocity + a];
    particles.velocity[a][p] = v;
    kept += v * v;
  }
  return m.value[MotionLane<Dim>::kinetic] - 0.5 * kept;
}

/// Velocity by FLIP with damping towards the grid; returns the kinetic energy per mass it loses.
template <int Dim>
inline double apply_flip(const Moments<Dim>& m, double damped, std::uint32_t p,
                         Particles<Dim>& particles) {
  using Lane = MotionLane<Dim>;
  double increment2 = 0.0, noise2 = 0.0, product = 0.0;
  for (int a = 0; a < Dim; ++a) {
    const double start = m.value[Lane::start_velocity + a];
    const double end = m.value[Lane::end_velocity + a];
    const double increment = end - start;
    const double noise = particles.velocity[a][p] - start;
    increment2 += increment * increment;
    noise2 += noise * noise;
    product += start * end;
    particles.velocity[a][p] =
        (1.0 - damped) * (particles.velocity[a][p] + increment) + damped * end;
  }
  return m.value[Lane::kinetic] - 0.5 * increment2 +
         damped * ((1.0 - 0.5 * damped) * noise2 - product);
}

template <int Dim>
inline void store_gradients(const Moments<Dim>& m, double inverse_cell, std::uint32_t p,
                            StepData<Dim>& step) {
  using Lane = MotionLane<Dim>;
  std::array<std::array<double, Dim>, Dim> middle;
  for (int a = 0; a < Dim; ++a) {
    for (int k = 0; k < Dim; ++k) {
      const double end = m.gradient[k][Lane::end_velocity + a] * inverse_cell;
      const double start = m.gradient[k][Lane::start_velocity + a] * inverse_cell;
      step.gradient[a * Dim + k][p] = end;
      middle[a][k] = 0.5 * (start + end);
    }
  }
  store_rate<Dim>(middle, p, step);
}

template <int Dim, VelocityTransfer Velocity, class Spline>
inline double update_velocity(const Moments<Dim>& m, double cell, double damped, std::uint32_t p,
                              Particles<Dim>& particles) {
  if constexpr (Velocity == VelocityTransfer::apic) {
    return apply_apic<Dim, Spline>(m, cell, p, particles);
  } else if constexpr (Velocity == VelocityTransfer::pic) {
    return apply_pic<Dim>(m, p, particles);
  } else {
    return apply_flip<Dim>(m, damped, p, particles);
  }
}

/// What the sweep needs besides particles and nodes.
template <int Dim>
struct Motion {
  double damped;
  Vector<Dim> grid_velocity;
  double dt, inverse_quantum;
};

template <int Dim, VelocityTransfer Velocity, VelocityUpdate Update, class Spline>
void sweep(const Spline& spline, const SlabGrid& grid, const CellOrder& cells,
           const Motion<Dim>& motion, Particles<Dim>& particles, StepData<Dim>& step,
           Int128& filter_heat) {
  using Lane = MotionLane<Dim>;
  const double cell = grid.shape().cell;
  const double inverse_cell = 1.0 / cell;
  Int128 heat_sum = 0;
  gather<Dim>(spline, particles, cells, grid,
              [&](std::uint32_t p, const Stencil<Dim, Spline>& stencil, const Lanes* nodes) {
                const Moments<Dim> m =
                    moments<Spline, Velocity == VelocityTransfer::apic>(stencil, nodes);
                const double lost =
                    update_velocity<Dim, Velocity, Spline>(m, cell, motion.damped, p, particles);
                for (int a = 0; a < Dim; ++a) {
                  const double v = m.value[Lane::end_velocity + a];
                  if constexpr (Update == VelocityUpdate::musl) {
                    step.transport[a][p] = v;
                  } else {
                    particles.position[a][p] += motion.dt * (v - motion.grid_velocity[a]);
                  }
                }
                store_gradients<Dim>(m, inverse_cell, p, step);
                step.heat[p] = m.value[Lane::heat] + lost;
                heat_sum += quantise(particles.mass[p] * lost, motion.inverse_quantum);
              });
  filter_heat += heat_sum;
}

}  // namespace

template <int Dim>
void prepare_gather(const Transfer& transfer, double damped, SlabGrid& grid) {
  using Lane = MotionLane<Dim>;
  const bool end_energy = projects(transfer.velocity);
  for (int row = grid.first_row(); row < grid.node_end(); ++row) {
    Lanes* nodes = grid.row(row);
    for (int i = 0; i < grid.shape().row_size; ++i) {
      double end2 = 0.0, increment2 = 0.0, product = 0.0;
      for (int a = 0; a < Dim; ++a) {
        const double start = nodes[i][Lane::start_velocity + a];
        const double end = nodes[i][Lane::end_velocity + a];
        end2 += end * end;
        increment2 += (end - start) * (end - start);
        product += start * end;
      }
      nodes[i][Lane::kinetic] = end_energy ? 0.5 * end2 : 0.5 * increment2 + damped * product;
    }
  }
  grid.fill_periodic_images();
}

template <int Dim>
void grid_to_particles(const SlabGrid& grid, const CellOrder& cells, const Transfer& transfer,
                       const Vector<Dim>& grid_velocity, double dt, double inverse_quantum,
                       Particles<Dim>& particles, StepData<Dim>& step, Int128& filter_heat) {
  const Motion<Dim> motion = {damped_share(transfer, dt), grid_velocity, dt, inverse_quantum};
  with_shape(transfer, [&]<class Spline>(const Spline& spline) {
    if constexpr (is_spline<Spline>) {
      if (transfer.velocity == VelocityTransfer::apic) {
        return sweep<Dim, VelocityTransfer::apic, VelocityUpdate::usl>(
            spline, grid, cells, motion, particles, step, filter_heat);
      }
      if (transfer.velocity == VelocityTransfer::pic) {
        return sweep<Dim, VelocityTransfer::pic, VelocityUpdate::usl>(spline, grid, cells, motion,
                                                                      particles, step, filter_heat);
      }
    } else if (transfer.update == VelocityUpdate::musl) {
      for (auto& column : step.transport) column.resize(particles.size());
      return sweep<Dim, VelocityTransfer::flip, VelocityUpdate::musl>(spline, grid, cells, motion,
                                                                      particles, step, filter_heat);
    }
    // FMPM has filtered the velocities before the step; the step itself is FLIP's.
    sweep<Dim, VelocityTransfer::flip, VelocityUpdate::usl>(spline, grid, cells, motion, particles,
                                                            step, filter_heat);
  });
}

template void prepare_gather<2>(const Transfer&, double, SlabGrid&);
template void prepare_gather<3>(const Transfer&, double, SlabGrid&);
template void grid_to_particles<2>(const SlabGrid&, const CellOrder&, const Transfer&,
                                   const Vector<2>&, double, double, Particles<2>&, StepData<2>&,
                                   Int128&);
template void grid_to_particles<3>(const SlabGrid&, const CellOrder&, const Transfer&,
                                   const Vector<3>&, double, double, Particles<3>&, StepData<3>&,
                                   Int128&);

}  // namespace poreshock
